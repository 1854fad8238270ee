// The RGB space that a file declares, and its way to linear sRGB.
#include "src/io/convert/sources/color_space.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <spectile/image/image.hpp>
#include <string_view>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

// Names of the Color Interop Forum and ours.
constexpr struct {
  std::string_view id;
  std::string_view space;
} kInteropSpaces[] = {
    {"lin_rec709_scene", "lin_rec709"},  {"lin_srgb_scene", "lin_rec709"},
    {"lin_p3d65_scene", "display-p3"},   {"lin_rec2020_scene", "rec2020"},
    {"lin_adobergb_scene", "adobe-rgb"}, {"lin_ap0_scene", "aces2065-1"},
    {"lin_ap1_scene", "acescg"},         {"lin_ciexyzd65_scene", "xyz"},
};

bool close(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::abs(a[0] - b[0]) < 1e-4 && std::abs(a[1] - b[1]) < 1e-4;
}

bool same(const Chromaticities& a, const Chromaticities& b) {
  return close(a.red, b.red) && close(a.green, b.green) && close(a.blue, b.blue) && close(a.white, b.white);
}

/// True where the primaries are X, Y and Z themselves: white E only says that equal amounts are, and calls
/// for no adaptation.
bool is_xyz(const RgbSpace& space) {
  constexpr double kThird = 1.0 / 3.0;
  return same(space.chromaticities, {{1, 0}, {0, 1}, {0, 0}, {kThird, kThird}});
}

std::array<double, 2> pair(const std::array<float, 2>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1])};
}

/// OpenImageIO's name of the space in lower case; empty for its names of linear Rec.709, as which it takes
/// files without one.
std::string oiio_name(const PartHeader& header) {
  std::string name = header.text("oiio:ColorSpace").value_or("");
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with("_scene")) name.resize(name.size() - 6);
  const bool usual = name == "linear" || name == "scene_linear" || name == "lin_srgb" || name == "lin_rec709";
  return usual ? "" : name;
}

Result<RgbSpace> from_oiio_name(const std::string& name, const std::string& path) {
  // "sRGB" is the encoded space there.
  const auto space = rgb_space(name);
  if (space && name != "srgb") return *space;
  return make_error(ErrorCode::kBadFile,
                    "{}: oiio:ColorSpace \"{}\" is not a linear colour space that can be converted; "
                    "--input-space states what it is",
                    path, name);
}

Result<RgbSpace> from_interop_id(const std::string& id, const std::string& path) {
  for (const auto& known : kInteropSpaces) {
    if (known.id == id) return rgb_space(known.space);
  }
  if (id.starts_with("srgb_") || id.starts_with("g22_") || id.starts_with("g18_")) {
    return make_error(
        ErrorCode::kBadFile,
        "{}: colorInteropID \"{}\" is not linear; convert the image to linear first, or state with "
        "--input-space what it is",
        path, id);
  }
  return make_error(
      ErrorCode::kBadFile,
      "{}: colorInteropID \"{}\" is not a colour space that can be converted; --input-space states what it "
      "is",
      path, id);
}

}  // namespace

bool states_color_space(const PartHeader& header) {
  const std::string id = header.text("colorInteropID").value_or("");
  return (!id.empty() && id != "unknown") || header.chromaticities().has_value() ||
         header.has_attribute("oiio:ColorSpace");
}

Result<RgbSpace> color_space_of(const PartHeader& header, const std::string& path) {
  const std::string id = header.text("colorInteropID").value_or("");
  if (!id.empty() && id != "unknown") return from_interop_id(id, path);
  const auto declared = header.chromaticities();
  if (!declared) {
    const std::string name = oiio_name(header);
    return name.empty() ? RgbSpace{} : from_oiio_name(name, path);
  }
  const auto& [red, green, blue, white] = *declared;
  const Chromaticities space = {pair(red), pair(green), pair(blue), pair(white)};
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
        red[0], red[1], green[0], green[1], blue[0], blue[1], white[0], white[1]);
  }
  const RgbSpace out{"", "chromaticities of the file", space, false};
  if (is_xyz(out)) return rgb_space("xyz");
  if (is_srgb(out)) return RgbSpace{"lin_rec709", "linear Rec.709 (chromaticities)", kRec709, false};
  return out;
}

Result<RgbSpace> input_space_of(const PartHeader& header, const std::string& path,
                                const std::optional<RgbSpace>& stated, std::vector<std::string>& notes) {
  if (stated) {
    if (stated->name == "srgb")
      notes.emplace_back("input space srgb is taken as linear Rec.709 (lin_rec709)");
    if (const auto declared = color_space_of(header, path);
        states_color_space(header) && declared && !same(declared->chromaticities, stated->chromaticities)) {
      notes.push_back(fmt::format("taken as {}, as --input-space states; the file says {}",
                                  stated->description, declared->description));
    }
    return *stated;
  }
  if (!states_color_space(header)) notes.emplace_back(kAssumedSpaceNote);
  return color_space_of(header, path);
}

bool is_srgb(const RgbSpace& space) {
  return same(space.chromaticities, kRec709);
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
