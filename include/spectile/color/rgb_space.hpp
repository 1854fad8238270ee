// RGB colour spaces by their chromaticities, their matrices, and chromatic adaptation.
#pragma once

#include <array>
#include <spectile/result.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// A 3 x 3 matrix, row by row.
using Matrix3 = std::array<double, 9>;

/// Chromaticities (x, y) of an RGB space's primaries and white.
struct Chromaticities {
  std::array<double, 2> red, green, blue, white;
  friend bool operator==(const Chromaticities&, const Chromaticities&) = default;
};

/// ITU-R BT.709 and IEC 61966-2-1 (sRGB).
inline constexpr Chromaticities kRec709 = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

/// A linear RGB space.
struct RgbSpace {
  std::string name = "lin_rec709";
  std::string description = "linear Rec.709 (assumed)";
  Chromaticities chromaticities = kRec709;
  bool relative_to_d65 = false;  ///< the values are meant under D65, whatever RGB 1, 1, 1 is
};

/// A linear RGB space by name, whatever its case: lin_rec709 (also lin_srgb, rec709), display-p3 (lin_p3d65),
/// rec2020 (lin_rec2020), adobe-rgb (lin_adobergb), acescg (lin_ap1), aces2065-1 (lin_ap0), and xyz
/// (lin_ciexyzd65): CIE XYZ under D65. "srgb", which may mean the encoded space too, is linear Rec.709 under
/// that name. Errors: kUnknownName, listing the names; kBadArgument for encoded spaces such as srgb_texture.
/// Source: IEC 61966-2-1, ITU-R BT.709-6 and BT.2020-2, SMPTE EG 432-1, Adobe RGB (1998), SMPTE ST 2065-1,
/// ACES S-2014-004; Color Interop Forum, Color Space Encodings for Texture Assets and CG Rendering, 2024.
Result<RgbSpace> rgb_space(std::string_view name);

/// The first name of each space that rgb_space() knows.
std::vector<std::string> rgb_space_names();

/// XYZ of a chromaticity with Y = 1.
std::array<double, 3> chromaticity_to_xyz(const std::array<double, 2>& xy);

/// RGB to XYZ such that RGB 1, 1, 1 is the space's white with Y = 1; no chromatic adaptation. The primaries
/// must not be on a line. Source: SMPTE RP 177-1993.
Matrix3 rgb_to_xyz(const Chromaticities& space);
/// The same with another white, in XYZ: RGB 1, 1, 1 is that.
Matrix3 rgb_to_xyz(const Chromaticities& primaries, const std::array<double, 3>& white);

/// Ways of chromatic adaptation.
enum class Adaptation {
  kNone,      ///< XYZ stay as they are
  kBradford,  ///< Lam 1985, with the matrix as in CIE 159:2004 and ICC.1:2010 annex E
  kCat16,     ///< Li et al., Comprehensive color solutions: CAM16, Color Research and Application 42, 2017
};

/// XYZ under one white to the corresponding XYZ under another, by a complete von Kries adaptation in the
/// cone space of the method. Whites must have positive cone responses.
Matrix3 adaptation_matrix(Adaptation method, const std::array<double, 3>& from_white,
                          const std::array<double, 3>& to_white);

/// Determinant; 0 for primaries on a line.
double determinant(const Matrix3& m);
/// The inverse of a matrix whose determinant is not 0.
Matrix3 inverse(const Matrix3& m);
/// a after b.
Matrix3 product(const Matrix3& a, const Matrix3& b);
std::array<double, 3> times(const Matrix3& m, const std::array<double, 3>& v);

}  // namespace spectile
