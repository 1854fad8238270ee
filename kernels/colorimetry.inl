// Weighted sums over bands (XYZ, luminance, averages) and 3 x 3 colour transforms.
#pragma once

#include "kernels/simd.hpp"

namespace spectile::kernels {
namespace {

void weighted_sum(float* y, const float* spectra, const float* weights, std::size_t bands,
                  std::size_t blocks) noexcept {
  constexpr std::size_t kVectors = kLanes / kWidth < 8 ? kLanes / kWidth : 8;
  for (std::size_t block = 0; block < blocks; ++block, spectra += bands * kLanes) {
    for (std::size_t lane = 0; lane < kLanes; lane += kVectors * kWidth) {
      F32 sum[kVectors];
      for (auto& s : sum) s = F32(0.0F);
      for (std::size_t band = 0; band < bands; ++band) {
        const F32 w(weights[band]);
        const float* in = spectra + band * kLanes + lane;
        for (std::size_t j = 0; j < kVectors; ++j) sum[j] = sum[j] + w * load(in + j * kWidth);
      }
      for (std::size_t j = 0; j < kVectors; ++j) store(y + block * kLanes + lane + j * kWidth, sum[j]);
    }
  }
}

void project(float* x, float* y, float* z, const float* spectra, const float* weights, std::size_t bands,
             std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block, spectra += bands * kLanes) {
    for (std::size_t lane = 0; lane < kLanes; lane += kGroup * kWidth) {
      F32 sum_x[kGroup];
      F32 sum_y[kGroup];
      F32 sum_z[kGroup];
      for (std::size_t j = 0; j < kGroup; ++j) sum_x[j] = sum_y[j] = sum_z[j] = F32(0.0F);
      for (std::size_t band = 0; band < bands; ++band) {
        const F32 wx(weights[4 * band]);
        const F32 wy(weights[4 * band + 1]);
        const F32 wz(weights[4 * band + 2]);
        const float* in = spectra + band * kLanes + lane;
        for (std::size_t j = 0; j < kGroup; ++j) {
          const F32 s = load(in + j * kWidth);
          sum_x[j] = sum_x[j] + wx * s;
          sum_y[j] = sum_y[j] + wy * s;
          sum_z[j] = sum_z[j] + wz * s;
        }
      }
      const std::size_t at = block * kLanes + lane;
      for (std::size_t j = 0; j < kGroup; ++j) {
        store(x + at + j * kWidth, sum_x[j]);
        store(y + at + j * kWidth, sum_y[j]);
        store(z + at + j * kWidth, sum_z[j]);
      }
    }
  }
}

void transform3(float* const dst[3], const float* const src[3], const float m[9], std::size_t n) noexcept {
  F32 c[9];
  for (std::size_t k = 0; k < 9; ++k) c[k] = F32(m[k]);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 a0 = load(src[0] + i);
    const F32 a1 = load(src[1] + i);
    const F32 a2 = load(src[2] + i);
    for (std::size_t row = 0; row < 3; ++row) {
      store(dst[row] + i, (c[3 * row] * a0 + c[3 * row + 1] * a1) + c[3 * row + 2] * a2);
    }
  }
}

}  // namespace
}  // namespace spectile::kernels
