// A line of colour as an output's channels: names, range of halves, packing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <spectile/image/image.hpp>
#include <vector>

#include "kernels/abi.hpp"
#include "src/io/convert/stages/lines.hpp"
#include "src/io/exr/exr_writer.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// Channels of a colour.
std::vector<const char*> color_channels(ColorTarget target);

/// Adds the attribute that names the colour's space; none for luminance.
void add_color_tag(TextAttributes& texts, ColorTarget target);

/// Clamps what a half cannot hold in the first `count` rows, and counts its pixels.
std::uint64_t clamp_to_half(const kernels::KernelTable& kernels, const ColorLine& line, std::size_t count,
                            std::size_t width);

/// Packs a row, readable up to whole blocks of lanes, at `out` as floats or halves. `halves`: work space of
/// half the padded width.
void store_row(const kernels::KernelTable& kernels, const float* row, std::size_t width, SampleType type,
               float* halves, std::byte* out);

/// Takes a line of a strip of floats, from plane `first` on, into the first `count` rows.
void load_colors(const Strip& strip, int line, std::size_t first, std::size_t count, ColorLine& to);

/// XYZ of a projector to the colour wanted: sRGB, or XYZ, with the light's white adapted to D65's where
/// asked.
Matrix3 color_matrix(const Projector& projector, ColorTarget target, Adaptation adaptation);

/// Says how much of the tint that bands give to white a colour is free of, where that is not all of it.
/// `compensation`: Projector::white_compensation().
void note_white(double compensation, std::vector<std::string>& notes);

}  // namespace spectile::io
