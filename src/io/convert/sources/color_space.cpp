// The RGB space that a file declares, and its way to linear sRGB.
#include "src/io/convert/sources/color_space.hpp"

#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cmath>
#include <string_view>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

// Names of the Color Interop Forum and ours.
constexpr struct {
  std::string_view id;
  std::string_view space;
} kInteropSpaces[] = {
    {"lin_rec709_scene", "rec709"},   {"lin_srgb_scene", "srgb"},          {"lin_p3d65_scene", "display-p3"},
    {"lin_rec2020_scene", "rec2020"}, {"lin_adobergb_scene", "adobe-rgb"}, {"lin_ap0_scene", "aces2065-1"},
    {"lin_ap1_scene", "acescg"},      {"lin_ciexyzd65_scene", "xyz"},
};

bool close(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::abs(a[0] - b[0]) < 1e-4 && std::abs(a[1] - b[1]) < 1e-4;
}

std::array<double, 2> pair(const Imath::V2f& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

Result<RgbSpace> from_interop_id(const std::string& id, const std::string& path) {
  for (const auto& known : kInteropSpaces) {
    if (known.id == id) return rgb_space(known.space);
  }
  if (id.starts_with("srgb_") || id.starts_with("g22_") || id.starts_with("g18_")) {
    return make_error(ErrorCode::kBadFile,
                      "{}: colorInteropID \"{}\" is not linear; convert the image to linear first", path, id);
  }
  return make_error(ErrorCode::kBadFile,
                    "{}: colorInteropID \"{}\" is not a colour space that can be converted", path, id);
}

}  // namespace

Result<RgbSpace> color_space_of(const Imf::Header& header, const std::string& path) {
  const auto* id = header.findTypedAttribute<Imf::StringAttribute>("colorInteropID");
  if (id != nullptr && id->value() != "unknown" && !id->value().empty())
    return from_interop_id(id->value(), path);
  const auto* declared = header.findTypedAttribute<Imf::ChromaticitiesAttribute>("chromaticities");
  if (declared == nullptr) return RgbSpace{};
  const Imf::Chromaticities& c = declared->value();
  const Chromaticities space = {pair(c.red), pair(c.green), pair(c.blue), pair(c.white)};
  bool finite = true;
  for (const auto& xy : {space.red, space.green, space.blue, space.white}) {
    finite = finite && std::isfinite(xy[0]) && std::isfinite(xy[1]);
  }
  const double area = (space.green[0] - space.red[0]) * (space.blue[1] - space.red[1]) -
                      (space.blue[0] - space.red[0]) * (space.green[1] - space.red[1]);
  if (!finite || std::abs(area) < 1e-6 || std::abs(space.white[1]) < 1e-6) {
    return make_error(
        ErrorCode::kBadFile,
        "{}: chromaticities red ({}, {}) green ({}, {}) blue ({}, {}) white ({}, {}) span no RGB space", path,
        c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y);
  }
  const RgbSpace out{"", "chromaticities of the file", space, false};
  if (is_srgb(out)) return RgbSpace{"rec709", "linear Rec.709 (chromaticities)", kRec709, false};
  return out;
}

bool is_srgb(const RgbSpace& space) {
  const Chromaticities& c = space.chromaticities;
  return close(c.red, kRec709.red) && close(c.green, kRec709.green) && close(c.blue, kRec709.blue) &&
         close(c.white, kRec709.white);
}

Matrix3 to_srgb(const RgbSpace& space, Quantity quantity) {
  const Matrix3 to_xyz = rgb_to_xyz(space.chromaticities);
  if (quantity == Quantity::kIlluminant || space.relative_to_d65) {
    return product(xyz_to_srgb_matrix(), to_xyz);
  }
  const Matrix3 adapt =
      adaptation_matrix(Adaptation::kBradford, chromaticity_to_xyz(space.chromaticities.white),
                        chromaticity_to_xyz(kRec709.white));
  return product(xyz_to_srgb_matrix(), product(adapt, to_xyz));
}

}  // namespace spectile::io
