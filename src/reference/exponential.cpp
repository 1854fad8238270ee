// Scalar twins of exp and pow: the same series in the same order.
#include <bit>
#include <cmath>
#include <limits>

#include "kernels/exponential_constants.hpp"
#include "src/reference/arithmetic.hpp"

namespace spectile::reference {
namespace {

using namespace kernels;  // the constants' names

double exp2_double(double t) {
  const double shifted = t + kRoundMagic;
  const double x = (t - (shifted - kRoundMagic)) * kLn2;
  double p = kExpSeries[kExpTerms - 1];
  for (std::size_t k = kExpTerms - 1; k-- > 0;) p = p * x + kExpSeries[k];
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(p) +
                               (std::bit_cast<std::uint64_t>(shifted) << 52));
}

double log2_double(double v) {
  const auto bits = std::bit_cast<std::uint64_t>(v);
  double m = std::bit_cast<double>((bits & kMantissaMask) | kOneBits);
  double e = std::bit_cast<double>((bits >> 52) | kTwo52Bits) - kTwo52PlusBias;
  if (m > kSqrt2) {
    m = m * 0.5;
    e = e + 1.0;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double z = s * s;
  double p = kAtanhSeries[kAtanhTerms - 1];
  for (std::size_t k = kAtanhTerms - 1; k-- > 0;) p = p * z + kAtanhSeries[k];
  return e + (p * s) * kTwoOverLn2;
}

double hold(double v) {
  return v < -kExponentLimit ? -kExponentLimit : (kExponentLimit < v ? kExponentLimit : v);
}

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

}  // namespace

void exp(float* dst, const float* a, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = static_cast<float>(exp2_double(hold(a[i] * kLog2E)));
}

void pow(float* dst, const float* a, float y, std::size_t n) noexcept {
  const PowExponent exponent(y);
  for (std::size_t i = 0; i < n; ++i) dst[i] = power(a[i], y, exponent);
}

}  // namespace spectile::reference
