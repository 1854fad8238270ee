// Rules of the spectral layout that a part's header can break.
// Source: Fichet, Pacanowski, Wilkie, An OpenEXR Layout for Spectral Images, JCGT 10(3), 2021, and its
// authors' reader and writer.
#pragma once

#include <spectile/image/convert.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// Those that the header of a part breaks, and remarks on it; none for a part without spectral channels.
std::vector<LayoutFinding> layout_findings(const PartHeader& header);

/// True if a part has channels that are spectral, or that begin like those of the layout.
bool has_spectral_names(const PartHeader& header);

/// True for the text of a curve, "400nm:0.5;410nm:0.75;": wavelengths or frequencies with any SI prefix,
/// decimal points, a semicolon after each value.
bool is_curve_text(std::string_view text);

}  // namespace spectile::io
