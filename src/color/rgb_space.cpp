// RGB colour spaces by name, their matrices from chromaticities, and chromatic adaptation, in double.
#include <algorithm>
#include <cctype>
#include <spectile/color/rgb_space.hpp>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

// Primaries and whites: Rec.709, Rec.2020 and Display P3 from ITU-R BT.709-6, BT.2020-2 and SMPTE EG 432-1,
// Adobe RGB from its 2005 specification, AP0 and AP1 from SMPTE ST 2065-1 and ACES S-2014-004. XYZ is an RGB
// space whose 1, 1, 1 is not the white that its values are meant under.
constexpr struct {
  std::string_view name;
  const char* description;
  Chromaticities chromaticities;
  bool relative_to_d65;
} kSpaces[] = {
    {"lin_rec709", "linear Rec.709", kRec709, false},
    {"display-p3",
     "linear P3-D65",
     {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}},
     false},
    {"rec2020", "linear Rec.2020", {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}, false},
    {"adobe-rgb", "linear Adobe RGB", {{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.3290}}, false},
    {"acescg", "ACEScg", {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}}, false},
    {"aces2065-1",
     "ACES2065-1",
     {{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}},
     false},
    {"xyz", "CIE XYZ (D65)", {{1, 0}, {0, 1}, {0, 0}, {1.0 / 3.0, 1.0 / 3.0}}, true},
};

// Other names: those of the Color Interop Forum, and our old one. An empty space: an encoded one.
constexpr struct {
  std::string_view name;
  std::string_view space;
} kAliases[] = {
    {"lin_srgb", "lin_rec709"},
    {"rec709", "lin_rec709"},
    {"lin_p3d65", "display-p3"},
    {"lin_rec2020", "rec2020"},
    {"lin_adobergb", "adobe-rgb"},
    {"lin_ap1", "acescg"},
    {"lin_ap0", "aces2065-1"},
    {"lin_ciexyzd65", "xyz"},
    {"srgb_texture", ""},
    {"srgb_rec709", ""},
    {"g22_rec709", ""},
    {"g18_rec709", ""},
};

constexpr Matrix3 kBradford = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
constexpr Matrix3 kCat16 = {0.401288, 0.650173,  -0.051461, -0.250268, 1.204414,
                            0.045854, -0.002079, 0.048952,  0.953127};

}  // namespace

Result<RgbSpace> rgb_space(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // Linear to one half of the field and encoded to the other: the name stays, so that it can be said.
  if (lower == "srgb") return RgbSpace{lower, kSpaces[0].description, kRec709, false};
  for (const auto& alias : kAliases) {
    if (alias.name != lower) continue;
    if (alias.space.empty()) {
      return make_error(
          ErrorCode::kBadArgument,
          "colour space \"{}\" is not linear, and encoded images are not read; convert the image to "
          "linear Rec.709 first (lin_rec709)",
          name);
    }
    lower = alias.space;
    break;
  }
  for (const auto& space : kSpaces) {
    if (space.name == lower) {
      return RgbSpace{std::string(space.name), space.description, space.chromaticities,
                      space.relative_to_d65};
    }
  }
  return make_error(ErrorCode::kUnknownName, "colour space \"{}\" is unknown; there are {}", name,
                    fmt::join(rgb_space_names(), ", "));
}

std::vector<std::string> rgb_space_names() {
  std::vector<std::string> names;
  for (const auto& space : kSpaces) names.emplace_back(space.name);
  return names;
}

double determinant(const Matrix3& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

Matrix3 inverse(const Matrix3& m) {
  const double d = 1.0 / determinant(m);
  return {(m[4] * m[8] - m[5] * m[7]) * d, (m[2] * m[7] - m[1] * m[8]) * d, (m[1] * m[5] - m[2] * m[4]) * d,
          (m[5] * m[6] - m[3] * m[8]) * d, (m[0] * m[8] - m[2] * m[6]) * d, (m[2] * m[3] - m[0] * m[5]) * d,
          (m[3] * m[7] - m[4] * m[6]) * d, (m[1] * m[6] - m[0] * m[7]) * d, (m[0] * m[4] - m[1] * m[3]) * d};
}

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) out[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    }
  }
  return out;
}

std::array<double, 3> times(const Matrix3& m, const std::array<double, 3>& v) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i] += m[3 * i + k] * v[k];
  }
  return out;
}

std::array<double, 3> chromaticity_to_xyz(const std::array<double, 2>& xy) {
  return {xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]};
}

Matrix3 rgb_to_xyz(const Chromaticities& space) {
  return rgb_to_xyz(space, chromaticity_to_xyz(space.white));
}

Matrix3 rgb_to_xyz(const Chromaticities& primaries, const std::array<double, 3>& white) {
  // Columns x, y, z of each primary, so that a primary on y = 0 (as in ACES or XYZ itself) is no exception.
  Matrix3 m{};
  const std::array<double, 2> columns[3] = {primaries.red, primaries.green, primaries.blue};
  for (std::size_t k = 0; k < 3; ++k) {
    m[k] = columns[k][0];
    m[3 + k] = columns[k][1];
    m[6 + k] = 1.0 - columns[k][0] - columns[k][1];
  }
  const std::array<double, 3> scale = times(inverse(m), white);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) m[3 * i + k] *= scale[k];
  }
  return m;
}

Matrix3 adaptation_matrix(Adaptation method, const std::array<double, 3>& from_white,
                          const std::array<double, 3>& to_white) {
  if (method == Adaptation::kNone) return {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Matrix3& cone = method == Adaptation::kCat16 ? kCat16 : kBradford;
  const std::array<double, 3> from = times(cone, from_white);
  const std::array<double, 3> to = times(cone, to_white);
  const Matrix3 gain = {to[0] / from[0], 0, 0, 0, to[1] / from[1], 0, 0, 0, to[2] / from[2]};
  return product(inverse(cone), product(gain, cone));
}

}  // namespace spectile
