// Operations on lanes beside the AoS baseline: the same lanes, array of structures, scalar code.
#pragma once

#include <spectile/bench/benchmark.hpp>

#include "bench/limits/clock.hpp"
#include "bench/operations/lane_memory.hpp"

namespace spectile::measure {

/// The baseline of one operation, on copies of the operation's lanes.
class LaneBaseline {
 public:
  /// Copies the inputs of `memory` and prepares run and, where the baseline has its loops fused by hand too,
  /// run_fused; both do so many passes over all lanes. Without a baseline of the operation they stay empty.
  /// `bands`: those of lane_operations(). Errors: as Upsampler::create() and Projector.
  static Result<LaneBaseline> create(const Operation& operation, const Bands& bands, const LaneMemory& memory,
                                     std::size_t passes);
  bool exists() const noexcept { return static_cast<bool>(plain.run); }
  /// Runs it and evaluates the first lanes: their largest error, as the operation's own.
  double error(std::size_t lanes, bool of_fused = false) const;

  Timed plain, fused;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace spectile::measure
