// A line of colour as an output's channels: names, range of halves, packing.
#include "src/io/convert/stages/color_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/base/errors.hpp"

namespace spectile::io {

void add_color_tag(TextAttributes& texts, ColorTarget target) {
  // Names of the Color Interop Forum.
  if (target == ColorTarget::kSrgb) texts.emplace_back("colorInteropID", "lin_rec709_scene");
  if (target != ColorTarget::kXyz) return;
  texts.emplace_back("colorInteropID", "lin_ciexyzd65_scene");
  // OpenImageIO before 3.0 knows its own attribute only, and takes files without for linear Rec.709.
  texts.emplace_back("oiio:ColorSpace", "lin_ciexyzd65_scene");
}

std::vector<const char*> color_channels(ColorTarget target) {
  switch (target) {
    case ColorTarget::kXyz:
      return {"X", "Y", "Z"};
    case ColorTarget::kLuminance:
      return {"Y"};
    case ColorTarget::kSrgb:
      break;
  }
  return {"R", "G", "B"};
}

std::uint64_t clamp_to_half(const kernels::KernelTable& kernels, const ColorLine& line, std::size_t count,
                            std::size_t width) {
  float* const* rows = line.rows;
  std::uint64_t clamped = 0;
  for (std::size_t x = 0; x < width; ++x) {
    bool beyond = false;
    for (std::size_t k = 0; k < count; ++k) beyond = beyond || std::fabs(rows[k][x]) > kernels::kHalfMax;
    clamped += beyond ? 1 : 0;
  }
  if (clamped > 0) {
    for (std::size_t k = 0; k < count; ++k) {
      kernels.clamp(rows[k], rows[k], -kernels::kHalfMax, kernels::kHalfMax, line.padded);
    }
  }
  return clamped;
}

void store_row(const kernels::KernelTable& kernels, const float* row, std::size_t width, SampleType type,
               float* halves, std::byte* out) {
  if (type == SampleType::kFloat) {
    std::memcpy(out, row, width * sizeof(float));
    return;
  }
  auto* const packed = reinterpret_cast<std::uint16_t*>(halves);
  kernels.float_to_half(packed, row, blocks_for(width) * kLanesPerBlock);
  std::memcpy(out, packed, width * sizeof(std::uint16_t));
}

void load_colors(const Strip& strip, int line, std::size_t first, std::size_t count, ColorLine& to) {
  const auto width = static_cast<std::size_t>(strip.width);
  to.set_width(width);
  for (std::size_t k = 0; k < count; ++k) {
    std::memcpy(to.rows[k], strip.row(first + k, line), width * sizeof(float));
    std::fill(to.rows[k] + width, to.rows[k] + to.padded, 0.0F);
  }
}

Matrix3 color_matrix(const Projector& projector, ColorTarget target, Adaptation adaptation) {
  Matrix3 out = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (adaptation != Adaptation::kNone) {
    // To the white that becomes sRGB's 1, 1, 1.
    const std::array<double, 3> d65 = times(inverse(projector.xyz_to_srgb()), {1, 1, 1});
    out = adaptation_matrix(adaptation, projector.white(), d65);
  }
  return target == ColorTarget::kSrgb ? product(projector.xyz_to_srgb(), out) : out;
}

void note_white(double compensation, std::vector<std::string>& notes) {
  if (compensation >= 1) return;
  notes.push_back(fmt::format(
      "the bands miss much of the visible range: {:.0f} % of the tint that this gives to white is taken out",
      100 * compensation));
}

}  // namespace spectile::io
