// Memory of an operation's lanes: filled, handed to kernels in parts, read back in double.
#pragma once

#include <spectile/lanes/sampled_spectra.hpp>

#include "bench/operations/operation.hpp"

namespace spectile::measure {

class LaneMemory {
 public:
  /// As many whole blocks as fit into `bytes` at `memory`, 64-byte aligned; least_bytes() must.
  LaneMemory(const Operation& operation, float* memory, std::size_t bytes);
  /// Bytes that one block takes, source and target.
  static std::size_t block_bytes(const Operation& operation);
  /// And with the distance that planes are kept apart.
  static std::size_t min_bytes(const Operation& operation, std::size_t blocks = 1);

  std::size_t blocks() const noexcept { return blocks_; }
  std::size_t lanes() const noexcept { return blocks_ * kernels::kLanes; }
  Arrays arrays(std::size_t first, std::size_t count, bool non_temporal) const;

  /// Values of a lane, [planes][rows]; halves are rounded, integers limited to what double holds.
  void write(std::size_t lane, const float* values);
  /// Copies the first `count` blocks' inputs over all the others.
  void repeat(std::size_t count);
  void read_in(std::size_t lane, double* values) const;
  void read_out(std::size_t lane, double* values) const;

 private:
  static std::size_t index(const Shape& shape, std::size_t lane, std::size_t row) noexcept;
  static void read(const Shape& shape, const std::byte* at, std::size_t plane_bytes, std::size_t lane,
                   double* values);
  Shape in_, out_;
  const Operation* operation_;
  std::byte* source_;
  std::byte* target_;
  std::size_t blocks_ = 0;
  std::size_t source_plane_ = 0, target_plane_ = 0;
};

/// The largest error over the first `lanes` lanes, and how many could be evaluated.
struct Evaluation {
  double worst = 0;
  std::uint64_t cases = 0;
  std::uint64_t beyond = 0;
  std::vector<float> worst_input;
};
/// `flushed`: the processor took and gave 0 for numbers below the smallest normal one.
void evaluate_errors(const Operation& operation, const LaneMemory& memory, std::size_t lanes, bool flushed,
                     Evaluation& out);

}  // namespace spectile::measure
