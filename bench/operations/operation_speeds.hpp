// Speeds of operations against the machine's limits.
#pragma once

#include <spectile/bench/benchmark.hpp>

#include "bench/operations/operation.hpp"

namespace spectile::measure {

/// Place and parameters of a measurement.
struct SpeedPlace {
  const kernels::KernelTable* table = nullptr;
  int threads = 1;
  MemoryLevel level = MemoryLevel::kCache;
  std::size_t bytes = 0;  ///< worked on: each thread's in the cache, all in memory
  TimingBudget timing;
  std::uint64_t seed = 1;
  bool baseline = false;  ///< also beside the AoS baseline, where there is one
  Bands bands;            ///< of the operations
};

/// Results of one place.
struct SpeedsFound {
  MachineLimit limit;
  std::vector<OperationSpeed> operations;
  std::vector<BaselineSpeed> baseline;
};

/// Operations that make no sense there are left out: those on lines of images, and those that arithmetic
/// limits, in memory. Errors: kOutOfMemory.
Result<SpeedsFound> measure_speeds(const std::vector<Operation>& operations, const SpeedPlace& place);

}  // namespace spectile::measure
