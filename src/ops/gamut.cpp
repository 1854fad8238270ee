// Colours that a method cannot make, and the way to those that it can.
#include <algorithm>
#include <cmath>
#include <limits>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/ops/method_rows.hpp"
#include "src/ops/shape.hpp"
#include "src/ops/tiles.hpp"

namespace spectile {
namespace rows {
namespace {

using kernels::kLanes;

// Halvings of the way between the cube and the colour: the place on it is then known to 2^-8.
constexpr int kHalvings = 8;

struct Luminance {
  float weights[3];
  explicit Luminance(const Upsampler& upsampler) {
    for (std::size_t k = 0; k < 3; ++k) weights[k] = static_cast<float>(upsampler.rgb_to_xyz()[3 + k]);
  }
  float of(const float v[3]) const { return (weights[0] * v[0] + weights[1] * v[1]) + weights[2] * v[2]; }
};

GamutReport count_negative(const float* const rgb[3], std::size_t n) {
  GamutReport report;
  for (std::size_t i = 0; i < n; ++i) {
    if (!(rgb[0][i] < 0 || rgb[1][i] < 0 || rgb[2][i] < 0)) continue;
    if (report.outside == 0) report.first = static_cast<std::int64_t>(i);
    ++report.outside;
  }
  return report;
}

GamutReport limit_bases(const kernels::KernelTable& kernels, const Upsampler& upsampler, float* const rgb[3],
                        OutOfGamut policy, std::size_t n) {
  const GamutReport report = count_negative(rgb, n);
  if (report.outside == 0 || policy == OutOfGamut::kKeep) return report;
  const Luminance luminance(upsampler);
  for (std::size_t at = 0; at < n; at += kLanes) {
    float* const block[3] = {rgb[0] + at, rgb[1] + at, rgb[2] + at};
    std::uint64_t moved = 0;
    kernels.limit_gamut(block, luminance.weights, 0.0F, std::numeric_limits<float>::infinity(), &moved,
                        kLanes);
  }
  return report;
}

/// Up to a block of colours outside the cube, solved together.
struct Group {
  alignas(64) float target[3][kLanes] = {};
  alignas(64) float tried[3][kLanes] = {};
  alignas(64) float c[3][kLanes] = {};
  alignas(64) float scale[kLanes] = {};
  std::size_t lane[kLanes] = {};
  std::size_t count = 0;
};

/// Which colours of `tried` have coefficients.
std::uint64_t solvable(const kernels::KernelTable& kernels, const Upsampler& upsampler, Group& group) {
  const float* const rgb[3] = {group.tried[0], group.tried[1], group.tried[2]};
  const Coefficients out = {{group.c[0], group.c[1], group.c[2]},
                            has_scale(upsampler) ? group.scale : nullptr};
  std::uint64_t unsolved = 0;
  solve(kernels, upsampler, rgb, out, &unsolved, kLanes);
  if (has_scale(upsampler)) {
    // No light has a colour without a positive component.
    for (std::size_t i = 0; i < group.count; ++i) {
      const bool dark = group.scale[i] == 0 && (rgb[0][i] < 0 || rgb[1][i] < 0 || rgb[2][i] < 0);
      if (dark) unsolved |= std::uint64_t{1} << i;
    }
  }
  return ~unsolved;
}

bool has(std::uint64_t lanes, std::size_t i) {
  return ((lanes >> i) & 1U) != 0;
}

void limit_group(const kernels::KernelTable& kernels, const Upsampler& upsampler, Group& group,
                 float* const rgb[3], OutOfGamut policy, GamutReport& report) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::fill(group.target[k] + group.count, group.target[k] + kLanes, 0.5F);
    std::copy_n(group.target[k], kLanes, group.tried[k]);
  }
  const std::uint64_t inside = solvable(kernels, upsampler, group);
  bool any = false;
  for (std::size_t i = 0; i < group.count; ++i) {
    if (has(inside, i)) continue;
    if (report.outside++ == 0) report.first = static_cast<std::int64_t>(group.lane[i]);
    any = true;
  }
  if (!any || policy == OutOfGamut::kKeep) return;
  const Luminance luminance(upsampler);
  const bool bounded = upsampler.quantity() == Quantity::kReflectance;
  float grey[kLanes];
  float low[kLanes] = {};
  float high[kLanes];
  std::fill_n(high, kLanes, 1.0F);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const float v[3] = {group.target[0][i], group.target[1][i], group.target[2][i]};
    const float y = std::max(0.0F, luminance.of(v));
    grey[i] = bounded ? std::min(1.0F, y) : y;
    // What is inside the cube has a sigmoid; a little less, for rounding.
    float part = 1;
    for (const float value : v) {
      if (value < 0) part = std::min(part, grey[i] / (grey[i] - value));
      if (bounded && value > 1) part = std::min(part, (1 - grey[i]) / (value - grey[i]));
    }
    low[i] = part * 0.999999F;
  }
  for (int step = 0; step < kHalvings; ++step) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      const float part = 0.5F * (low[i] + high[i]);
      for (std::size_t k = 0; k < 3; ++k) group.tried[k][i] = grey[i] + part * (group.target[k][i] - grey[i]);
    }
    const std::uint64_t good = solvable(kernels, upsampler, group);
    for (std::size_t i = 0; i < kLanes; ++i) (has(good, i) ? low[i] : high[i]) = 0.5F * (low[i] + high[i]);
  }
  for (std::size_t i = 0; i < group.count; ++i) {
    if (has(inside, i)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      rgb[k][group.lane[i]] = grey[i] + low[i] * (group.target[k][i] - grey[i]);
    }
  }
}

GamutReport limit_sigmoid(const kernels::KernelTable& kernels, const Upsampler& upsampler,
                          float* const rgb[3], OutOfGamut policy, std::size_t n) {
  GamutReport report;
  const float highest =
      upsampler.quantity() == Quantity::kReflectance ? 1.0F : std::numeric_limits<float>::infinity();
  Group group;
  const auto outside = [&](std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!std::isfinite(rgb[k][i])) return false;
      if (rgb[k][i] < 0 || rgb[k][i] > highest) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (!outside(i)) continue;
    for (std::size_t k = 0; k < 3; ++k) group.target[k][group.count] = rgb[k][i];
    group.lane[group.count++] = i;
    if (group.count < kLanes) continue;
    limit_group(kernels, upsampler, group, rgb, policy, report);
    group.count = 0;
  }
  if (group.count > 0) limit_group(kernels, upsampler, group, rgb, policy, report);
  return report;
}

}  // namespace

GamutReport limit_gamut(const kernels::KernelTable& kernels, const Upsampler& upsampler, float* const rgb[3],
                        OutOfGamut policy, std::size_t n) {
  return mixes_bases(upsampler) ? limit_bases(kernels, upsampler, rgb, policy, n)
                                : limit_sigmoid(kernels, upsampler, rgb, policy, n);
}

}  // namespace rows

Result<GamutReport> limit_gamut(const Upsampler& upsampler, ColorSpan rgb, OutOfGamut policy,
                                const Execution& how) {
  for (const float* plane : rgb.c) SPECTILE_TRY(shape::aligned(plane));
  const auto table = dispatch::active();
  if (!table) return table.error();
  const std::size_t blocks = blocks_for(rgb.lanes);
  std::vector<GamutReport> reports(blocks);
  tiles::for_blocks(blocks, how, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    float* const planes[3] = {rgb.c[0] + at, rgb.c[1] + at, rgb.c[2] + at};
    const std::size_t lanes = std::min(count * kLanesPerBlock, rgb.lanes - at);
    GamutReport report = rows::limit_gamut(**table, upsampler, planes, policy, lanes);
    if (report.outside > 0) report.first += static_cast<std::int64_t>(at);
    reports[first] = report;
  });
  GamutReport total;
  for (const GamutReport& report : reports) {
    if (report.outside > 0 && total.outside == 0) total.first = report.first;
    total.outside += report.outside;
  }
  return total;
}

}  // namespace spectile
