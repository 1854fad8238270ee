// Scalar twins of the colour kernels: projection, transforms, gamut, scan, conversion.
#include <cmath>

#include "src/reference/half.hpp"
#include "src/reference/sums.hpp"
#include "src/reference/twins.hpp"

namespace spectile::reference {

using kernels::kLanes;
using kernels::RgbScan;

void weighted_sum(float* y, const float* spectra, const float* weights, std::size_t bands,
                  std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      y[block * kLanes + lane] = sum_in_runs(bands, [&](std::size_t band) {
        return weights[band] * spectra[(block * bands + band) * kLanes + lane];
      });
    }
  }
}

void project(float* const dst[3], const float* spectra, const float* weights, std::size_t bands,
             std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      for (std::size_t k = 0; k < 3; ++k) {
        dst[k][block * kLanes + lane] = sum_in_runs(bands, [&](std::size_t band) {
          return weights[4 * band + k] * spectra[(block * bands + band) * kLanes + lane];
        });
      }
    }
  }
}

void transform3(float* const dst[3], const float* const src[3], const float m[9], std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const float a[3] = {src[0][i], src[1][i], src[2][i]};
    for (std::size_t row = 0; row < 3; ++row) {
      dst[row][i] = (m[3 * row] * a[0] + m[3 * row + 1] * a[1]) + m[3 * row + 2] * a[2];
    }
  }
}

void half_to_float(float* dst, const std::uint16_t* src, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = float_from_half(src[i]);
}

void float_to_half(std::uint16_t* dst, const float* src, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = half_from_float(src[i]);
}

void scan_rgb(RgbScan* scan, const float* const rgb[3], std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    bool finite = true;
    bool negative = false;
    bool over_one = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const float v = rgb[k][i];
      finite = finite && std::isfinite(v);
      negative = negative || v < 0.0F;
      over_one = over_one || v > 1.0F;
      if (scan->maximum < v) scan->maximum = v;
    }
    scan->nonfinite += finite ? 0 : 1;
    scan->negative += negative ? 1 : 0;
    scan->over_one += over_one ? 1 : 0;
  }
}

void gamut_clip(float* const rgb[3], const float weights[3], float lowest, float highest,
                std::uint64_t* moved, std::size_t n) noexcept {
  const auto clamped = [&](float v) {
    const float above = v < lowest ? lowest : v;
    return highest < above ? highest : above;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (i % kLanes == 0) moved[i / kLanes] = 0;
    float v[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    bool outside = false;
    for (const float value : v) outside = outside || value < lowest || highest < value;
    for (const float value : v) outside = outside && value - value == 0.0F;
    if (!outside) continue;
    moved[i / kLanes] |= std::uint64_t{1} << (i % kLanes);
    const float y = clamped((weights[0] * v[0] + weights[1] * v[1]) + weights[2] * v[2]);
    float part = 1;
    for (const float value : v) {
      const float allowed = value < lowest    ? (y - lowest) / (y - value)
                            : highest < value ? (highest - y) / (value - y)
                                              : 1.0F;
      part = allowed < part ? allowed : part;
    }
    for (std::size_t k = 0; k < 3; ++k) rgb[k][i] = clamped(y + part * (v[k] - y));
  }
}

void rows_to_blocks(float* dst, const float* rows, std::size_t stride, std::size_t count,
                    std::size_t n) noexcept {
  const std::size_t blocks = (n + kLanes - 1) / kLanes;
  for (std::size_t lane = 0; lane < blocks * kLanes; ++lane) {
    for (std::size_t k = 0; k < count; ++k) {
      dst[(lane / kLanes * count + k) * kLanes + lane % kLanes] = lane < n ? rows[lane * stride + k] : 0.0F;
    }
  }
}

void blocks_to_rows(float* rows, std::size_t stride, const float* src, std::size_t count,
                    std::size_t n) noexcept {
  for (std::size_t lane = 0; lane < n; ++lane) {
    for (std::size_t k = 0; k < count; ++k) {
      rows[lane * stride + k] = src[(lane / kLanes * count + k) * kLanes + lane % kLanes];
    }
  }
}

}  // namespace spectile::reference
