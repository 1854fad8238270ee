// Weighted sums over bands (XYZ, luminance, averages) and 3 x 3 colour transforms.
#pragma once

#include "kernels/abi/color.hpp"
#include "kernels/simd/runs.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

void weighted_sum(float* y, const float* spectra, const float* weights, std::size_t bands,
                  std::size_t blocks) noexcept {
  constexpr std::size_t kVectors = kLanes / kWidth < 8 ? kLanes / kWidth : 8;
  for (std::size_t block = 0; block < blocks; ++block, spectra += bands * kLanes) {
    for (std::size_t lane = 0; lane < kLanes; lane += kVectors * kWidth) {
      F32 sum[kVectors];
      for (auto& s : sum) s = F32(0.0F);
      for_runs(bands, [&](std::size_t first, std::size_t end) {
        F32 run[kVectors];
        for (auto& s : run) s = F32(0.0F);
        for (std::size_t band = first; band < end; ++band) {
          const F32 w(weights[band]);
          const float* in = spectra + band * kLanes + lane;
          for (std::size_t j = 0; j < kVectors; ++j) run[j] = run[j] + w * load(in + j * kWidth);
        }
        for (std::size_t j = 0; j < kVectors; ++j) sum[j] = sum[j] + run[j];
      });
      for (std::size_t j = 0; j < kVectors; ++j) store(y + block * kLanes + lane + j * kWidth, sum[j]);
    }
  }
}

void project(float* const dst[3], const float* spectra, const float* weights, std::size_t bands,
             std::size_t blocks) noexcept {
  float* const out[3] = {dst[0], dst[1], dst[2]};
  for (std::size_t block = 0; block < blocks; ++block, spectra += bands * kLanes) {
    for (std::size_t lane = 0; lane < kLanes; lane += kGroup * kWidth) {
      F32 sum[3][kGroup];
      for (auto& row : sum) {
        for (auto& s : row) s = F32(0.0F);
      }
      for_runs(bands, [&](std::size_t first, std::size_t end) {
        F32 run[3][kGroup];
        for (auto& row : run) {
          for (auto& s : row) s = F32(0.0F);
        }
        for (std::size_t band = first; band < end; ++band) {
          const F32 w[3] = {F32(weights[4 * band]), F32(weights[4 * band + 1]), F32(weights[4 * band + 2])};
          const float* in = spectra + band * kLanes + lane;
          for (std::size_t j = 0; j < kGroup; ++j) {
            // The same line of the next block: with six operations a vector the processor does not see far
            // enough ahead to keep memory busy.
            if (j * kWidth % kLineFloats == 0) prefetch(in + j * kWidth + bands * kLanes);
            const F32 s = load(in + j * kWidth);
            for (std::size_t k = 0; k < 3; ++k) run[k][j] = run[k][j] + w[k] * s;
          }
        }
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t j = 0; j < kGroup; ++j) sum[k][j] = sum[k][j] + run[k][j];
        }
      });
      const std::size_t at = block * kLanes + lane;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < kGroup; ++j) store(out[k] + at + j * kWidth, sum[k][j]);
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
