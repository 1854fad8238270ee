// Continuation toward the grey axis in one lane, operation by operation as the kernels do it.
#include <algorithm>
#include <limits>

#include "src/reference/upsampling/sigmoid_sums.hpp"

namespace spectile::reference {

using namespace kernels;

float sigmoid_continuation(float c[3], const float rgb[3], const SigmoidTable& table,
                           const float luminance[3]) noexcept {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  bool finite = true;
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    finite = finite && rgb[k] - rgb[k] == 0.0F;
    inside = inside && rgb[k] >= 0.0F && rgb[k] <= 1.0F;
  }
  const ContinuationEffort& effort = inside ? kContinuationInside : kContinuationOutside;
  if (!finite) {
    for (std::size_t k = 0; k < 3; ++k) c[k] = std::numeric_limits<float>::quiet_NaN();
    return 1;
  }
  const float y = (luminance[0] * rgb[0] + luminance[1] * rgb[1]) + luminance[2] * rgb[2];
  // The reflectance of 1 - colour is 1 - reflectance.
  const bool bright = y > 0.5F;
  const float grey = bright ? 1.0F - y : y;
  if (!(grey >= kContinuationBlack)) {
    c[0] = c[1] = bright ? -0.0F : 0.0F;
    c[2] = bright ? kSigmoidFar : -kSigmoidFar;
    return 0;
  }
  c[0] = c[1] = 0;
  float direction[3];
  for (std::size_t k = 0; k < 3; ++k) direction[k] = (bright ? 1.0F - rgb[k] : rgb[k]) - grey;
  c[2] = (grey - 0.5F) / std::sqrt(grey * (1.0F - grey));
  const float near = std::max(kSigmoidRounding, grey * kContinuationNear);
  const float met = std::max(kSigmoidRounding, std::min(kSigmoidUnsolved, grey * kSigmoidMet));
  const float steep = kSigmoidSteep / std::sqrt(grey);
  float base[3] = {c[0], c[1], c[2]};
  float step[3] = {0, 0, 0};
  float length = 1;
  float part = 0;
  float ahead = kContinuationFirst;
  float next = kContinuationFirst;
  float before = kInfinity;  // residual of the base, for the same place
  float best = kInfinity;    // residual at the line's end
  float tries = 0;
  for (int i = 0; i < kContinuationSteps; ++i) {
    float trial[3];
    for (std::size_t k = 0; k < 3; ++k) trial[k] = base[k] + length * step[k];
    const Sums sums = band_sums(trial, table);
    float goal[3];
    for (std::size_t k = 0; k < 3; ++k) goal[k] = fused(next, direction[k], grey);
    float r[3];
    float size = residual(sums, goal, r);
    const bool usable = magnitude_sum(trial) <= steep;
    const bool end = next == 1.0F;
    const bool there = usable && size <= (end ? met : near);
    if (there && (!end || size < best)) {
      std::copy(trial, trial + 3, c);
      part = next;
      best = end ? size : kInfinity;
    }
    if (part == 1.0F && (size <= kSigmoidFloor || !(usable && size < kContinuationGain * before))) break;
    const bool onward = there && !end;
    const bool better = usable && size < before;
    tries = tries + 1.0F;
    if (!onward && ((!better && length * 0.25F < effort.damped) || !(tries < effort.tries))) {
      ahead = ahead * 0.25F;
      if (ahead < effort.shortest) break;
      next = std::min(1.0F, part + ahead);
      for (std::size_t k = 0; k < 3; ++k) {
        base[k] = c[k];
        step[k] = 0;
      }
      length = 1;
      before = kInfinity;
      tries = 0;
      continue;
    }
    if (!onward && !better) {
      length = length * 0.25F;
      continue;
    }
    if (onward) {
      ahead = ahead + ahead;
      next = std::min(1.0F, part + ahead);
      for (std::size_t k = 0; k < 3; ++k) goal[k] = fused(next, direction[k], grey);
      size = residual(sums, goal, r);
      tries = 0;
    }
    before = size;
    length = onward ? 1.0F : std::min(1.0F, length + length);
    std::copy(trial, trial + 3, base);
    newton_step(sums, r, step);
  }
  for (std::size_t k = 0; k < 3; ++k) c[k] = bright ? -c[k] : c[k];
  return part;
}

}  // namespace spectile::reference
