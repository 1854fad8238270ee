// 2^t and log2 of vectors of doubles, by series whose truncation is below 2e-14.
#pragma once

#include "kernels/exponential_constants.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

/// Sum of c[k] x^k: even and odd powers apart, by Horner's rule in x^2, so that one chain need not wait for
/// the other: (even) + (x * (odd)).
template <std::size_t kTerms>
inline F64 power_series(const double (&c)[kTerms], F64 x) noexcept {
  constexpr std::size_t kEven = (kTerms - 1) / 2 * 2;
  constexpr std::size_t kOdd = kTerms / 2 * 2 - 1;
  const F64 square = x * x;
  F64 even(c[kEven]);
  F64 odd(c[kOdd]);
  for (std::size_t k = kEven; k >= 2; k -= 2) even = even * square + F64(c[k - 2]);
  for (std::size_t k = kOdd; k >= 3; k -= 2) odd = odd * square + F64(c[k - 2]);
  return even + x * odd;
}

/// 2^t for t in [-1000, 1000]; NaN stays.
inline F64 exp2_double(F64 t) noexcept {
  const F64 magic(kRoundMagic);
  const F64 shifted = t + magic;  // the integer nearest to t, in the low bits of the mantissa
  const F64 x = (t - (shifted - magic)) * F64(kLn2);
  const F64 p = power_series(kExpSeries, x);
  return bits_as<double>(bits_as<std::uint64_t>(p) + (bits_as<std::uint64_t>(shifted) << 52));
}

/// log2 of a positive normal double.
inline F64 log2_double(F64 v) noexcept {
  const U64 bits = bits_as<std::uint64_t>(v);
  F64 m = bits_as<double>((bits & U64(kMantissaMask)) | U64(kOneBits));
  F64 e = bits_as<double>((bits >> 52) | U64(kTwo52Bits)) - F64(kTwo52PlusBias);
  const auto large = m > F64(kSqrt2);
  m = xsimd::select(large, m * F64(0.5), m);
  e = xsimd::select(large, e + F64(1.0), e);
  const F64 s = (m - F64(1.0)) / (m + F64(1.0));
  const F64 z = s * s;
  const F64 p = power_series(kAtanhSeries, z);
  return e + (p * s) * F64(kTwoOverLn2);
}

/// v held in [-limit, limit]; NaN stays.
inline F64 hold(F64 v, double limit) noexcept {
  const F64 lowest(-limit);
  const F64 highest(limit);
  return xsimd::select(v < lowest, lowest, xsimd::select(highest < v, highest, v));
}

}  // namespace
}  // namespace spectile::kernels
