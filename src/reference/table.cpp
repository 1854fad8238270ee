// Scalar twins of the colour, upsampling and conversion kernels, and the table of all of them.
#include "src/reference/table.hpp"

#include <cmath>
#include <cstring>

#include "src/reference/arithmetic.hpp"
#include "src/reference/film.hpp"
#include "src/reference/half.hpp"
#include "src/reference/peak.hpp"
#include "src/reference/sigmoid.hpp"
#include "src/reference/smits.hpp"
#include "src/reference/sums.hpp"
#include "src/reference/wavelengths.hpp"

namespace spectile::reference {
namespace {

using kernels::kHalfMax;
using kernels::kLanes;
using kernels::kSmitsRow;
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

void project(float* x, float* y, float* z, const float* spectra, const float* weights, std::size_t bands,
             std::size_t blocks) noexcept {
  float* const out[3] = {x, y, z};
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      for (std::size_t k = 0; k < 3; ++k) {
        out[k][block * kLanes + lane] = sum_in_runs(bands, [&](std::size_t band) {
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

float smits_sample(const SmitsMixture& m, const float* row, float lowest) {
  const float sample = (m.white * row[0] + m.second * row[m.second_index]) + m.first * row[m.first_index];
  return sample < lowest ? lowest : sample;
}

void smits_blocks(float* dst, const float* const rgb[3], const float* table, float lowest, std::size_t bands,
                  std::size_t blocks, bool /*stream*/) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    const SmitsMixture m = smits_mixture(rgb[0][i], rgb[1][i], rgb[2][i]);
    for (std::size_t band = 0; band < bands; ++band) {
      dst[((i / kLanes) * bands + band) * kLanes + i % kLanes] =
          smits_sample(m, table + band * kSmitsRow, lowest);
    }
  }
}

/// row[i] = sample, at whatever address the row starts.
template <class Sample>
void put(void* row, std::size_t i, Sample sample) {
  std::memcpy(static_cast<unsigned char*>(row) + i * sizeof(Sample), &sample, sizeof(Sample));
}

void smits_rows_float(void* const* rows, const float* const rgb[3], const float* table, float lowest,
                      std::size_t bands, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const SmitsMixture m = smits_mixture(rgb[0][i], rgb[1][i], rgb[2][i]);
    for (std::size_t band = 0; band < bands; ++band) {
      put(rows[band], i, smits_sample(m, table + band * kSmitsRow, lowest));
    }
  }
}

void smits_rows_half(void* const* rows, const float* const rgb[3], const float* table, float lowest,
                     std::size_t bands, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const SmitsMixture m = smits_mixture(rgb[0][i], rgb[1][i], rgb[2][i]);
    for (std::size_t band = 0; band < bands; ++band) {
      const float sample = smits_sample(m, table + band * kSmitsRow, lowest);
      put(rows[band], i, half_from_float(kHalfMax < sample ? kHalfMax : sample));
    }
  }
}

void smits_fold(float* const dst[3], const float* const rgb[3], const float* table, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const SmitsMixture m = smits_mixture(rgb[0][i], rgb[1][i], rgb[2][i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const float* const row = table + k * kSmitsRow;
      dst[k][i] = (m.white * row[0] + m.second * row[m.second_index]) + m.first * row[m.first_index];
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

}  // namespace

const kernels::KernelTable table = {
    .name = "scalar",
    .lanes = 1,
    .add = add,
    .subtract = subtract,
    .multiply = multiply,
    .divide = divide,
    .divide_or_zero = divide_or_zero,
    .negate = negate,
    .scale = scale,
    .multiply_add = multiply_add,
    .lerp = lerp,
    .sqrt = sqrt,
    .exp = exp,
    .pow = pow,
    .clamp = clamp,
    .minimum = minimum,
    .maximum = maximum,
    .black_mask = black_mask,
    .nan_mask = nan_mask,
    .equal_mask = equal_mask,
    .weighted_sum = weighted_sum,
    .project = project,
    .transform3 = transform3,
    .smits_blocks = smits_blocks,
    .smits_rows_float = smits_rows_float,
    .smits_rows_half = smits_rows_half,
    .smits_fold = smits_fold,
    .sigmoid_solve = sigmoid_solve,
    .sigmoid_continuation = sigmoid_continuation,
    .sigmoid_blocks = sigmoid_blocks,
    .sigmoid_rows_float = sigmoid_rows_float,
    .sigmoid_rows_half = sigmoid_rows_half,
    .sigmoid_project = sigmoid_project,
    .look_up_even = look_up_even,
    .look_up_knots = look_up_knots,
    .planck = planck,
    .gaussians = gaussians,
    .sigmoid_at = sigmoid_at,
    .even_wavelengths = even_wavelengths,
    .visible_wavelengths = visible_wavelengths,
    .project_wavelengths = project_wavelengths,
    .film_weigh_wavelengths = film_weigh_wavelengths,
    .film_weigh_bands = film_weigh_bands,
    .film_band_quads = film_band_quads,
    .film_hits = film_hits,
    .film_place = film_place,
    .film_add = film_add,
    .film_add_hits = film_add_hits,
    .film_add_moments = film_add_moments,
    .film_count = film_count,
    .gamut_clip = gamut_clip,
    .half_to_float = half_to_float,
    .float_to_half = float_to_half,
    .scan_rgb = scan_rgb,
    .peak_load = peak_load,
    .peak_store = peak_store,
    .peak_copy = peak_copy,
    .peak_multiply_add = peak_multiply_add,
    .peak_fused = peak_fused,
    .peak_divide = peak_divide,
};

}  // namespace spectile::reference
