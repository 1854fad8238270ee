// What OpenEXR's compression methods mean to a writer of chunks.
#pragma once

#include <OpenEXR/openexr.h>

#include <spectile/image/image.hpp>

namespace spectile::io {

/// Lines of a scanline chunk.
int lines_per_chunk_of(CompressionKind kind);

exr_compression_t compression_type(CompressionKind kind);

inline bool is_zip(CompressionKind kind) {
  return kind == CompressionKind::kZip || kind == CompressionKind::kZips;
}

inline bool is_dwa(CompressionKind kind) {
  return kind == CompressionKind::kDwaa || kind == CompressionKind::kDwab;
}

}  // namespace spectile::io
