// Scalar twins of exp and pow: the same series in the same order.
#include "src/reference/exponential.hpp"

#include <cmath>
#include <limits>

#include "src/reference/twins.hpp"

namespace spectile::reference {
namespace {

using namespace kernels;  // the constants' names

float power(float x, float y, const PowExponent& exponent) {
  if (exponent.zero || x == 1.0F) return 1.0F;
  if (std::isnan(x)) return x;
  if (std::isnan(y)) return std::numeric_limits<float>::quiet_NaN();
  const float magnitude = std::fabs(x);
  if (x < 0 && !exponent.integer && !std::isinf(x)) return std::numeric_limits<float>::quiet_NaN();
  float r = 0;
  if (magnitude == 0) {
    r = exponent.at_zero;
  } else if (std::isinf(magnitude)) {
    r = exponent.at_infinity;
  } else {
    r = static_cast<float>(exp2_double(hold(log2_double(magnitude) * exponent.factor)));
  }
  return exponent.odd && std::signbit(x) ? -r : r;
}

/// e^-(x d) in float.
float exp_of_minus_product(float x, float d) {
  const float product = x * d;
  const float above = -product < -kExpFloatLimit ? -kExpFloatLimit : -product;
  const float exponent = kExpFloatLimit < above ? kExpFloatLimit : above;
  const bool inside = exponent == -product;
  const auto upper_half = [](float v) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(v) & kUpperHalf);
  };
  const bool small = std::fabs(x) < 1.0F;
  const float u = x * (small ? 0x1p64F : 0x1p-64F);
  const float v = d * (small ? 0x1p-64F : 0x1p64F);
  const float u_high = upper_half(u);
  const float v_high = upper_half(v);
  const float rest = u_high * (v - v_high) + (u - u_high) * v;
  const float high = inside ? -(u_high * v_high) : exponent;
  const float low = inside ? rest : 0.0F;
  const float shifted = exponent * kLog2EFloat + kRoundMagicFloat;
  const float n = shifted - kRoundMagicFloat;
  const float r = (high - n * kLn2HighFloat) - (low + n * kLn2LowFloat);
  float q = kExpFloatSeries[kExpFloatTerms - 1];
  for (std::size_t k = kExpFloatTerms - 1; k-- > 0;) q = q * r + kExpFloatSeries[k];
  const std::uint32_t whole = std::bit_cast<std::uint32_t>(shifted) - (kRoundMagicFloatBits - 512U);
  const std::uint32_t half = whole >> 1U;
  const auto power_of_two = [](std::uint32_t above_256) {
    return std::bit_cast<float>((above_256 - (256U - 127U)) << 23U);
  };
  return (((r + (r * r) * q) + 1.0F) * power_of_two(half)) * power_of_two(whole - half);
}

}  // namespace

void exp(float* dst, const float* a, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = static_cast<float>(exp2_double(hold(a[i] * kLog2E)));
}

void transmittance(float* dst, const float* a, const float* t, std::size_t bands,
                   std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * bands * kLanes; ++i) {
    dst[i] = exp_of_minus_product(a[i], t[i / (bands * kLanes) * kLanes + i % kLanes]);
  }
}

void pow(float* dst, const float* a, float y, std::size_t n) noexcept {
  const PowExponent exponent(y);
  for (std::size_t i = 0; i < n; ++i) dst[i] = power(a[i], y, exponent);
}

}  // namespace spectile::reference
