// Floats and halves at two strides in memory that the caller owns: their rules, and blocks from and to them.
#pragma once

#include <cstddef>
#include <spectile/lanes/element_type.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>
#include <type_traits>

#include "kernels/abi.hpp"

namespace spectile::arrays {

/// n lanes of K elements of the caller's: element (lane, k) starts at
/// data + lane * lane_stride + k * sample_stride, at any alignment.
template <class Byte>
struct StridedArray {
  Byte* data = nullptr;
  ElementType type = ElementType::kFloat;
  std::size_t lanes = 0;
  std::size_t samples = 0;
  std::ptrdiff_t lane_stride = 0;    ///< bytes
  std::ptrdiff_t sample_stride = 0;  ///< bytes

  Byte* at(std::size_t lane, std::size_t k) const noexcept {
    return data + static_cast<std::ptrdiff_t>(lane) * lane_stride +
           static_cast<std::ptrdiff_t>(k) * sample_stride;
  }
  operator StridedArray<const std::byte>() const requires(!std::is_const_v<Byte>) {
    return {data, type, lanes, samples, lane_stride, sample_stride};
  }
};
using StridedView = StridedArray<const std::byte>;
using StridedSpan = StridedArray<std::byte>;

constexpr std::size_t element_bytes(ElementType type) noexcept {
  if (type == ElementType::kUint8) return 1;
  return type == ElementType::kFloat ? 4 : 2;
}

/// Checks that there are data, and that no two elements overlap. `lane` and `sample` are nouns for the
/// sentence: "pixel", "channel". Errors: kBadArgument.
Result<void> check_strides(const StridedView& array, const char* lane, const char* sample);

/// Lanes of the block that starts at lane `first`.
constexpr std::size_t lanes_of_block(std::size_t lanes, std::size_t first) noexcept {
  return lanes - first < kLanesPerBlock ? lanes - first : kLanesPerBlock;
}

/// Floats or halves of the block that starts at lane `first`, lanes beyond the last 0. Shapes: dst
/// [samples][64].
void load_block(const kernels::KernelTable& table, const StridedView& array, std::size_t first, float* dst);

/// A block to floats or halves, lanes beyond the last left out. Shapes: src [samples][64].
void store_block(const kernels::KernelTable& table, const float* src, const StridedSpan& array,
                 std::size_t first);

}  // namespace spectile::arrays
