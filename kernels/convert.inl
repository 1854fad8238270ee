// Conversion between half and float, and the scan that finds what an RGB row holds.
#pragma once

#include "kernels/abi/color.hpp"
#include "kernels/simd/convert.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

void half_to_float(float* dst, const std::uint16_t* src, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; i += kWidth) store_any(dst + i, load_half(src + i));
}

void float_to_half(std::uint16_t* dst, const float* src, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; i += kWidth) store_half(dst + i, load_any(src + i));
}

void scan_rgb(RgbScan* scan, const float* const rgb[3], std::size_t n) noexcept {
  const F32 zero(0.0F);
  const F32 one(1.0F);
  F32 most(scan->maximum);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 r = load(rgb[0] + i);
    const F32 g = load(rgb[1] + i);
    const F32 b = load(rgb[2] + i);
    // x - x is 0 for finite x and NaN otherwise.
    const Mask finite = ((r - r) == zero) & ((g - g) == zero) & ((b - b) == zero);
    const Mask negative = (r < zero) | (g < zero) | (b < zero);
    const Mask over_one = (r > one) | (g > one) | (b > one);
    most = xsimd::select(most < r, r, most);
    most = xsimd::select(most < g, g, most);
    most = xsimd::select(most < b, b, most);
    scan->nonfinite += kWidth - static_cast<std::uint64_t>(__builtin_popcountll(lane_bits(finite)));
    scan->negative += static_cast<std::uint64_t>(__builtin_popcountll(lane_bits(negative)));
    scan->over_one += static_cast<std::uint64_t>(__builtin_popcountll(lane_bits(over_one)));
  }
  alignas(64) float lanes[kWidth];
  store(lanes, most);
  for (const float v : lanes) scan->maximum = scan->maximum < v ? v : scan->maximum;
}

}  // namespace
}  // namespace spectile::kernels
