// DWA compression of one chunk, which the C pipeline of OpenEXR 3.1 lacks.
#pragma once

#include <cstddef>
#include <vector>

#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// One channel of packed lines.
struct PackedChannel {
  const char* name;
  SampleType type;
  std::size_t offset;  ///< bytes from a line's start
};

/// Compresses `lines` packed lines of `width` pixels with OpenEXR's C++ library, by writing them as an image
/// in memory and taking its only chunk out. `kind` is kDwaa or kDwab; a level of -1 is OpenEXR's default
/// (45). `tile`: they are a tile, of any height, instead of a chunk of lines. May throw.
std::vector<char> encode_dwa(const Compression& compression, const std::vector<PackedChannel>& channels,
                             std::size_t line_bytes, int width, int lines, const std::byte* packed,
                             bool tile);

}  // namespace spectile::io
