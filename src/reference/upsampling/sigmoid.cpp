// The sigmoid in one lane, and the search for its coefficients.
#include "src/reference/upsampling/sigmoid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "src/reference/upsampling/sigmoid_sums.hpp"

namespace spectile::reference {
namespace {

using namespace kernels;

/// True if this step is the last: the error after a Newton step grows with the residual times the step.
bool is_last(float size, const float step[3], float close) {
  // A step of no length stands for one that was not finite.
  const float length = magnitude_sum(step);
  return size * length <= close && size <= kSigmoidNear && length > 0.0F;
}

/// Start coefficients for a colour in the dark half of the cube: the expansion around the nearest node.
void start(const float v[3], float c[3], const SigmoidTable& table) {
  const std::size_t most = v[0] >= v[1] && v[0] >= v[2] ? 0 : v[1] >= v[2] ? 1 : 2;
  const float z = v[most];
  const float inverse = 1.0F / z;
  const float q[3] = {1.0F - std::sqrt(1.0F - z), std::sqrt(v[(most + 1) % 3] * inverse),
                      std::sqrt(v[(most + 2) % 3] * inverse)};
  const auto steps = static_cast<float>(table.steps);
  auto node = static_cast<std::int32_t>(most);
  float d[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const float scaled = q[i] * steps;
    const float limited = steps - 0.5F < scaled ? steps - 0.5F : scaled;
    const auto cell = static_cast<std::int32_t>(limited);
    d[i] = scaled - (static_cast<float>(cell) + 0.5F);
    node = node * table.steps + cell;
  }
  const float* const entry = table.nodes + static_cast<std::size_t>(node) * kSigmoidNode;
  const float root = 1.0F / std::sqrt(z);
  for (std::size_t k = 0; k < 3; ++k) {
    const float* const e = entry + 3 + 9 * k;
    // By the powers of the first distance, then of the second, then of the third.
    const float first = fused(fused(e[3], d[0], e[0]), d[0], entry[k]);
    const float slope = fused(e[4], d[1], fused(e[6], d[0], e[1]));
    const float last_slope = fused(e[5], d[2], fused(e[8], d[1], fused(e[7], d[0], e[2])));
    c[k] = fused(last_slope, d[2], fused(slope, d[1], first)) * root;
  }
}

/// A colour that is searched for, and under which conditions.
struct Search {
  float target[3];
  float close;  // what the residual times the step may be at the end
  float steep;  // longest coefficients allowed
  float scale;  // power of four that brightens the first colour searched for
  int steps;    // evaluations at most
};

/// Steps from coefficients for the brightened colour to those of the target.
void refine(float c[3], const Search& search, const SigmoidTable& table) {
  float scale = search.scale;
  float goal[3];
  for (std::size_t k = 0; k < 3; ++k) goal[k] = search.target[k] * scale;
  Sums sums = band_sums(c, table);
  float r[3];
  float size = residual(sums, goal, r);
  float part = 1;
  for (int i = 0; i < search.steps; ++i) {
    float step[3];
    newton_step(sums, r, step);
    const bool rounded = size <= kSigmoidFloor;
    const bool arrived = rounded || is_last(size, step, search.close);
    float trial[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const float length = rounded ? 0.0F : arrived ? 1.0F : part;
      trial[k] = c[k] + length * step[k];
    }
    if (arrived && scale == 1.0F) {
      std::copy(trial, trial + 3, c);
      return;
    }
    if (arrived) {
      scale = scale * 0.25F;
      for (std::size_t k = 0; k < 3; ++k) {
        trial[k] = trial[k] + trial[k];
        goal[k] = search.target[k] * scale;
      }
    }
    const Sums sums_there = band_sums(trial, table);
    float r_there[3];
    const float size_there = residual(sums_there, goal, r_there);
    if (arrived || (size_there < size && magnitude_sum(trial) <= search.steep)) {
      std::copy(trial, trial + 3, c);
      std::copy(r_there, r_there + 3, r);
      sums = sums_there;
      size = size_there;
      part = arrived || part + part > 1 ? 1 : part + part;
    } else {
      part = part * 0.25F;
      if (part < kSigmoidShortest) break;
    }
  }
  const float root = std::sqrt(scale);
  for (std::size_t k = 0; k < 3; ++k) c[k] = c[k] * root;
}

/// True if the coefficients have the target's colour, of which z is the largest component.
bool is_met(const float c[3], const float target[3], float z, const SigmoidTable& table) {
  float r[3];
  const float size = residual(band_sums(c, table), target, r);
  return size <= std::max(kSigmoidRounding, std::min(kSigmoidUnsolved, z * kSigmoidMet));
}

}  // namespace

float half_inverse_root(float t) noexcept {
  const auto y0 = std::bit_cast<float>(kRootGuess - (std::bit_cast<std::uint32_t>(t) >> 1));
  const float f = (y0 * y0) * t;
  const float y1 = y0 * fused(f, f - kRootSecond, kRootFirst);
  return y1 * fused(-(y1 * y1), t, kRootThird);
}

float sigmoid_argument(SigmoidForm form, const float c[3], float p, float q) noexcept {
  return form == SigmoidForm::kFunctions ? fused(c[0], p, fused(c[1], q, c[2]))
                                         : fused(fused(c[0], q, c[1]), q, c[2]);
}

float sigmoid_argument(SigmoidForm form, const float c[3], const float* row) noexcept {
  return sigmoid_argument(form, c, row[kSigmoidP], row[kSigmoidQ]);
}

SigmoidPoint sigmoid_point(float x) noexcept {
  const float root = half_inverse_root(fused(x, x, 1.0F));
  return {fused(x, root, 0.5F), root};
}

float sigmoid_sample(float x) noexcept {
  const float s = sigmoid_point(x).sample;
  const float above = s < 0.0F ? 0.0F : s;
  return 1.0F < above ? 1.0F : above;
}

bool sigmoid_coefficients(float c[3], const float rgb[3], const SigmoidTable& table) noexcept {
  bool finite = true;
  for (std::size_t k = 0; k < 3; ++k) finite = finite && rgb[k] - rgb[k] == 0.0F;
  if (!finite) {
    for (std::size_t k = 0; k < 3; ++k) c[k] = std::numeric_limits<float>::quiet_NaN();
    return true;
  }
  float v[3];
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const float above = rgb[k] < 0.0F ? 0.0F : rgb[k];
    v[k] = 1.0F < above ? 1.0F : above;
    inside = inside && v[k] == rgb[k];
  }
  // The reflectance of 1 - colour is 1 - reflectance: only the dark half of the cube is searched.
  const bool bright = std::max({v[0], v[1], v[2]}) + std::min({v[0], v[1], v[2]}) > 1.0F;
  float target[3];
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = bright ? 1.0F - v[k] : v[k];
    target[k] = bright ? 1.0F - rgb[k] : rgb[k];
  }
  const float z = std::max({v[0], v[1], v[2]});
  const bool black = z < kSigmoidBlack;
  const bool grey = v[0] == v[1] && v[1] == v[2];
  bool solved = true;
  if (inside && black) {
    c[0] = c[1] = 0;
    c[2] = -kSigmoidFar;
  } else if (inside && grey) {
    c[0] = c[1] = 0;
    c[2] = (z - 0.5F) / std::sqrt(z * (1.0F - z));
  } else {
    const float lit[3] = {black ? 0.5F : v[0], black ? 0.5F : v[1], black ? 0.5F : v[2]};
    start(lit, c, table);
    const Sums sums = band_sums(c, table);
    float r[3];
    const float size = residual(sums, target, r);
    float step[3];
    newton_step(sums, r, step);
    const bool near = size <= kSigmoidNear * z;
    for (std::size_t k = 0; k < 3; ++k) c[k] = near ? c[k] + step[k] : c[k];
    const float close = kSigmoidClose * (z < kSigmoidDark ? kSigmoidDark : z);
    const bool last = inside && near && is_last(size, step, close);
    if (!last) {
      Search search = {{target[0], target[1], target[2]}, close, kSigmoidFar, 1.0F, kSigmoidSteps};
      if (inside) {
        for (int level = 0; level < kSigmoidLevels; ++level) {
          if (z * search.scale < kSigmoidLit) search.scale = search.scale * 4.0F;
        }
        const float lit_up[3] = {v[0] * search.scale, v[1] * search.scale, v[2] * search.scale};
        if (search.scale > 1.0F) start(lit_up, c, table);
      } else {
        search.steep = kSigmoidSteep / std::sqrt(black ? 0.5F : z);
        search.steps = kSigmoidStepsOutside;
      }
      refine(c, search, table);
      solved = is_met(c, target, black ? 0.5F : z, table);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) c[k] = bright ? -c[k] : c[k];
  return solved;
}

}  // namespace spectile::reference
