// 2^t and log2 in double, operation by operation as the kernels do them.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "kernels/exponential_constants.hpp"

namespace spectile::reference {

/// Sum of c[k] x^k: even and odd powers apart, each by Horner's rule in x^2.
template <std::size_t kTerms>
double power_series(const double (&c)[kTerms], double x) {
  constexpr std::size_t kEven = (kTerms - 1) / 2 * 2;
  constexpr std::size_t kOdd = kTerms / 2 * 2 - 1;
  const double square = x * x;
  double even = c[kEven];
  double odd = c[kOdd];
  for (std::size_t k = kEven; k >= 2; k -= 2) even = even * square + c[k - 2];
  for (std::size_t k = kOdd; k >= 3; k -= 2) odd = odd * square + c[k - 2];
  return even + x * odd;
}

/// 2^t for t in [-1000, 1000]; NaN stays.
inline double exp2_double(double t) {
  const double shifted = t + kernels::kRoundMagic;
  const double x = (t - (shifted - kernels::kRoundMagic)) * kernels::kLn2;
  const double p = power_series(kernels::kExpSeries, x);
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(p) +
                               (std::bit_cast<std::uint64_t>(shifted) << 52));
}

/// log2 of a positive normal double.
inline double log2_double(double v) {
  const auto bits = std::bit_cast<std::uint64_t>(v);
  auto m = std::bit_cast<double>((bits & kernels::kMantissaMask) | kernels::kOneBits);
  double e = std::bit_cast<double>((bits >> 52) | kernels::kTwo52Bits) - kernels::kTwo52PlusBias;
  if (m > kernels::kSqrt2) {
    m = m * 0.5;
    e = e + 1.0;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double z = s * s;
  const double p = power_series(kernels::kAtanhSeries, z);
  return e + (p * s) * kernels::kTwoOverLn2;
}

/// v held in [-1000, 1000]; NaN stays.
inline double hold(double v) {
  return v < -kernels::kExponentLimit ? -kernels::kExponentLimit
                                      : (kernels::kExponentLimit < v ? kernels::kExponentLimit : v);
}

}  // namespace spectile::reference
