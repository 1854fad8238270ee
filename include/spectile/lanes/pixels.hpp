// Pixels in memory that the caller owns, to batches of colours and back: any type, stride and alignment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <spectile/lanes/element_type.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>
#include <type_traits>

namespace spectile {

/// Encoding of the colour components in integers. Alpha is always in proportion.
enum class PixelEncoding {
  kLinear,  ///< in proportion
  kSrgb,    ///< by the transfer function of sRGB; only of kUint8 and kUint16
};

/// View of n pixels in memory that the caller owns. Shapes: channel c of pixel i starts at
/// data + i * pixel_stride_bytes + c * channel_stride_bytes, at any alignment; interleaved (the channels of
/// a pixel lie within one pixel stride) or planar (the pixels of a channel lie within one channel stride).
/// Strides may be negative: lines from the bottom up; B, G, R from the address of R on.
template <class Void>
struct BasicPixelArray {
  template <class T>
  using Element = std::conditional_t<std::is_const_v<Void>, const T, T>;

  Void* data = nullptr;
  std::size_t pixels = 0;
  ElementType type = ElementType::kFloat;
  std::size_t channels = 3;  ///< 1: grey; 3: R, G, B; 4: R, G, B, alpha
  std::ptrdiff_t pixel_stride_bytes = 12;
  std::ptrdiff_t channel_stride_bytes = 4;
  PixelEncoding encoding = PixelEncoding::kLinear;

  /// Packed pixels, interleaved: RGBRGB..., of floats, 8 bit integers or 16 bit integers. Shapes: values
  /// [n][channels]. Errors: kBadArgument for other than 1, 3 or 4 channels; kSizeMismatch for values that are
  /// not a multiple of them.
  static Result<BasicPixelArray> interleaved(std::span<Element<float>> values, std::size_t channels);
  static Result<BasicPixelArray> interleaved(std::span<Element<std::uint8_t>> values, std::size_t channels,
                                             PixelEncoding encoding);
  static Result<BasicPixelArray> interleaved(std::span<Element<std::uint16_t>> values, std::size_t channels,
                                             PixelEncoding encoding);
  /// The same of the patterns of halves.
  static Result<BasicPixelArray> interleaved_halves(std::span<Element<std::uint16_t>> patterns,
                                                    std::size_t channels);

  operator BasicPixelArray<const void>() const requires(!std::is_const_v<Void>) {
    return {data, pixels, type, channels, pixel_stride_bytes, channel_stride_bytes, encoding};
  }
};
using PixelArray = BasicPixelArray<const void>;   ///< to read
using MutablePixelArray = BasicPixelArray<void>;  ///< to write

extern template struct BasicPixelArray<const void>;
extern template struct BasicPixelArray<void>;

/// Reads pixels into lanes; grey into all three components. Alpha is read where `alpha` is given: 1 where the
/// pixels have none; it is neither multiplied in nor divided out. The padding of the last block becomes 0.
/// Shapes: rgb and alpha [array.pixels]; all three planes of rgb may be one if the pixels are grey. The array
/// may not overlap rgb or alpha.
/// Units: floats as they are, bit by bit; halves exactly, NaN made quiet; integers v to v / 255 or v / 65535,
/// or those decoded from sRGB, nearest float to the exact value.
/// Errors: kSizeMismatch for other numbers of lanes; kBadArgument for other than 1, 3 or 4 channels, sRGB in
/// floats or halves, no data, strides below an element or at which elements overlap, and planes of rgb or
/// alpha that do not start at a multiple of 64 bytes.
/// Source: IEC 61966-2-1:1999, the transfer function of sRGB.
Result<void> read_pixels(PixelArray array, ColorSpan rgb, LanesSpan alpha = {},
                         const Execution& execution = {});

/// Writes lanes into pixels. Nothing else of the array's memory is read or written. Pixels of four channels
/// get alpha 1 where `alpha` is not given. Grey pixels take a colour whose three planes are one. Shapes and
/// overlap as in read_pixels().
/// Units: floats as they are, bit by bit. Halves: nearest, ties to even; 65520 and more to infinity, as
/// hardware converts (only files are limited to 65504); NaN made quiet. Integers: limited to 0 to 1, NaN and
/// infinities included (NaN to 0), then the nearest of v / 255 or v / 65535, ties to even; with sRGB the code
/// that is nearest after encoding. A denormal is a number like any other. Every code of an integer returns.
/// Errors: as read_pixels(); kBadArgument also for an alpha without a channel, and for grey pixels of a
/// colour in three planes.
Result<void> write_pixels(ColorView rgb, LanesView alpha, MutablePixelArray array,
                          const Execution& execution = {});

}  // namespace spectile
