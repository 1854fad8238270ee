// Sums over the bands of a sigmoid's samples and Newton's step from them, as the kernels do them.
#pragma once

#include <cmath>

#include "kernels/sigmoid_constants.hpp"
#include "src/reference/upsampling/sigmoid.hpp"

namespace spectile::reference {

/// a * b + c, rounded once.
inline float fused(float a, float b, float c) {
  return std::fma(a, b, c);
}

/// Sums over the bands and their derivatives by the coefficients: [rgb][c0, c1, c2].
struct Sums {
  float f[3] = {0, 0, 0};
  float j[3][3] = {};
};

inline float residual(const Sums& sums, const float target[3], float r[3]) {
  for (std::size_t k = 0; k < 3; ++k) r[k] = target[k] - sums.f[k];
  // As the vector maximum: the second operand where the first is not greater.
  const float first = std::abs(r[0]) > std::abs(r[1]) ? std::abs(r[0]) : std::abs(r[1]);
  return first > std::abs(r[2]) ? first : std::abs(r[2]);
}

inline void add_slopes(Sums& sums, const SigmoidPoint& p, const float* row) {
  const float slope = (p.root * p.root) * p.root;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) sums.j[k][i] = fused(slope, row[3 * k + i], sums.j[k][i]);
  }
}

/// Sums over all bands, run by run, and their derivatives.
inline Sums band_sums(const float c[3], const kernels::SigmoidTable& table) {
  Sums sums;
  for (std::size_t first = 0; first < table.bands; first += kernels::kSumRun) {
    float run[3] = {0, 0, 0};
    for (std::size_t b = first; b < table.bands && b < first + kernels::kSumRun; ++b) {
      const float* row = table.rows + b * kernels::kSigmoidRow;
      const SigmoidPoint p = sigmoid_point(sigmoid_argument(table.form, c, row));
      for (std::size_t k = 0; k < 3; ++k) run[k] = fused(table.weights[4 * b + k], p.sample, run[k]);
      add_slopes(sums, p, row);
    }
    for (std::size_t k = 0; k < 3; ++k) sums.f[k] = sums.f[k] + run[k];
  }
  return sums;
}

inline void cross(const float u[3], const float v[3], float out[3]) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t m = (i + 1) % 3;
    const std::size_t n = (i + 2) % 3;
    out[i] = fused(-u[n], v[m], u[m] * v[n]);
  }
}

/// Newton's step, by Cramer's rule; zero where it is not finite.
inline void newton_step(const Sums& sums, const float r[3], float step[3]) {
  const float* const a = sums.j[0];
  const float* const b = sums.j[1];
  const float* const c = sums.j[2];
  float bc[3];
  float ca[3];
  float ab[3];
  cross(b, c, bc);
  cross(c, a, ca);
  cross(a, b, ab);
  const float determinant = fused(a[2], bc[2], fused(a[1], bc[1], a[0] * bc[0]));
  const float inverse = 1.0F / determinant;
  bool finite = true;
  for (std::size_t i = 0; i < 3; ++i) {
    step[i] = fused(r[2], ab[i], fused(r[1], ca[i], r[0] * bc[i])) * inverse;
    finite = finite && std::abs(step[i]) < kernels::kSigmoidFar;
  }
  for (std::size_t i = 0; i < 3 && !finite; ++i) step[i] = 0;
}

/// Sum of the magnitudes.
inline float magnitude_sum(const float c[3]) {
  return (std::abs(c[0]) + std::abs(c[1])) + std::abs(c[2]);
}

}  // namespace spectile::reference
