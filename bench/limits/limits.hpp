// The machine's own limits: how fast it loads, stores, copies, multiplies and divides.
#pragma once

#include <spectile/bench/benchmark.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <vector>

#include "bench/limits/clock.hpp"
#include "kernels/abi.hpp"

namespace spectile::measure {

/// The system's own description; names are "unknown" and sizes 0 where it does not.
BenchmarkMachine describe_machine();

/// Lower bounds of an item's cost.
struct Cost {
  double read_bytes = 0;
  double written_bytes = 0;
  double operations = 0;  ///< on floats, rounded one by one; one on doubles counts as two
  double divisions = 0;
};

/// Times in a row that a thread goes over its part of the memory: in the caches so often that it does not
/// matter whose cache the part was in before.
std::size_t passes_at(MemoryLevel level);

/// Calls work(first block, blocks) for each thread's part, so often in a row.
void over_parts(std::size_t blocks, int threads, std::size_t passes,
                const std::function<void(std::size_t first, std::size_t count)>& work);

/// The loops that find limits, to be timed in turn with what is held against them.
class LimitLoops {
 public:
  /// Works on `floats` of memory.
  LimitLoops(const kernels::KernelTable& table, float* memory, std::size_t floats, int threads,
             MemoryLevel level);
  std::vector<Timed*> timed();
  MachineLimit limit() const;
  /// Least seconds of an item in each round, and the limiting resource: median of the rounds' fractions
  /// that `work` reaches, which does `items` a run. `non_temporal`: with such stores.
  double fraction(const Timed& work, double items, const Cost& cost, bool non_temporal,
                  std::string* bottleneck) const;

 private:
  double item_seconds(std::size_t round, const Cost& cost, bool non_temporal, std::string* bottleneck) const;
  std::string isa_;
  int threads_;
  MemoryLevel level_;
  double bytes_ = 0;  ///< of the memory
  double steps_ = 0;  ///< of arithmetic a run, all threads
  Timed load_, store_, stream_, copy_, multiply_add_, fused_, divide_;
};

}  // namespace spectile::measure
