// Scalar twins of the sigmoid and gamut kernels.
#include <cstring>

#include "src/reference/half.hpp"
#include "src/reference/sigmoid.hpp"
#include "src/reference/sums.hpp"

namespace spectile::reference {
namespace {

using kernels::kHalfMax;
using kernels::kLanes;
using kernels::kSigmoidLambda;
using kernels::kSigmoidRow;
using kernels::kSigmoidWhite;

float sample_of(const float* const c[3], const float* scale, const float* row, bool white, std::size_t i) {
  const float lane[3] = {c[0][i], c[1][i], c[2][i]};
  const float sample = sigmoid_sample(lane, row[kSigmoidLambda]);
  return (sample * (white ? row[kSigmoidWhite] : 1.0F)) * (scale == nullptr ? 1.0F : scale[i]);
}

/// row[i] = sample, at whatever address the row starts.
template <class Sample>
void put(void* row, std::size_t i, Sample sample) {
  std::memcpy(static_cast<unsigned char*>(row) + i * sizeof(Sample), &sample, sizeof(Sample));
}

}  // namespace

void sigmoid_solve(float* const c[3], const float* const rgb[3], const kernels::SigmoidTable& table,
                   std::uint64_t* unsolved, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    if (i % kLanes == 0) unsolved[i / kLanes] = 0;
    const float color[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    float lane[3];
    if (!sigmoid_coefficients(lane, color, table)) unsolved[i / kLanes] |= std::uint64_t{1} << (i % kLanes);
    for (std::size_t k = 0; k < 3; ++k) c[k][i] = lane[k];
  }
}

void sigmoid_continuation(float* const c[3], float* reached, const float* const rgb[3],
                          const kernels::SigmoidTable& table, const float luminance[3],
                          std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const float color[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    float lane[3];
    reached[i] = sigmoid_continuation(lane, color, table, luminance);
    for (std::size_t k = 0; k < 3; ++k) c[k][i] = lane[k];
  }
}

void sigmoid_blocks(float* dst, const float* const c[3], const float* scale, const float* rows, bool white,
                    std::size_t bands, std::size_t blocks, bool /*stream*/) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    for (std::size_t band = 0; band < bands; ++band) {
      dst[((i / kLanes) * bands + band) * kLanes + i % kLanes] =
          sample_of(c, scale, rows + band * kSigmoidRow, white, i);
    }
  }
}

void sigmoid_rows_float(void* const* out, const float* const c[3], const float* scale, const float* rows,
                        bool white, std::size_t bands, std::size_t n) noexcept {
  for (std::size_t band = 0; band < bands; ++band) {
    for (std::size_t i = 0; i < n; ++i)
      put(out[band], i, sample_of(c, scale, rows + band * kSigmoidRow, white, i));
  }
}

void sigmoid_rows_half(void* const* out, const float* const c[3], const float* scale, const float* rows,
                       bool white, std::size_t bands, std::size_t n) noexcept {
  for (std::size_t band = 0; band < bands; ++band) {
    for (std::size_t i = 0; i < n; ++i) {
      const float sample = sample_of(c, scale, rows + band * kSigmoidRow, white, i);
      put(out[band], i, half_from_float(kHalfMax < sample ? kHalfMax : sample));
    }
  }
}

void sigmoid_project(float* const dst[3], const float* const c[3], const float* scale, const float* rows,
                     bool white, const float* weights, std::size_t bands, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      dst[k][i] = sum_in_runs(bands, [&](std::size_t band) {
        return weights[4 * band + k] * sample_of(c, scale, rows + band * kSigmoidRow, white, i);
      });
    }
  }
}

void gamut_clip(float* const rgb[3], const float weights[3], float lowest, float highest,
                std::uint64_t* moved, std::size_t n) noexcept {
  const auto limited = [&](float v) {
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
    const float y = limited((weights[0] * v[0] + weights[1] * v[1]) + weights[2] * v[2]);
    float part = 1;
    for (const float value : v) {
      const float allowed = value < lowest    ? (y - lowest) / (y - value)
                            : highest < value ? (highest - y) / (value - y)
                                              : 1.0F;
      part = allowed < part ? allowed : part;
    }
    for (std::size_t k = 0; k < 3; ++k) rgb[k][i] = limited(y + part * (v[k] - y));
  }
}

}  // namespace spectile::reference
