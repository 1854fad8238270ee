// The RGB space that a file declares, and its way to linear sRGB.
#pragma once

#include <optional>
#include <spectile/color/rgb_space.hpp>
#include <spectile/result.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <vector>

#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// True where the file says what its RGB mean.
bool states_color_space(const PartHeader& header);

/// The space that colorInteropID names, else the one of the chromaticities attribute, else oiio:ColorSpace,
/// else linear Rec.709. Errors: kBadFile for a colorInteropID or oiio:ColorSpace that is not linear, is not a
/// colour or is unknown, and for chromaticities that span no triangle. Source of the names: Color Interop
/// Forum, Color Space Encodings for Texture Assets and CG Rendering, 2024.
Result<RgbSpace> color_space_of(const PartHeader& header, const std::string& path);

/// The space of an image's RGB: the stated one, whatever the file says, else color_space_of(). Adds to
/// `notes` that a space is assumed, or that the stated one's name has two meanings. Errors: those of
/// color_space_of().
Result<RgbSpace> input_space_of(const PartHeader& header, const std::string& path,
                                const std::optional<RgbSpace>& stated, std::vector<std::string>& notes);

/// True for linear sRGB.
bool is_srgb(const RgbSpace& space);

/// RGB of the space to linear sRGB. White: a reflectance's is adapted from the space's to D65, so that 1, 1,
/// 1 stays 1, 1, 1; light is not adapted, its XYZ stays.
Matrix3 to_srgb(const RgbSpace& space, Quantity quantity);

}  // namespace spectile::io
