// Speeds of operations against the machine's limits.
#pragma once

#include <spectile/bench/benchmark.hpp>

#include "bench/operations/operation.hpp"

namespace spectile::measure {

/// Where and how speeds are measured.
struct SpeedPlace {
  const kernels::KernelTable* table = nullptr;
  int threads = 1;
  MemoryLevel level = MemoryLevel::kCache;
  std::size_t bytes = 0;  ///< worked on: each thread's in the cache, all in memory
  Patience patience;
  std::uint64_t seed = 1;
};

/// What was found there.
struct SpeedsFound {
  MachineLimit limit;
  std::vector<OperationSpeed> operations;
};

/// Operations that make no sense there are left out: those on lines of images, and those that arithmetic
/// binds, in memory. Errors: kOutOfMemory.
Result<SpeedsFound> measure_speeds(const std::vector<Operation>& operations, const SpeedPlace& place);

}  // namespace spectile::measure
