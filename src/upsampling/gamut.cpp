// Colours that a method cannot make, moved to those that it can.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile {
namespace rows {
namespace {

using kernels::kLanes;

// Moves at most before a colour becomes its grey: where the scale of a lane follows its largest component,
// the colour moved is a little brighter to the search, and may have to move again.
constexpr int kMoves = 6;

float weighted_luminance(const Upsampler& upsampler, const float v[3]) {
  const auto& weights = upsampler.luminance();
  return (weights[0] * v[0] + weights[1] * v[1]) + weights[2] * v[2];
}

bool is_finite(const float* const rgb[3], std::size_t i) {
  return std::isfinite(rgb[0][i]) && std::isfinite(rgb[1][i]) && std::isfinite(rgb[2][i]);
}

GamutReport count_negative(const float* const rgb[3], std::size_t n, std::uint8_t* lanes_outside) {
  GamutReport report;
  for (std::size_t i = 0; i < n; ++i) {
    const bool outside = is_finite(rgb, i) && (rgb[0][i] < 0 || rgb[1][i] < 0 || rgb[2][i] < 0);
    if (lanes_outside != nullptr) lanes_outside[i] = outside ? 1 : 0;
    if (!outside) continue;
    if (report.outside == 0) report.first = static_cast<std::int64_t>(i);
    ++report.outside;
  }
  return report;
}

GamutReport clip_bases(const kernels::KernelTable& kernels, const Upsampler& upsampler, float* const rgb[3],
                       GamutPolicy policy, std::size_t n, std::uint8_t* lanes_outside) {
  const GamutReport report = count_negative(rgb, n, lanes_outside);
  if (report.outside == 0 || policy != GamutPolicy::kClip) return report;
  for (std::size_t at = 0; at < n; at += kLanes) {
    float* const block[3] = {rgb[0] + at, rgb[1] + at, rgb[2] + at};
    std::uint64_t moved = 0;
    kernels.gamut_clip(block, upsampler.luminance().data(), 0.0F, std::numeric_limits<float>::infinity(),
                       &moved, kLanes);
  }
  return report;
}

/// Up to a block of colours that may be outside, solved together.
struct ClippedGroup {
  alignas(64) float rgb[3][kLanes] = {};
  alignas(64) float c[3][kLanes] = {};
  alignas(64) float scale[kLanes] = {};
  alignas(64) float part[kLanes] = {};
  std::size_t lane[kLanes] = {};
  std::size_t count = 0;
};

/// The colours of a group that have no coefficients, a bit each.
std::uint64_t unsolvable(const kernels::KernelTable& kernels, const Upsampler& upsampler,
                         ClippedGroup& group) {
  const float* const rgb[3] = {group.rgb[0], group.rgb[1], group.rgb[2]};
  const Coefficients out = {{group.c[0], group.c[1], group.c[2]},
                            has_scale(upsampler) ? group.scale : nullptr};
  std::uint64_t unsolved = 0;
  solve(kernels, upsampler, rgb, out, &unsolved, kLanes, group.part);
  if (!has_scale(upsampler)) return unsolved;
  for (std::size_t i = 0; i < group.count; ++i) {
    // No light has a colour without a positive component.
    if (group.scale[i] == 0 && (rgb[0][i] < 0 || rgb[1][i] < 0 || rgb[2][i] < 0)) {
      unsolved |= std::uint64_t{1} << i;
      group.part[i] = 0;
    }
  }
  return unsolved;
}

void move_lane(const Upsampler& upsampler, ClippedGroup& group, std::size_t i, bool to_grey) {
  const float v[3] = {group.rgb[0][i], group.rgb[1][i], group.rgb[2][i]};
  const float y = std::max(0.0F, weighted_luminance(upsampler, v));
  const float grey = upsampler.quantity() == Quantity::kReflectance ? std::min(1.0F, y) : y;
  const float part = to_grey ? 0.0F : group.part[i];
  for (std::size_t k = 0; k < 3; ++k) group.rgb[k][i] = part == 0 ? grey : grey + part * (v[k] - grey);
}

void clip_group(const kernels::KernelTable& kernels, const Upsampler& upsampler, ClippedGroup& group,
                float* const rgb[3], GamutPolicy policy, GamutReport& report, std::uint8_t* lanes_outside) {
  for (auto& plane : group.rgb) std::fill(plane + group.count, plane + kLanes, 0.5F);
  std::uint64_t outside = unsolvable(kernels, upsampler, group);
  for (std::uint64_t left = outside; left != 0; left &= left - 1) {
    const std::size_t lane = group.lane[std::countr_zero(left)];
    if (report.outside++ == 0) report.first = static_cast<std::int64_t>(lane);
    if (lanes_outside != nullptr) lanes_outside[lane] = 1;
  }
  if (outside != 0 && policy == GamutPolicy::kClip) {
    for (int move = 0; outside != 0; ++move) {
      for (std::uint64_t left = outside; left != 0; left &= left - 1) {
        move_lane(upsampler, group, static_cast<std::size_t>(std::countr_zero(left)), move == kMoves);
      }
      if (move == kMoves) break;
      outside = unsolvable(kernels, upsampler, group);
    }
    for (std::size_t i = 0; i < group.count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) rgb[k][group.lane[i]] = group.rgb[k][i];
    }
  }
  group.count = 0;
}

GamutReport clip_sigmoid(const kernels::KernelTable& kernels, const Upsampler& upsampler, float* const rgb[3],
                         GamutPolicy policy, std::size_t n, std::uint8_t* lanes_outside) {
  GamutReport report;
  if (lanes_outside != nullptr) std::fill_n(lanes_outside, n, std::uint8_t{0});
  const float highest =
      upsampler.quantity() == Quantity::kReflectance ? 1.0F : std::numeric_limits<float>::infinity();
  ClippedGroup group;
  const bool only_beyond = covers_unit_cube(upsampler);
  const auto beyond = [highest](float v) { return v < 0 || v > highest; };
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_finite(rgb, i)) continue;
    if (only_beyond && !beyond(rgb[0][i]) && !beyond(rgb[1][i]) && !beyond(rgb[2][i])) continue;
    for (std::size_t k = 0; k < 3; ++k) group.rgb[k][group.count] = rgb[k][i];
    group.lane[group.count++] = i;
    if (group.count == kLanes) clip_group(kernels, upsampler, group, rgb, policy, report, lanes_outside);
  }
  if (group.count > 0) clip_group(kernels, upsampler, group, rgb, policy, report, lanes_outside);
  return report;
}

}  // namespace

GamutReport gamut_clip(const kernels::KernelTable& kernels, const Upsampler& upsampler, float* const rgb[3],
                       GamutPolicy policy, std::size_t n, std::uint8_t* lanes_outside) {
  return stores_rgb(upsampler) ? clip_bases(kernels, upsampler, rgb, policy, n, lanes_outside)
                               : clip_sigmoid(kernels, upsampler, rgb, policy, n, lanes_outside);
}

}  // namespace rows

Result<GamutReport> gamut_clip(const Upsampler& upsampler, ColorSpan rgb, GamutPolicy policy,
                               const Execution& execution) {
  SPECTILE_TRY(shape::aligned(rgb));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const std::size_t blocks = blocks_for(rgb.lanes);
  std::vector<GamutReport> reports(blocks);
  tiles::for_blocks(blocks, execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    float* const planes[3] = {rgb.c[0] + at, rgb.c[1] + at, rgb.c[2] + at};
    const std::size_t lanes = std::min(count * kLanesPerBlock, rgb.lanes - at);
    GamutReport report = rows::gamut_clip(*table, upsampler, planes, policy, lanes);
    if (report.outside > 0) report.first += static_cast<std::int64_t>(at);
    reports[first] = report;
  });
  GamutReport total;
  for (const GamutReport& report : reports) {
    if (report.outside > 0 && total.outside == 0) total.first = report.first;
    total.outside += report.outside;
  }
  if (policy == GamutPolicy::kError && total.outside > 0) {
    return make_error(ErrorCode::kBadArgument,
                      "{} colours of the batch are out of gamut, the first in lane {}", total.outside,
                      total.first);
  }
  return total;
}

}  // namespace spectile
