// Traits of OpenEXR's compression methods.
#pragma once

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/openexr.h>

#include <optional>
#include <spectile/image/image.hpp>

namespace spectile::io {

/// Lines of a scanline chunk.
int lines_per_chunk(CompressionKind kind);

// Both of OpenEXR's enumerations number the methods as CompressionKind does.
constexpr exr_compression_t compression_type(CompressionKind kind) {
  return static_cast<exr_compression_t>(kind);
}
static_assert(compression_type(CompressionKind::kNone) == EXR_COMPRESSION_NONE &&
              compression_type(CompressionKind::kPxr24) == EXR_COMPRESSION_PXR24 &&
              compression_type(CompressionKind::kDwab) == EXR_COMPRESSION_DWAB);

/// Nothing for a method that is not known.
constexpr std::optional<CompressionKind> compression_kind(Imf::Compression method) {
  if (method < Imf::NO_COMPRESSION || method > Imf::DWAB_COMPRESSION) return {};
  return static_cast<CompressionKind>(method);
}
static_assert(compression_kind(Imf::NO_COMPRESSION) == CompressionKind::kNone &&
              compression_kind(Imf::PXR24_COMPRESSION) == CompressionKind::kPxr24 &&
              compression_kind(Imf::DWAB_COMPRESSION) == CompressionKind::kDwab);

/// The C library's type; the C++ library's has the same values.
constexpr exr_pixel_type_t pixel_type(SampleType type) {
  if (type == SampleType::kHalf) return EXR_PIXEL_HALF;
  return type == SampleType::kFloat ? EXR_PIXEL_FLOAT : EXR_PIXEL_UINT;
}

constexpr bool is_zip(CompressionKind kind) {
  return kind == CompressionKind::kZip || kind == CompressionKind::kZips;
}

constexpr bool is_dwa(CompressionKind kind) {
  return kind == CompressionKind::kDwaa || kind == CompressionKind::kDwab;
}

}  // namespace spectile::io
