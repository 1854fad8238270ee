// Scalar twins of the sigmoid kernels over batches.
#include "src/reference/rows.hpp"
#include "src/reference/sums.hpp"
#include "src/reference/twins.hpp"
#include "src/reference/upsampling/sigmoid.hpp"

namespace spectile::reference {
namespace {

using kernels::kLanes;
using kernels::kSigmoidRow;
using kernels::kSigmoidWhite;
using kernels::SigmoidSpectra;

float scaled_sample(const SigmoidSpectra& s, std::size_t band, std::size_t i) {
  const float lane[3] = {s.c[0][i], s.c[1][i], s.c[2][i]};
  const float* const row = s.rows + band * kSigmoidRow;
  const float sample = sigmoid_sample(sigmoid_argument(s.form, lane, row));
  return (sample * (s.white ? row[kSigmoidWhite] : 1.0F)) * (s.scale == nullptr ? 1.0F : s.scale[i]);
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

void sigmoid_continuation(float* const c[3], float* part, const float* const rgb[3],
                          const kernels::SigmoidTable& table, const float luminance[3],
                          std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const float color[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    float lane[3];
    part[i] = sigmoid_continuation(lane, color, table, luminance);
    for (std::size_t k = 0; k < 3; ++k) c[k][i] = lane[k];
  }
}

void sigmoid_blocks(float* dst, const SigmoidSpectra& spectra, std::size_t blocks,
                    bool /*non_temporal*/) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    for (std::size_t band = 0; band < spectra.bands; ++band) {
      dst[((i / kLanes) * spectra.bands + band) * kLanes + i % kLanes] = scaled_sample(spectra, band, i);
    }
  }
}

void sigmoid_rows_float(void* const* rows, const SigmoidSpectra& spectra, std::size_t n) noexcept {
  for (std::size_t band = 0; band < spectra.bands; ++band) {
    for (std::size_t i = 0; i < n; ++i) put(rows[band], i, scaled_sample(spectra, band, i));
  }
}

void sigmoid_rows_half(void* const* rows, const SigmoidSpectra& spectra, std::size_t n) noexcept {
  for (std::size_t band = 0; band < spectra.bands; ++band) {
    for (std::size_t i = 0; i < n; ++i) put(rows[band], i, clamped_half(scaled_sample(spectra, band, i)));
  }
}

void sigmoid_project(float* const dst[3], const SigmoidSpectra& spectra, const float* weights,
                     std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    float sums[3];
    for (std::size_t k = 0; k < 3; ++k) {
      sums[k] = sum_in_runs(spectra.bands, [&](std::size_t band) {
        return weights[4 * band + k] * scaled_sample(spectra, band, i);
      });
    }
    for (std::size_t k = 0; k < 3; ++k) dst[k][i] = sums[k];
  }
}

}  // namespace spectile::reference
