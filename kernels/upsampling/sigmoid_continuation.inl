// Continuation toward the grey axis: the part of the line from a colour's grey to the colour that sigmoids
// cover, and the coefficients there.
#pragma once

#include "kernels/upsampling/sigmoid_newton.inl"

namespace spectile::kernels {
namespace {

/// A line of colours from a grey, and the tolerances at its points.
struct GreyLine {
  F32 grey;
  F32 direction[3];
  F32 near, met, steep;
  F32 shortest, damped, tries;  // see ContinuationEffort
};

inline void goal_at(const GreyLine& line, F32 part, F32 goal[3]) noexcept {
  for (std::size_t k = 0; k < 3; ++k) goal[k] = fused(part, line.direction[k], line.grey);
}

/// The part of the line that is solved, step by step from the grey's coefficients c; c becomes those there. A
/// lane that is done stays as it is, so that no lane depends on its neighbours.
template <class Form>
inline F32 follow(Coefficients& c, const GreyLine& line, const SigmoidTable& table, Mask active) noexcept {
  const F32 zero(0.0F);
  const F32 one(1.0F);
  const F32 infinity(__builtin_inff());
  const F32 quarter(0.25F);
  Coefficients base = c;
  Coefficients step = {{zero, zero, zero}};
  F32 length = one;
  F32 part = zero;
  F32 ahead(kContinuationFirst);
  F32 next(kContinuationFirst);
  F32 before = infinity;  // residual of the base, for the same place
  F32 best = infinity;    // residual at the line's end
  F32 tries = zero;
  for (int i = 0; i < kContinuationSteps && lane_bits(active) != 0; ++i) {
    Coefficients trial;
    for (std::size_t k = 0; k < 3; ++k) trial.c[k] = base.c[k] + length * step.c[k];
    const SigmoidSums sums = band_sums<Form>(trial, table);
    F32 goal[3];
    goal_at(line, next, goal);
    Residual left = residual(sums, goal);
    const Mask usable = magnitude_sum(trial) <= line.steep;
    const Mask end = next == one;
    const Mask there = active & usable & (left.size <= xsimd::select(end, line.met, line.near));
    const Mask keep = there & (~end | (left.size < best));
    for (std::size_t k = 0; k < 3; ++k) c.c[k] = xsimd::select(keep, trial.c[k], c.c[k]);
    part = xsimd::select(keep, next, part);
    best = xsimd::select(keep, xsimd::select(end, left.size, infinity), best);
    const Mask gains = usable & (left.size < F32(kContinuationGain) * before);
    active = active & ~((part == one) & ((left.size <= F32(kSigmoidFloor)) | ~gains));
    const Mask onward = there & ~end;
    const Mask better = usable & (left.size < before);
    tries = tries + one;
    const Mask stuck = (~better & (length * quarter < line.damped)) | ~(tries < line.tries);
    const Mask back = ~onward & stuck;
    const Mask moves = ~back & (onward | better);
    ahead = xsimd::select(onward, ahead + ahead, xsimd::select(back, ahead * quarter, ahead));
    active = active & ~(back & (ahead < line.shortest));
    next = xsimd::select(onward | back, min(one, part + ahead), next);
    tries = xsimd::select(onward | back, zero, tries);
    goal_at(line, next, goal);
    const Residual further = residual(sums, goal);
    for (std::size_t k = 0; k < 3; ++k) left.r[k] = xsimd::select(onward, further.r[k], left.r[k]);
    left.size = xsimd::select(onward, further.size, left.size);
    const Coefficients newton = newton_step(sums, left);
    for (std::size_t k = 0; k < 3; ++k) {
      base.c[k] = xsimd::select(back, c.c[k], xsimd::select(moves, trial.c[k], base.c[k]));
      step.c[k] = xsimd::select(back, zero, xsimd::select(moves, newton.c[k], step.c[k]));
    }
    before = xsimd::select(back, infinity, xsimd::select(moves, left.size, before));
    const F32 longer = xsimd::select(onward, one, min(one, length + length));
    length = xsimd::select(back, one, xsimd::select(moves, longer, length * quarter));
  }
  return part;
}

template <class Form>
inline void continue_from_grey(float* const c[3], float* part, const float* const rgb[3],
                               const SigmoidTable& table, const float luminance[3], std::size_t n) noexcept {
  const F32 zero(0.0F);
  const F32 half(0.5F);
  const F32 one(1.0F);
  for (std::size_t at = 0; at < n; at += kWidth) {
    F32 v[3];
    for (std::size_t k = 0; k < 3; ++k) v[k] = load(rgb[k] + at);
    const Mask finite = (v[0] - v[0] == zero) & (v[1] - v[1] == zero) & (v[2] - v[2] == zero);
    const F32 y = (F32(luminance[0]) * v[0] + F32(luminance[1]) * v[1]) + F32(luminance[2]) * v[2];
    // The reflectance of 1 - colour is 1 - reflectance.
    const Mask bright = y > half;
    const F32 level = xsimd::select(bright, one - y, y);
    const Mask lit = finite & (level >= F32(kContinuationBlack));
    GreyLine line;
    line.grey = xsimd::select(lit, level, half);
    for (std::size_t k = 0; k < 3; ++k) {
      line.direction[k] = xsimd::select(bright, one - v[k], v[k]) - line.grey;
    }
    line.near = max(F32(kSigmoidRounding), line.grey * F32(kContinuationNear));
    line.met = max(F32(kSigmoidRounding), min(F32(kSigmoidUnsolved), line.grey * F32(kSigmoidMet)));
    Mask inside = finite;
    for (const F32& value : v) inside = inside & (value >= zero) & (value <= one);
    const auto effort = [inside](float within, float beyond) {
      return xsimd::select(inside, F32(within), F32(beyond));
    };
    line.shortest = effort(kContinuationInside.shortest, kContinuationOutside.shortest);
    line.damped = effort(kContinuationInside.damped, kContinuationOutside.damped);
    line.tries = effort(kContinuationInside.tries, kContinuationOutside.tries);
    line.steep = divide(F32(kSigmoidSteep), square_root(line.grey));
    Coefficients a = {{zero, zero, divide(line.grey - half, square_root(line.grey * (one - line.grey)))}};
    const F32 solved = follow<Form>(a, line, table, lit);
    a.c[2] = xsimd::select(lit, a.c[2], F32(-kSigmoidFar));
    for (std::size_t k = 0; k < 3; ++k) {
      const F32 turned = xsimd::select(bright, a.c[k] * F32(-1.0F), a.c[k]);
      store(c[k] + at, xsimd::select(finite, turned, F32(__builtin_nanf(""))));
    }
    store(part + at, xsimd::select(finite, solved, one));
  }
}

void sigmoid_continuation(float* const c[3], float* part, const float* const rgb[3],
                          const SigmoidTable& table, const float luminance[3], std::size_t n) noexcept {
  with_form(table.form,
            [&](auto form) { continue_from_grey<decltype(form)>(c, part, rgb, table, luminance, n); });
}

}  // namespace
}  // namespace spectile::kernels
