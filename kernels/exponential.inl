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

/// 2^n for n from -250 to 250, as two factors of which neither leaves float's range; n + kRoundMagicFloat is
/// given.
struct PowersOfTwo {
  explicit PowersOfTwo(F32 shifted) noexcept {
    // Above 0 while it is halved, so that the shift's kind does not matter.
    const U32 n = bits_as<std::uint32_t>(shifted) - U32(kRoundMagicFloatBits - 512U);
    const U32 half = n >> 1;
    first = bits_as<float>((half - U32(256U - 127U)) << 23);
    second = bits_as<float>((n - half - U32(256U - 127U)) << 23);
  }
  F32 first, second;
};

void transmittance(float* dst, const float* a, const float* t, std::size_t bands,
                   std::size_t blocks) noexcept {
  const U32 upper(kUpperHalf);
  const F32 limit(kExpFloatLimit);
  const F32 magic(kRoundMagicFloat);
  const U32 magnitude(0x7FFFFFFFU);
  const F32 one(1.0F);
  const F32 up(0x1p64F);
  const F32 down(0x1p-64F);
  map_lanes(dst, bands, blocks, [=](std::size_t i, std::size_t lane) {
    const F32 x = load(a + i);
    const F32 d = load(t + lane);
    const F32 product = x * d;
    const F32 exponent = min(limit, max(-limit, -product));
    const Mask inside = exponent == -product;
    // The product of the upper halves is exact; the rest is some 2^-12 of it. Neither's lower half is so
    // small that it could be flushed to zero.
    const Mask small = bits_as<float>(bits_as<std::uint32_t>(x) & magnitude) < one;
    const F32 u = x * xsimd::select(small, up, down);
    const F32 v = d * xsimd::select(small, down, up);
    const F32 u_high = bits_as<float>(bits_as<std::uint32_t>(u) & upper);
    const F32 v_high = bits_as<float>(bits_as<std::uint32_t>(v) & upper);
    const F32 rest = u_high * (v - v_high) + (u - u_high) * v;
    const F32 high = xsimd::select(inside, -(u_high * v_high), exponent);
    const F32 low = xsimd::select(inside, rest, F32(0.0F));
    const F32 shifted = exponent * F32(kLog2EFloat) + magic;
    const F32 n = shifted - magic;
    const F32 r = (high - n * F32(kLn2HighFloat)) - (low + n * F32(kLn2LowFloat));
    F32 q(kExpFloatSeries[kExpFloatTerms - 1]);
    for (std::size_t k = kExpFloatTerms - 1; k-- > 0;) q = q * r + F32(kExpFloatSeries[k]);
    const PowersOfTwo scale(shifted);
    return (((r + (r * r) * q) + F32(1.0F)) * scale.first) * scale.second;
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
