// The RGB space that a file declares, and its way to linear sRGB.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <spectile/result.hpp>
#include <spectile/upsample.hpp>
#include <string>

#include "src/ops/color_matrix.hpp"

namespace spectile::io {

/// A linear RGB space.
struct ColorSpace {
  std::string name = "linear sRGB (assumed)";
  color::Chromaticities chromaticities = color::kRec709;
  bool relative_to_d65 = false;  ///< the values are meant under D65, whatever RGB 1, 1, 1 is
};

/// The space that colorInteropID names, else the one of the chromaticities attribute, else linear sRGB.
/// Errors: kBadFile for a colorInteropID that is not linear, is not a colour or is unknown, and for
/// chromaticities that span no triangle. Source of the names: Color Interop Forum, Color Space Encodings for
/// Texture Assets and CG Rendering, 2024.
Result<ColorSpace> color_space_of(const Imf::Header& header, const std::string& path);

/// Whether RGB needs no conversion to be linear sRGB.
bool is_srgb(const ColorSpace& space);

/// RGB of the space to linear sRGB. White: a reflectance's is adapted from the space's to D65, so that 1, 1,
/// 1 stays 1, 1, 1; light is not adapted, its XYZ stays.
Matrix3 to_srgb(const ColorSpace& space, Quantity quantity);

}  // namespace spectile::io
