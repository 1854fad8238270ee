// Tables of the transfer function of sRGB, computed in double when first asked for.
#include "src/lanes/arrays/srgb_encoding.hpp"

#include <cmath>

namespace spectile::arrays {
namespace {

/// Smallest float that is not below `value`.
float float_from_above(double value) {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) < value ? std::nextafter(nearest, 2.0F) : nearest;
}

}  // namespace

double decode_srgb(double encoded) noexcept {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double encode_srgb(double linear) noexcept {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

template <class Code>
SrgbDecoder<Code>::SrgbDecoder() {
  const auto last = static_cast<double>(linear_.size() - 1);
  for (std::size_t code = 0; code < linear_.size(); ++code)
    linear_[code] = static_cast<float>(decode_srgb(static_cast<double>(code) / last));
}

template <class Code>
const SrgbDecoder<Code>& SrgbDecoder<Code>::instance() {
  static const SrgbDecoder decoder;
  return decoder;
}

template <class Code>
SrgbEncoder<Code>::SrgbEncoder() {
  const auto last = static_cast<double>(kCodes - 1);
  for (std::size_t code = 0; code + 1 < kCodes; ++code)
    next_[code] = float_from_above(decode_srgb((static_cast<double>(code) + 0.5) / last));
  next_[kCodes - 1] = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const auto bits = static_cast<std::uint32_t>(kFirstBits + i);
    const double from = std::bit_cast<float>(bits << kShift);
    const double to = std::bit_cast<float>((bits + 1) << kShift);
    const double slope = last * (encode_srgb(to) - encode_srgb(from)) / (to - from);
    lines_[i].slope = static_cast<float>(slope);
    lines_[i].offset = static_cast<float>(last * encode_srgb(from) - slope * from + 0.25);
  }
}

template <class Code>
const SrgbEncoder<Code>& SrgbEncoder<Code>::instance() {
  static const SrgbEncoder encoder;
  return encoder;
}

template class SrgbDecoder<std::uint8_t>;
template class SrgbDecoder<std::uint16_t>;
template class SrgbEncoder<std::uint8_t>;
template class SrgbEncoder<std::uint16_t>;

}  // namespace spectile::arrays
