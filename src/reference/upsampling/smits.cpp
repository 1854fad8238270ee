// Scalar twins of the Smits kernels.
#include "src/reference/upsampling/smits.hpp"

#include "src/reference/centres.hpp"
#include "src/reference/rows.hpp"
#include "src/reference/twins.hpp"

namespace spectile::reference {

using kernels::kLanes;
using kernels::kSmitsRow;
using kernels::SmitsTable;

namespace {

float mixed(const SmitsMixture& m, const float* row) {
  return (m.white * row[0] + m.second * row[m.second_index]) + m.first * row[m.first_index];
}

float smits_sample(const SmitsMixture& m, const SmitsTable& table, std::size_t band) {
  const float sample = mixed(m, table.rows + band * kSmitsRow);
  return sample < table.lowest ? table.lowest : sample;
}

}  // namespace

void smits_blocks(float* dst, const float* const rgb[3], const SmitsTable& table, std::size_t blocks,
                  bool /*non_temporal*/) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    const SmitsMixture m = smits_mixture(rgb[0][i], rgb[1][i], rgb[2][i]);
    for (std::size_t band = 0; band < table.bands; ++band) {
      dst[((i / kLanes) * table.bands + band) * kLanes + i % kLanes] = smits_sample(m, table, band);
    }
  }
}

void smits_rows_float(void* const* rows, const float* const rgb[3], const SmitsTable& table,
                      std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const SmitsMixture m = smits_mixture(rgb[0][i], rgb[1][i], rgb[2][i]);
    for (std::size_t band = 0; band < table.bands; ++band) {
      put(rows[band], i, smits_sample(m, table, band));
    }
  }
}

void smits_rows_half(void* const* rows, const float* const rgb[3], const SmitsTable& table,
                     std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const SmitsMixture m = smits_mixture(rgb[0][i], rgb[1][i], rgb[2][i]);
    for (std::size_t band = 0; band < table.bands; ++band) {
      const float sample = smits_sample(m, table, band);
      put(rows[band], i, clamped_half(sample));
    }
  }
}

void smits_fold(float* const dst[3], const float* const rgb[3], const float* table, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const SmitsMixture m = smits_mixture(rgb[0][i], rgb[1][i], rgb[2][i]);
    for (std::size_t k = 0; k < 3; ++k) dst[k][i] = mixed(m, table + k * kSmitsRow);
  }
}

void mixtures_at(float* dst, const float* const rgb[3], const kernels::MixtureTable& table,
                 const kernels::CentreTable& centres, const float* lambda_nm, std::size_t count,
                 std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    const SmitsMixture m = smits_mixture(rgb[0][i], rgb[1][i], rgb[2][i]);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = own_sample(i, k, count);
      dst[at] = lambda_nm[at];
      if (std::isnan(lambda_nm[at])) continue;
      const CentrePlace where = place_between(centres, lambda_nm[at]);
      float ends[2];
      for (std::size_t end = 0; end < 2; ++end) {
        float row[kSmitsRow];
        for (std::size_t b = 0; b < kSmitsRow; ++b)
          row[b] = table.ends[2 * (where.interval * kSmitsRow + b) + end];
        const float sample = mixed(m, row);
        ends[end] = sample < table.lowest ? table.lowest : sample;
      }
      dst[at] = between(ends[0], ends[1], where.part);
    }
  }
}

void bases_at(float* dst, const float* weights, const kernels::MixtureTable& table,
              const kernels::CentreTable& centres, const float* lambda_nm, std::size_t count,
              std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = own_sample(i, k, count);
      dst[at] = lambda_nm[at];
      if (std::isnan(lambda_nm[at])) continue;
      const CentrePlace where = place_between(centres, lambda_nm[at]);
      float ends[2];
      for (std::size_t end = 0; end < 2; ++end) {
        const float* const row = table.ends + 2 * where.interval * kSmitsRow + end;
        float sample = weights[own_sample(i, 0, kSmitsRow)] * row[0];
        for (std::size_t b = 1; b + 1 < kSmitsRow; ++b)
          sample = sample + weights[own_sample(i, b, kSmitsRow)] * row[2 * b];
        ends[end] = sample < table.lowest ? table.lowest : sample;
      }
      dst[at] = between(ends[0], ends[1], where.part);
    }
  }
}

}  // namespace spectile::reference
