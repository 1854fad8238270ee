// Pixels in memory of the caller's, from and to lanes, block by block.
#include <algorithm>
#include <cstring>
#include <spectile/lanes/pixels.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/arrays/integer_blocks.hpp"
#include "src/lanes/arrays/strided_array.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using arrays::kMaxChannels;

bool has_alpha(LanesView alpha) {
  return alpha.data != nullptr || alpha.lanes != 0;
}

Result<void> check_channels(std::size_t channels) {
  if (channels == 1 || channels == 3 || channels == 4) return {};
  return make_error(ErrorCode::kBadArgument, "pixels have 1, 3 or 4 channels, not {}", channels);
}

/// The array, checked against the lanes.
template <class Byte, class Void>
Result<arrays::StridedArray<Byte>> matched_pixels(const BasicPixelArray<Void>& array, const ColorView& rgb,
                                                  LanesView alpha) {
  SPECTILE_TRY(check_channels(array.channels));
  if (array.encoding == PixelEncoding::kSrgb && !arrays::is_integer(array.type)) {
    return make_error(ErrorCode::kBadArgument, "only integers are encoded as sRGB, not floats or halves");
  }
  if (array.pixels != rgb.lanes) {
    return make_error(ErrorCode::kSizeMismatch, "the array has {} pixels, the colours {} lanes", array.pixels,
                      rgb.lanes);
  }
  SPECTILE_TRY(shape::aligned(rgb));
  if (has_alpha(alpha)) {
    if (alpha.lanes != array.pixels) {
      return make_error(ErrorCode::kSizeMismatch, "the array has {} pixels, alpha {} lanes", array.pixels,
                        alpha.lanes);
    }
    if (alpha.data == nullptr)
      return make_error(ErrorCode::kBadArgument, "alpha of {} lanes has no data", alpha.lanes);
    SPECTILE_TRY(shape::aligned(alpha.data));
  }
  const arrays::StridedArray<Byte> out{
      static_cast<Byte*>(array.data), array.type, array.pixels, array.channels, array.pixel_stride_bytes,
      array.channel_stride_bytes};
  SPECTILE_TRY(arrays::check_strides(out, "pixel", "channel"));
  return out;
}

/// Lanes of a block, the padding 0.
void put_alpha_of_opaque(float* alpha, std::size_t n) {
  std::fill(alpha, alpha + n, 1.0F);
  std::fill(alpha + n, alpha + kLanesPerBlock, 0.0F);
}

/// A packed array of `values`.
template <class Array, class Values>
Result<Array> packed_pixels(Values values, ElementType type, std::size_t channels,
                            PixelEncoding encoding = PixelEncoding::kLinear) {
  SPECTILE_TRY(check_channels(channels));
  if (values.size() % channels != 0) {
    return make_error(ErrorCode::kSizeMismatch, "{} values are no multiple of {} channels", values.size(),
                      channels);
  }
  const auto bytes = static_cast<std::ptrdiff_t>(arrays::element_bytes(type));
  return Array{values.data(),
               values.size() / channels,
               type,
               channels,
               static_cast<std::ptrdiff_t>(channels) * bytes,
               bytes,
               encoding};
}

}  // namespace

template <class Void>
Result<BasicPixelArray<Void>> BasicPixelArray<Void>::interleaved(std::span<Element<float>> values,
                                                                 std::size_t channels) {
  return packed_pixels<BasicPixelArray>(values, ElementType::kFloat, channels);
}

template <class Void>
Result<BasicPixelArray<Void>> BasicPixelArray<Void>::interleaved(std::span<Element<std::uint8_t>> values,
                                                                 std::size_t channels,
                                                                 PixelEncoding encoding) {
  return packed_pixels<BasicPixelArray>(values, ElementType::kUint8, channels, encoding);
}

template <class Void>
Result<BasicPixelArray<Void>> BasicPixelArray<Void>::interleaved(std::span<Element<std::uint16_t>> values,
                                                                 std::size_t channels,
                                                                 PixelEncoding encoding) {
  return packed_pixels<BasicPixelArray>(values, ElementType::kUint16, channels, encoding);
}

template <class Void>
Result<BasicPixelArray<Void>> BasicPixelArray<Void>::interleaved_halves(
    std::span<Element<std::uint16_t>> patterns, std::size_t channels) {
  return packed_pixels<BasicPixelArray>(patterns, ElementType::kHalf, channels);
}

template struct BasicPixelArray<const void>;
template struct BasicPixelArray<void>;

Result<void> read_pixels(PixelArray array, ColorSpan rgb, LanesSpan alpha, const Execution& execution) {
  SPECTILE_ASSIGN(const auto from, matched_pixels<const std::byte>(array, rgb, alpha));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const arrays::IntegerCodes codes(array.type, array.encoding);
  tiles::for_blocks(blocks_for(rgb.lanes), execution, [&](std::size_t first, std::size_t count) {
    for (std::size_t lane = first * kLanesPerBlock; lane < (first + count) * kLanesPerBlock;
         lane += kLanesPerBlock) {
      alignas(64) float block[kMaxChannels][kLanesPerBlock];
      if (arrays::is_integer(array.type)) {
        codes.load_block(from, lane, block[0]);
      } else {
        arrays::load_block(*table, from, lane, block[0]);
      }
      for (std::size_t k = 0; k < 3; ++k)
        std::memcpy(rgb.c[k] + lane, block[array.channels == 1 ? 0 : k], sizeof(block[0]));
      if (!has_alpha(alpha)) continue;
      if (array.channels == kMaxChannels) {
        std::memcpy(alpha.data + lane, block[3], sizeof(block[0]));
      } else {
        put_alpha_of_opaque(alpha.data + lane, arrays::lanes_of_block(rgb.lanes, lane));
      }
    }
  });
  return {};
}

Result<void> write_pixels(ColorView rgb, LanesView alpha, MutablePixelArray array,
                          const Execution& execution) {
  SPECTILE_ASSIGN(const auto to, matched_pixels<std::byte>(array, rgb, alpha));
  if (has_alpha(alpha) && array.channels != kMaxChannels) {
    return make_error(ErrorCode::kBadArgument, "pixels of {} channels have none for alpha", array.channels);
  }
  if (array.channels == 1 && (rgb.c[0] != rgb.c[1] || rgb.c[0] != rgb.c[2])) {
    return make_error(ErrorCode::kBadArgument,
                      "pixels of 1 channel hold no colour of three planes; give one plane three times");
  }
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const arrays::IntegerCodes codes(array.type, array.encoding);
  tiles::for_blocks(blocks_for(rgb.lanes), execution, [&](std::size_t first, std::size_t count) {
    for (std::size_t lane = first * kLanesPerBlock; lane < (first + count) * kLanesPerBlock;
         lane += kLanesPerBlock) {
      alignas(64) float block[kMaxChannels][kLanesPerBlock];
      for (std::size_t k = 0; k < std::min<std::size_t>(array.channels, 3); ++k)
        std::memcpy(block[k], rgb.c[k] + lane, sizeof(block[0]));
      if (array.channels == kMaxChannels) {
        if (has_alpha(alpha)) {
          std::memcpy(block[3], alpha.data + lane, sizeof(block[0]));
        } else {
          put_alpha_of_opaque(block[3], kLanesPerBlock);
        }
      }
      if (arrays::is_integer(array.type)) {
        codes.store_block(block[0], to, lane);
      } else {
        arrays::store_block(*table, block[0], to, lane);
      }
    }
  });
  return {};
}

}  // namespace spectile
