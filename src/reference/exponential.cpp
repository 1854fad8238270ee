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

}  // namespace

void exp(float* dst, const float* a, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = static_cast<float>(exp2_double(hold(a[i] * kLog2E)));
}

void transmittance(float* dst, const float* a, const float* t, std::size_t bands,
                   std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * bands * kLanes; ++i) {
    const double product =
        static_cast<double>(a[i]) * static_cast<double>(t[i / (bands * kLanes) * kLanes + i % kLanes]);
    dst[i] = static_cast<float>(exp2_double(hold(product * -kLog2E)));
  }
}

void pow(float* dst, const float* a, float y, std::size_t n) noexcept {
  const PowExponent exponent(y);
  for (std::size_t i = 0; i < n; ++i) dst[i] = power(a[i], y, exponent);
}

}  // namespace spectile::reference
