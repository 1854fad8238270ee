// Steps of the search for sigmoid coefficients: the colour of coefficients with its derivatives, Newton's
// step, and the start from the nearest node.
#pragma once

#include "kernels/simd/runs.hpp"
#include "kernels/simd/tables.hpp"
#include "kernels/upsampling/sigmoid_point.inl"

namespace spectile::kernels {
namespace {

/// Sums over the bands and their derivatives by the coefficients.
struct SigmoidSums {
  F32 f[3];
  F32 j[9];
};

inline SigmoidSums zero_sums() noexcept {
  SigmoidSums sums;
  for (auto& v : sums.f) v = F32(0.0F);
  for (auto& v : sums.j) v = F32(0.0F);
  return sums;
}

inline void add_slopes(SigmoidSums& sums, const SigmoidPoint& p, const float* row) noexcept {
  const F32 slope = (p.root * p.root) * p.root;
  for (std::size_t i = 0; i < 9; ++i) sums.j[i] = fused(slope, F32(row[i]), sums.j[i]);
}

/// Sums over all bands, run by run, and their derivatives.
template <class Form>
inline SigmoidSums band_sums(const Coefficients& a, const SigmoidTable& table) noexcept {
  SigmoidSums sums = zero_sums();
  for_runs(table.bands, [&](std::size_t first, std::size_t end) {
    F32 run[3] = {F32(0.0F), F32(0.0F), F32(0.0F)};
    for (std::size_t b = first; b < end; ++b) {
      const float* row = table.rows + b * kSigmoidRow;
      const SigmoidPoint p = sigmoid_point(a, Form(row));
      for (std::size_t k = 0; k < 3; ++k) run[k] = fused(F32(table.weights[4 * b + k]), p.sample, run[k]);
      add_slopes(sums, p, row);
    }
    for (std::size_t k = 0; k < 3; ++k) sums.f[k] = sums.f[k] + run[k];
  });
  return sums;
}

/// Differences to the target, and the largest magnitude of them.
struct Residual {
  F32 r[3];
  F32 size;
};

inline Residual residual(const SigmoidSums& sums, const F32 target[3]) noexcept {
  Residual out;
  for (std::size_t k = 0; k < 3; ++k) out.r[k] = target[k] - sums.f[k];
  const F32 a = xsimd::abs(out.r[0]);
  const F32 b = xsimd::abs(out.r[1]);
  const F32 c = xsimd::abs(out.r[2]);
  const F32 first = xsimd::select(a > b, a, b);
  out.size = xsimd::select(first > c, first, c);
  return out;
}

/// Newton's step, by Cramer's rule; zero where it is not finite.
inline Coefficients newton_step(const SigmoidSums& sums, const Residual& left) noexcept {
  const F32* const a = sums.j;
  const F32* const b = sums.j + 3;
  const F32* const c = sums.j + 6;
  const auto cross = [](const F32* u, const F32* v, F32* out) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t m = (i + 1) % 3;
      const std::size_t n = (i + 2) % 3;
      out[i] = fused_minus(u[n], v[m], u[m] * v[n]);
    }
  };
  F32 bc[3];
  F32 ca[3];
  F32 ab[3];
  cross(b, c, bc);
  cross(c, a, ca);
  cross(a, b, ab);
  const F32 determinant = fused(a[2], bc[2], fused(a[1], bc[1], a[0] * bc[0]));
  const F32 inverse = divide(F32(1.0F), determinant);
  Coefficients step;
  for (std::size_t i = 0; i < 3; ++i) {
    step.c[i] = fused(left.r[2], ab[i], fused(left.r[1], ca[i], left.r[0] * bc[i])) * inverse;
  }
  const F32 far(kSigmoidFar);
  const Mask finite =
      (xsimd::abs(step.c[0]) < far) & (xsimd::abs(step.c[1]) < far) & (xsimd::abs(step.c[2]) < far);
  for (auto& v : step.c) v = xsimd::select(finite, v, F32(0.0F));
  return step;
}

/// Sum of the magnitudes.
inline F32 magnitude_sum(const Coefficients& a) noexcept {
  return (xsimd::abs(a.c[0]) + xsimd::abs(a.c[1])) + xsimd::abs(a.c[2]);
}
/// True if this step is the last: the error after a Newton step grows with the residual times the step.
inline Mask is_last(const Residual& left, const Coefficients& step, F32 close) noexcept {
  // A step of no length stands for one that was not finite.
  const F32 length = magnitude_sum(step);
  return (left.size * length <= close) & (left.size <= F32(kSigmoidNear)) & (length > F32(0.0F));
}

/// Start coefficients for colours in the dark half of the cube: the expansion around the nearest node.
inline Coefficients start(const F32 v[3], F32 z, const SigmoidTable& table) noexcept {
  const Mask first = (v[0] >= v[1]) & (v[0] >= v[2]);
  const Mask second = v[1] >= v[2];
  const F32 next = xsimd::select(first, v[1], xsimd::select(second, v[2], v[0]));
  const F32 last = xsimd::select(first, v[2], xsimd::select(second, v[0], v[1]));
  const F32 most = xsimd::select(first, F32(0.0F), xsimd::select(second, F32(1.0F), F32(2.0F)));
  const F32 inverse = divide(F32(1.0F), z);
  const F32 q[3] = {F32(1.0F) - square_root(F32(1.0F) - z), square_root(next * inverse),
                    square_root(last * inverse)};
  const F32 steps(static_cast<float>(table.steps));
  const F32 limit = steps - F32(0.5F);
  I32 node = xsimd::to_int(most);
  F32 d[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const F32 scaled = q[i] * steps;
    const I32 cell = xsimd::to_int(min(limit, scaled));
    d[i] = scaled - (xsimd::to_float(cell) + F32(0.5F));
    node = node * I32(table.steps) + cell;
  }
  const I32 at = node * I32(static_cast<std::int32_t>(kSigmoidNode));
  const F32 root = divide(F32(1.0F), square_root(z));
  Coefficients out;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* const e = table.nodes + 3 + 9 * k;
    const auto entry = [&](std::size_t i) { return gather(e + i, at); };
    // By the powers of the first distance, then of the second, then of the third.
    const F32 first_part = fused(fused(entry(3), d[0], entry(0)), d[0], gather(table.nodes + k, at));
    const F32 slope = fused(entry(4), d[1], fused(entry(6), d[0], entry(1)));
    const F32 last_slope = fused(entry(5), d[2], fused(entry(8), d[1], fused(entry(7), d[0], entry(2))));
    out.c[k] = fused(last_slope, d[2], fused(slope, d[1], first_part)) * root;
  }
  return out;
}

}  // namespace
}  // namespace spectile::kernels
