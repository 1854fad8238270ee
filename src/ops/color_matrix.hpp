// Matrices between RGB spaces and XYZ, from chromaticities, in double.
#pragma once

#include <array>
#include <spectile/colorimetry.hpp>

namespace spectile::color {

/// Chromaticities (x, y) of an RGB space's primaries and white.
struct Chromaticities {
  std::array<double, 2> red, green, blue, white;
  friend bool operator==(const Chromaticities&, const Chromaticities&) = default;
};

/// ITU-R BT.709 and IEC 61966-2-1.
inline constexpr Chromaticities kRec709 = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

/// Determinant; 0 for primaries on a line.
double determinant(const Matrix3& m);
/// The inverse of a matrix whose determinant is not 0.
Matrix3 inverse(const Matrix3& m);
/// a after b.
Matrix3 product(const Matrix3& a, const Matrix3& b);
std::array<double, 3> times(const Matrix3& m, const std::array<double, 3>& v);
std::array<float, 9> to_float(const Matrix3& m);

/// XYZ of a chromaticity with Y = 1.
std::array<double, 3> xyz_of(const std::array<double, 2>& xy);

/// RGB to XYZ such that RGB 1, 1, 1 is the white with Y = 1. The primaries must not be on a line.
/// Source: SMPTE RP 177-1993.
Matrix3 rgb_to_xyz(const Chromaticities& space);

/// Chromatic adaptation of XYZ from one white to another by the Bradford transform.
/// Source: Lam 1985, with the matrix as in CIE 159:2004 and ICC.1:2010 annex E.
Matrix3 bradford(const std::array<double, 2>& from_white, const std::array<double, 2>& to_white);

}  // namespace spectile::color
