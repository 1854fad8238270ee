// Conversion between half and float, and the scan that finds what an RGB row holds.
#pragma once

#include "kernels/abi/color.hpp"
#include "kernels/simd/convert.hpp"
#include "kernels/simd/quad_lanes.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

void half_to_float(float* dst, const std::uint16_t* src, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; i += kWidth) store_any(dst + i, load_half(src + i));
}

void float_to_half(std::uint16_t* dst, const float* src, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; i += kWidth) store_half(dst + i, load_any(src + i));
}

/// A vector's lanes from rows: four numbers of each from `k` on, one vector a number.
inline void load_columns(F32 v[4], const float* rows, const std::int32_t* at, std::size_t k) noexcept {
  for (std::size_t j = 0; j < 4; ++j) v[j] = strided_quads(rows + k, at + j);
  transpose_quads(v);
}

void rows_to_blocks(float* dst, const float* rows, std::size_t stride, std::size_t count,
                    std::size_t n) noexcept {
  std::int32_t at[kWidth];
  for (std::size_t i = 0; i < kWidth; ++i) at[i] = static_cast<std::int32_t>(i * stride);
  const std::size_t blocks = (n + kLanes - 1) / kLanes;
  for (std::size_t lane = 0; lane < blocks * kLanes; lane += kWidth) {
    const float* const from = rows + lane * stride;
    float* const to = dst + lane / kLanes * kLanes * count + lane % kLanes;
    std::size_t k = 0;
    if (lane + kWidth <= n) {
      for (; k + 4 <= count; k += 4) {
        F32 v[4];
        load_columns(v, from, at, k);
        for (std::size_t j = 0; j < 4; ++j) store(to + (k + j) * kLanes, v[j]);
      }
    }
    for (; k < count; ++k) {
      for (std::size_t i = 0; i < kWidth; ++i)
        to[k * kLanes + i] = lane + i < n ? from[i * stride + k] : 0.0F;
    }
  }
}

void blocks_to_rows(float* rows, std::size_t stride, const float* src, std::size_t count,
                    std::size_t n) noexcept {
  for (std::size_t lane = 0; lane < n; lane += kWidth) {
    float* const to = rows + lane * stride;
    const float* const from = src + lane / kLanes * kLanes * count + lane % kLanes;
    std::size_t k = 0;
    if (lane + kWidth <= n) {
      for (; k + 4 <= count; k += 4) {
        F32 v[4];
        for (std::size_t j = 0; j < 4; ++j) v[j] = load(from + (k + j) * kLanes);
        transpose_quads(v);
        // Quad q of vector j is lane 4 q + j.
        alignas(64) float quads[4][kWidth];
        for (std::size_t j = 0; j < 4; ++j) store(quads[j], v[j]);
        for (std::size_t i = 0; i < kWidth; ++i)
          std::memcpy(to + i * stride + k, quads[i % 4] + i / 4 * 4, 4 * sizeof(float));
      }
    }
    for (; k < count; ++k) {
      for (std::size_t i = 0; i < kWidth && lane + i < n; ++i) to[i * stride + k] = from[k * kLanes + i];
    }
  }
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
