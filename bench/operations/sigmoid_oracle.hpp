// The sigmoid in double, and what its samples may be off by.
#pragma once

#include <algorithm>
#include <cmath>

#include "bench/operations/operation.hpp"

namespace spectile::measure {

/// A sample: nine fused multiply-adds, further multiply-adds, the limits, the guess from its bits.
inline constexpr double kSigmoidBand = 16;

/// The functions that the argument combines, at one place.
struct SigmoidPlace {
  double p, q;
};

inline double argument(const double* c, const SigmoidPlace& at) {
  return c[0] * at.p + c[1] * at.q + c[2];
}

/// The sigmoid in double, from coefficients in float.
inline double sigmoid(const double* c, const SigmoidPlace& at) {
  const double x = argument(c, at);
  return std::clamp(0.5 + 0.5 * x / std::sqrt(1 + x * x), 0.0, 1.0);
}

/// Sum of the magnitudes of the argument's terms.
inline double terms_at(const double* c, const SigmoidPlace& at) {
  return std::abs(c[0] * at.p) + std::abs(c[1] * at.q) + std::abs(c[2]);
}

/// 2^-23 of the sigmoid itself; the argument's rounding times its slope, 1/2 at most.
inline double allowed_at(const double* c, const SigmoidPlace& at) {
  return 0x1p-23 + 0x1p-24 * terms_at(c, at);
}

/// Coefficients for which allowed_at() holds.
inline bool has_bound(const double* c) {
  return finite3(c) && std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])}) <= 0x1p60;
}

}  // namespace spectile::measure
