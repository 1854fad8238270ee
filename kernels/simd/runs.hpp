// Sums over bands in the order that every kernel takes.
#pragma once

#include "kernels/abi/lanes.hpp"

namespace spectile::kernels {
namespace {

/// Calls run(first, end) for each run of a sum over bands.
template <class Run>
inline void for_runs(std::size_t bands, Run run) noexcept {
  for (std::size_t first = 0; first < bands; first += kSumRun) {
    run(first, bands - first < kSumRun ? bands : first + kSumRun);
  }
}

}  // namespace
}  // namespace spectile::kernels
