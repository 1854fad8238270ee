// DWA compression of one chunk, which the C pipeline of OpenEXR 3.1 lacks.
#pragma once

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/openexr.h>

#include <cstddef>
#include <vector>

namespace spectile::io {

/// One channel of packed lines.
struct PackedChannel {
  const char* name;
  exr_pixel_type_t type;
  std::size_t offset;  ///< bytes from a line's start
};

/// Compresses `lines` packed lines of `width` pixels with OpenEXR's C++ library, by writing them as an image
/// in memory and taking its only chunk out. `level` is DWA's own, -1 for OpenEXR's default (45).
/// `tile`: whether they are a tile, of any height, instead of a chunk of lines. May throw.
std::vector<char> encode_dwa(Imf::Compression method, int level, const std::vector<PackedChannel>& channels,
                             std::size_t line_bytes, int width, int lines, const std::byte* packed,
                             bool tile);

}  // namespace spectile::io
