// exp and pow: computed in double with series whose truncation is below 2e-14, rounded to float once.
#pragma once

#include "kernels/exponential_constants.hpp"
#include "kernels/simd.hpp"
#include "kernels/simd_convert.hpp"

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

void exp(float* dst, const float* a, std::size_t n) noexcept {
  const F64 log2e(kLog2E);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 x = load(a + i);
    const F64 low = exp2_double(hold(widen_low(x) * log2e, kExponentLimit));
    const F64 high = exp2_double(hold(widen_high(x) * log2e, kExponentLimit));
    store(dst + i, narrow(low, high));
  }
}

void pow(float* dst, const float* a, float y, std::size_t n) noexcept {
  const PowExponent exponent(y);
  const F64 factor(exponent.factor);
  const F32 zero(0.0F);
  const F32 one(1.0F);
  const F32 infinity(__builtin_inff());
  const U32 sign_bit(0x80000000U);
  const U32 odd_sign(exponent.odd ? 0x80000000U : 0U);
  const F32 at_zero(exponent.at_zero);
  const F32 at_infinity(exponent.at_infinity);
  const F32 nan(__builtin_nanf(""));
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 x = load(a + i);
    if (exponent.zero) {
      store(dst + i, one);
      continue;
    }
    const U32 bits = bits_as<std::uint32_t>(x);
    const F32 magnitude = bits_as<float>(bits & ~sign_bit);
    // Zero, infinity and NaN are set apart, the series gets a harmless one instead.
    const Mask is_zero = magnitude == zero;
    const Mask is_infinite = magnitude == infinity;
    const F32 safe = xsimd::select(is_zero | is_infinite, one, magnitude);
    const F64 low = exp2_double(hold(log2_double(widen_low(safe)) * factor, kExponentLimit));
    const F64 high = exp2_double(hold(log2_double(widen_high(safe)) * factor, kExponentLimit));
    F32 r = narrow(low, high);
    r = xsimd::select(is_zero, at_zero, r);
    r = xsimd::select(is_infinite, at_infinity, r);
    if (exponent.integer) {
      r = bits_as<float>(bits_as<std::uint32_t>(r) | (bits & odd_sign));
    } else {
      r = xsimd::select((x < zero) & ~is_infinite, nan, r);
    }
    if (exponent.nan) r = nan;
    r = xsimd::select(x == one, one, r);
    r = xsimd::select(is_nan(x), x, r);
    store(dst + i, r);
  }
}

}  // namespace
}  // namespace spectile::kernels
