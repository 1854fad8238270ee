// What OpenEXR's compression methods mean to a writer of chunks.
#include "src/io/exr/exr_compression.hpp"

namespace spectile::io {

int lines_per_chunk_of(CompressionKind kind) {
  switch (kind) {
    case CompressionKind::kZip:
    case CompressionKind::kPxr24:
      return 16;
    case CompressionKind::kPiz:
    case CompressionKind::kB44:
    case CompressionKind::kB44a:
    case CompressionKind::kDwaa:
      return 32;
    case CompressionKind::kDwab:
      return 256;
    default:
      return 1;
  }
}

exr_compression_t compression_type(CompressionKind kind) {
  switch (kind) {
    case CompressionKind::kRle:
      return EXR_COMPRESSION_RLE;
    case CompressionKind::kZips:
      return EXR_COMPRESSION_ZIPS;
    case CompressionKind::kZip:
      return EXR_COMPRESSION_ZIP;
    case CompressionKind::kPiz:
      return EXR_COMPRESSION_PIZ;
    case CompressionKind::kPxr24:
      return EXR_COMPRESSION_PXR24;
    case CompressionKind::kB44:
      return EXR_COMPRESSION_B44;
    case CompressionKind::kB44a:
      return EXR_COMPRESSION_B44A;
    case CompressionKind::kDwaa:
      return EXR_COMPRESSION_DWAA;
    case CompressionKind::kDwab:
      return EXR_COMPRESSION_DWAB;
    case CompressionKind::kNone:
      break;
  }
  return EXR_COMPRESSION_NONE;
}

}  // namespace spectile::io
