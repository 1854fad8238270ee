// Stress of the numbers: every operation over the whole range of float, held to its bound.
#pragma once

#include <functional>
#include <spectile/bench/benchmark.hpp>

#include "kernels/abi.hpp"

namespace spectile::measure {

/// Extent of the stress test.
struct StressSettings {
  const kernels::KernelTable* table = nullptr;
  std::size_t samples = std::size_t{1} << 16;  ///< numbers a set of inputs, for each operation
  std::uint64_t seed = 1;
  bool few_bands = false;         ///< 1 and 60 bands only
  std::vector<std::string> only;  ///< operations whose name contains one of these; all where empty
  std::function<bool()> stop;     ///< asked now and then; true ends with kCancelled
};

/// The kernels' operations: typical inputs, all bit patterns, special values, all magnitudes, cancellations,
/// spectra of one line, a rounding around 0 and 1, 1e-30 and 1e30; on 60 bands, one of 470 nm, 3, and 4096 of
/// 0.1 nm; and, where the processor can, with numbers below the smallest normal one flushed to 0.
Result<std::vector<StressResult>> stress_operations(const StressSettings& settings);

/// Everything but operations on lanes: films, averages over bands, weights, matrices, colour differences.
Result<std::vector<StressResult>> stress_others(const StressSettings& settings);

/// Counts one case of a result, and keeps the worst.
void add_case(StressResult& result, double error, const std::string& description);
StressResult stress_heading(std::string inputs, std::string unit, double bound);

// Parts of stress_others().
Result<StressResult> stress_film_counts(const StressSettings& settings);
Result<StressResult> stress_film_cancellation(const StressSettings& settings);
Result<StressResult> stress_film_samples(const StressSettings& settings);

}  // namespace spectile::measure
