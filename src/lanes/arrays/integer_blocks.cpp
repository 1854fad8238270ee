// Codes of 8 and 16 bit to floats and back, a channel of a block at a time.
#include "src/lanes/arrays/integer_blocks.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "src/lanes/arrays/srgb_encoding.hpp"

namespace spectile::arrays {
namespace {

template <class Code>
constexpr float kLastCode = std::numeric_limits<Code>::max();

template <class Code>
void gather_codes(Code* codes, const std::byte* from, std::ptrdiff_t stride, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    std::memcpy(codes + i, from + static_cast<std::ptrdiff_t>(i) * stride, sizeof(Code));
}

void put_code(std::byte* to, std::ptrdiff_t stride, std::size_t i, auto code) {
  std::memcpy(to + static_cast<std::ptrdiff_t>(i) * stride, &code, sizeof(code));
}

/// From 0 to 1; NaN to 0. Shapes: [64].
void clamp_block(float* dst, const float* src) {
  for (std::size_t i = 0; i < kLanesPerBlock; ++i) {
    const float v = src[i] > 0.0F ? src[i] : 0.0F;
    dst[i] = v < 1.0F ? v : 1.0F;
  }
}

// Loops over whole blocks are vectorized, those at a stride are not.

/// The division rounds once: nearest to v / 255 or v / 65535.
template <class Code>
void load_linear(const std::byte* from, std::ptrdiff_t stride, std::size_t n, float* dst) {
  alignas(64) Code codes[kLanesPerBlock];
  gather_codes(codes, from, stride, n);
  std::fill(codes + n, codes + kLanesPerBlock, Code{0});
  for (std::size_t i = 0; i < kLanesPerBlock; ++i) dst[i] = static_cast<float>(codes[i]) / kLastCode<Code>;
}

template <class Code>
void load_srgb(const std::byte* from, std::ptrdiff_t stride, std::size_t n, float* dst) {
  const SrgbDecoder<Code>& decoded = SrgbDecoder<Code>::instance();
  for (std::size_t i = 0; i < n; ++i) {
    Code code = 0;
    std::memcpy(&code, from + static_cast<std::ptrdiff_t>(i) * stride, sizeof(Code));
    dst[i] = decoded(code);
  }
  std::fill(dst + n, dst + kLanesPerBlock, 0.0F);
}

/// Nearest code, ties to even: the product is exact in double, and the sum rounds to integers.
template <class Code>
void store_linear(const float* src, std::byte* to, std::ptrdiff_t stride, std::size_t n) {
  alignas(64) float clamped[kLanesPerBlock];
  alignas(64) double rounded[kLanesPerBlock];
  clamp_block(clamped, src);
  for (std::size_t i = 0; i < kLanesPerBlock; ++i)
    rounded[i] = static_cast<double>(clamped[i]) * kLastCode<Code> + 0x1p52;
  for (std::size_t i = 0; i < n; ++i)
    put_code(to, stride, i, static_cast<Code>(std::bit_cast<std::uint64_t>(rounded[i])));
}

template <class Code>
void store_srgb(const float* src, std::byte* to, std::ptrdiff_t stride, std::size_t n) {
  const SrgbEncoder<Code>& encoded = SrgbEncoder<Code>::instance();
  alignas(64) float clamped[kLanesPerBlock];
  clamp_block(clamped, src);
  for (std::size_t i = 0; i < n; ++i) put_code(to, stride, i, encoded(clamped[i]));
}

}  // namespace

IntegerCodes::IntegerCodes(ElementType type, PixelEncoding encoding) {
  const bool wide = type == ElementType::kUint16;
  load_alpha_ = wide ? load_linear<std::uint16_t> : load_linear<std::uint8_t>;
  store_alpha_ = wide ? store_linear<std::uint16_t> : store_linear<std::uint8_t>;
  load_color_ = load_alpha_;
  store_color_ = store_alpha_;
  if (encoding == PixelEncoding::kSrgb) {
    load_color_ = wide ? load_srgb<std::uint16_t> : load_srgb<std::uint8_t>;
    store_color_ = wide ? store_srgb<std::uint16_t> : store_srgb<std::uint8_t>;
  }
}

void IntegerCodes::load_block(const StridedView& array, std::size_t first, float* dst) const {
  const std::size_t n = lanes_of_block(array.lanes, first);
  for (std::size_t k = 0; k < array.samples; ++k, dst += kLanesPerBlock) {
    (k == 3 ? load_alpha_ : load_color_)(array.at(first, k), array.lane_stride, n, dst);
  }
}

void IntegerCodes::store_block(const float* src, const StridedSpan& array, std::size_t first) const {
  const std::size_t n = lanes_of_block(array.lanes, first);
  for (std::size_t k = 0; k < array.samples; ++k, src += kLanesPerBlock)
    (k == 3 ? store_alpha_ : store_color_)(src, array.at(first, k), array.lane_stride, n);
}

}  // namespace spectile::arrays
