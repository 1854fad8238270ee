// StraightColor: premultiplied colours taken apart into straight ones and a scale, where a method needs it.
#include "src/io/convert/stages/straight_color.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/base/errors.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile::io {
namespace {

// How far a colour may be above its alpha by rounding to half, of both.
constexpr float kRoundedAbove = 1 + 0x1p-9F;

}  // namespace

StraightColor::StraightColor(const RgbSource& source, const Upsampler& upsampler,
                             const MethodOptions& options, const kernels::KernelTable& kernels)
    : kernels_(kernels) {
  if (options.alpha_meaning() != AlphaMeaning::kPremultiplied || !source.alpha()) return;
  if (rows::is_homogeneous(upsampler)) return;
  plane_ = source.alpha();
  type_ = source.planes()[*plane_].type;
}

void StraightColor::divide(const Strip& strip, int line, float* const rgb[3], float* scale,
                           LineStats& stats) const {
  const auto width = static_cast<std::size_t>(strip.width);
  const std::size_t padded = blocks_for(width) * kLanesPerBlock;
  const std::byte* const row = strip.row(*plane_, line);
  if (type_ == SampleType::kHalf) {
    kernels_.half_to_float(scale, reinterpret_cast<const std::uint16_t*>(row), padded);
  } else if (type_ == SampleType::kFloat) {
    std::memcpy(scale, row, width * sizeof(float));
  } else {
    const auto* const whole = reinterpret_cast<const std::uint32_t*>(row);
    for (std::size_t x = 0; x < width; ++x) scale[x] = static_cast<float>(whole[x]);
  }
  std::fill(scale + width, scale + padded, 1.0F);
  std::uint64_t divided = 0;
  std::uint64_t above = 0;
  for (std::size_t x = 0; x < width; ++x) {
    const float alpha = scale[x];
    const float most = std::max({std::fabs(rgb[0][x]), std::fabs(rgb[1][x]), std::fabs(rgb[2][x])});
    // Not for NaN.
    const bool partly = alpha > 0 && alpha < 1 && most > 0;
    scale[x] = partly ? std::max(alpha, std::min(most, 1.0F)) : 1.0F;
    divided += partly ? 1 : 0;
    above += partly && most > alpha * kRoundedAbove ? 1 : 0;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    float* const component = rgb[k];
    for (std::size_t x = 0; x < width; ++x) component[x] /= scale[x];
  }
  stats.divided_by_alpha += divided;
  stats.above_alpha += above;
}

void note_alpha(const LineStats& stats, bool assumed, std::vector<std::string>& notes) {
  if (assumed && stats.divided_by_alpha > 0) {
    notes.push_back(
        fmt::format("colour is taken as premultiplied by alpha, which is between 0 and 1 in {} pixel{}; "
                    "--alpha straight or ignore states another",
                    stats.divided_by_alpha, stats.divided_by_alpha == 1 ? "" : "s"));
  }
  if (stats.above_alpha == 0) return;
  notes.push_back(fmt::format(
      "{} pixel{} brighter than alpha, as light is and no reflectance: taken as {} largest component "
      "times a reflectance",
      stats.above_alpha, stats.above_alpha == 1 ? " is" : "s are", stats.above_alpha == 1 ? "its" : "their"));
}

}  // namespace spectile::io
