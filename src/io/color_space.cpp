// The RGB space that a file declares, and its way to linear sRGB.
#include "src/io/color_space.hpp"

#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cmath>
#include <string_view>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

// Primaries and whites: Rec.709, Rec.2020 and Display P3 from ITU-R BT.709-6, BT.2020-2 and SMPTE EG 432-1,
// Adobe RGB from its 2005 specification, AP0 and AP1 from SMPTE ST 2065-1 and ACES S-2014-004.
constexpr struct {
  std::string_view id;
  const char* name;
  color::Chromaticities chromaticities;
} kInteropSpaces[] = {
    {"lin_rec709_scene", "linear Rec.709", color::kRec709},
    {"lin_srgb_scene", "linear sRGB", color::kRec709},
    {"lin_p3d65_scene", "linear P3-D65", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}}},
    {"lin_rec2020_scene",
     "linear Rec.2020",
     {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}},
    {"lin_adobergb_scene", "linear Adobe RGB", {{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.3290}}},
    {"lin_ap0_scene", "ACES2065-1", {{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}}},
    {"lin_ap1_scene", "ACEScg", {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}}},
};

bool close(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::abs(a[0] - b[0]) < 1e-4 && std::abs(a[1] - b[1]) < 1e-4;
}

std::array<double, 2> pair(const Imath::V2f& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

Result<ColorSpace> from_interop_id(const std::string& id, const std::string& path) {
  for (const auto& known : kInteropSpaces) {
    if (known.id == id) return ColorSpace{known.name, known.chromaticities, false};
  }
  if (id == "lin_ciexyzd65_scene") {
    // XYZ as an RGB space whose white is D65: its 1, 1, 1 is not the white, so no white can be adapted.
    return ColorSpace{"CIE XYZ (D65)", {{1, 0}, {0, 1}, {0, 0}, {1.0 / 3.0, 1.0 / 3.0}}, true};
  }
  if (id.starts_with("srgb_") || id.starts_with("g22_") || id.starts_with("g18_")) {
    return make_error(ErrorCode::kBadFile,
                      "{}: colorInteropID \"{}\" is not linear; convert the image to linear first", path, id);
  }
  return make_error(ErrorCode::kBadFile,
                    "{}: colorInteropID \"{}\" is not a colour space that can be converted", path, id);
}

}  // namespace

Result<ColorSpace> color_space_of(const Imf::Header& header, const std::string& path) {
  const auto* id = header.findTypedAttribute<Imf::StringAttribute>("colorInteropID");
  if (id != nullptr && id->value() != "unknown" && !id->value().empty())
    return from_interop_id(id->value(), path);
  const auto* declared = header.findTypedAttribute<Imf::ChromaticitiesAttribute>("chromaticities");
  if (declared == nullptr) return ColorSpace{};
  const Imf::Chromaticities& c = declared->value();
  const color::Chromaticities space = {pair(c.red), pair(c.green), pair(c.blue), pair(c.white)};
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
  const ColorSpace out{"chromaticities of the file", space, false};
  if (is_srgb(out)) return ColorSpace{"linear Rec.709 (chromaticities)", color::kRec709, false};
  return out;
}

bool is_srgb(const ColorSpace& space) {
  const color::Chromaticities& c = space.chromaticities;
  return close(c.red, color::kRec709.red) && close(c.green, color::kRec709.green) &&
         close(c.blue, color::kRec709.blue) && close(c.white, color::kRec709.white);
}

Matrix3 to_srgb(const ColorSpace& space, Quantity quantity) {
  const Matrix3 to_xyz = color::rgb_to_xyz(space.chromaticities);
  if (quantity == Quantity::kIlluminant || space.relative_to_d65) {
    return color::product(xyz_to_srgb_matrix(), to_xyz);
  }
  const Matrix3 adapt = color::bradford(space.chromaticities.white, color::kRec709.white);
  return color::product(xyz_to_srgb_matrix(), color::product(adapt, to_xyz));
}

}  // namespace spectile::io
