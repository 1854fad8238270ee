// Statistics of lists of numbers.
#pragma once

#include <cstddef>
#include <span>

namespace spectile {

/// Percentile: the smallest value that at least `percent` of 100 values do not exceed. Shapes: sorted, at
/// least one value; percent 1 to 100.
inline double percentile(std::span<const double> sorted, std::size_t percent) {
  return sorted[(sorted.size() * percent + 99) / 100 - 1];
}

}  // namespace spectile
