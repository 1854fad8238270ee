// exp and pow: computed in double, rounded to float once.
#pragma once

#include "kernels/arithmetic.inl"
#include "kernels/exponential_series.inl"
#include "kernels/simd/convert.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

void exp(float* dst, const float* a, std::size_t n) noexcept {
  const F64 log2e(kLog2E);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 x = load(a + i);
    const F64 low = exp2_double(hold(widen_low(x) * log2e, kExponentLimit));
    const F64 high = exp2_double(hold(widen_high(x) * log2e, kExponentLimit));
    store(dst + i, narrow(low, high));
  }
}

void transmittance(float* dst, const float* a, const float* t, std::size_t bands,
                   std::size_t blocks) noexcept {
  const F64 minus_log2e(-kLog2E);
  map_lanes(dst, bands, blocks, [=](std::size_t i, std::size_t lane) {
    const F32 x = load(a + i);
    const F32 d = load(t + lane);
    // A product of two floats is exact in double.
    const F64 low = exp2_double(hold((widen_low(x) * widen_low(d)) * minus_log2e, kExponentLimit));
    const F64 high = exp2_double(hold((widen_high(x) * widen_high(d)) * minus_log2e, kExponentLimit));
    return narrow(low, high);
  });
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
