// Blocks of lanes from and to integers of 8 and 16 bit, in proportion or encoded as sRGB.
#pragma once

#include <spectile/lanes/pixels.hpp>

#include "src/lanes/arrays/strided_array.hpp"

namespace spectile::arrays {

/// R, G, B and alpha.
inline constexpr std::size_t kMaxChannels = 4;

constexpr bool is_integer(ElementType type) noexcept {
  return type == ElementType::kUint8 || type == ElementType::kUint16;
}

/// Conversion of a type's codes; the tables are computed at the first use of each in the process.
class IntegerCodes {
 public:
  /// Of no use for types that are not integers.
  IntegerCodes(ElementType type, PixelEncoding encoding);

  /// Values of the block that starts at lane `first`, lanes beyond the last 0. Shapes: dst [channels][64].
  void load_block(const StridedView& array, std::size_t first, float* dst) const;
  /// A block to codes, lanes beyond the last left out. Shapes: src [channels][64].
  void store_block(const float* src, const StridedSpan& array, std::size_t first) const;

 private:
  using Load = void (*)(const std::byte* from, std::ptrdiff_t stride, std::size_t n, float* dst);
  using Store = void (*)(const float* src, std::byte* to, std::ptrdiff_t stride, std::size_t n);
  Load load_color_ = nullptr;
  Load load_alpha_ = nullptr;
  Store store_color_ = nullptr;
  Store store_alpha_ = nullptr;
};

}  // namespace spectile::arrays
