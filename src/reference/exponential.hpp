// 2^t and log2 in double, operation by operation as the kernels do them.
#pragma once

#include <bit>
#include <cstdint>

#include "kernels/exponential_constants.hpp"

namespace spectile::reference {

/// 2^t for t in [-1000, 1000]; NaN stays.
inline double exp2_double(double t) {
  const double shifted = t + kernels::kRoundMagic;
  const double x = (t - (shifted - kernels::kRoundMagic)) * kernels::kLn2;
  double p = kernels::kExpSeries[kernels::kExpTerms - 1];
  for (std::size_t k = kernels::kExpTerms - 1; k-- > 0;) p = p * x + kernels::kExpSeries[k];
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(p) +
                               (std::bit_cast<std::uint64_t>(shifted) << 52));
}

/// log2 of a positive normal double.
inline double log2_double(double v) {
  const auto bits = std::bit_cast<std::uint64_t>(v);
  double m = std::bit_cast<double>((bits & kernels::kMantissaMask) | kernels::kOneBits);
  double e = std::bit_cast<double>((bits >> 52) | kernels::kTwo52Bits) - kernels::kTwo52PlusBias;
  if (m > kernels::kSqrt2) {
    m = m * 0.5;
    e = e + 1.0;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double z = s * s;
  double p = kernels::kAtanhSeries[kernels::kAtanhTerms - 1];
  for (std::size_t k = kernels::kAtanhTerms - 1; k-- > 0;) p = p * z + kernels::kAtanhSeries[k];
  return e + (p * s) * kernels::kTwoOverLn2;
}

/// v held in [-1000, 1000]; NaN stays.
inline double hold(double v) {
  return v < -kernels::kExponentLimit ? -kernels::kExponentLimit
                                      : (kernels::kExponentLimit < v ? kernels::kExponentLimit : v);
}

}  // namespace spectile::reference
