// The transfer function of sRGB: the only definition, and tables of it for codes of 8 and 16 bit.
// Source: IEC 61966-2-1:1999, 5.2 and 5.3.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace spectile::arrays {

/// Linear value of an encoded one, from 0 to 1.
double decode_srgb(double encoded) noexcept;

/// Encoded value of a linear one, from 0 to 1.
double encode_srgb(double linear) noexcept;

/// Linear values of all codes, each the nearest float.
template <class Code>
class SrgbDecoder {
 public:
  static const SrgbDecoder& instance();
  float operator()(Code code) const noexcept { return linear_[code]; }

 private:
  SrgbDecoder();
  std::array<float, std::size_t{std::numeric_limits<Code>::max()} + 1> linear_;
};

/// Nearest codes of linear values. There are no ties: no float encodes to the middle of two codes.
template <class Code>
class SrgbEncoder {
 public:
  static const SrgbEncoder& instance();

  /// `linear` from 0 to 1.
  Code operator()(float linear) const noexcept {
    const float v = linear > kFirst ? linear : kFirst;
    const Line line = lines_[(std::bit_cast<std::uint32_t>(v) >> kShift) - kFirstBits];
    const auto code = static_cast<std::uint32_t>(static_cast<std::int32_t>(line.offset + line.slope * v));
    return static_cast<Code>(code + (v >= next_[code] ? 1U : 0U));
  }

 private:
  /// The encoding over 1/128 of an octave, less than 0.13 code below the curve, plus 0.25: its integer part
  /// is the code or the one before.
  struct Line {
    float offset = 0;
    float slope = 0;
  };
  static constexpr std::size_t kCodes = std::size_t{std::numeric_limits<Code>::max()} + 1;
  static constexpr int kShift = 16;
  /// Power of two whose code is 0.
  static constexpr float kFirst = sizeof(Code) == 1 ? 0x1p-13F : 0x1p-21F;
  static constexpr std::uint32_t kFirstBits = std::bit_cast<std::uint32_t>(kFirst) >> kShift;
  static constexpr std::uint32_t kLastBits = std::bit_cast<std::uint32_t>(1.0F) >> kShift;

  SrgbEncoder();
  std::array<Line, kLastBits - kFirstBits + 1> lines_;
  std::array<float, kCodes> next_;  ///< smallest float of a later code
};

extern template class SrgbDecoder<std::uint8_t>;
extern template class SrgbDecoder<std::uint16_t>;
extern template class SrgbEncoder<std::uint8_t>;
extern template class SrgbEncoder<std::uint16_t>;

}  // namespace spectile::arrays
