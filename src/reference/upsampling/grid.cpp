// Scalar twins of the kernels that interpolate in a grid of spectra.
#include "src/reference/centres.hpp"
#include "src/reference/rows.hpp"
#include "src/reference/twins.hpp"

namespace spectile::reference {
namespace {

using kernels::GridSpectra;
using kernels::GridTable;
using kernels::kLanes;

/// The four nodes around a colour, in floats from the first, and their weights.
struct GridPlace {
  std::size_t node[4];
  float weight[4];
};

GridPlace grid_place(const GridSpectra& spectra, std::size_t lane, std::size_t stride) {
  const GridTable& table = spectra.table;
  const float rgb[3] = {spectra.rgb[0][lane], spectra.rgb[1][lane], spectra.rgb[2][lane]};
  const float high = rgb[0] < rgb[1] ? rgb[1] : rgb[0];
  const float most = high < rgb[2] ? rgb[2] : high;
  const float size = (table.homogeneous ? 0.0F : 1.0F) < most ? most : 1.0F;
  const auto count = static_cast<std::size_t>(table.count);
  const std::size_t step[3] = {count * count * stride, count * stride, stride};
  float part[3];
  GridPlace out = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const float u = rgb[k] / size;
    std::size_t cell = 0;
    for (std::size_t i = 1; i + 1 < count; ++i) cell = u >= table.levels[i] ? i : cell;
    part[k] = (u - table.levels[cell]) * table.per_width[cell];
    out.node[0] += cell * step[k];
  }
  const bool g_below = part[1] < part[0];
  const float low = g_below ? part[1] : part[0];
  const float upper = g_below ? part[0] : part[1];
  const bool b_least = part[2] < low;
  const bool b_most = upper < part[2];
  const float least = b_least ? part[2] : low;
  const float greatest = b_most ? part[2] : upper;
  const float capped = b_most ? upper : part[2];
  const float middle = capped < low ? low : capped;
  const std::size_t last = b_least ? step[2] : step[g_below ? 1 : 0];
  const std::size_t first = b_most ? step[2] : step[g_below ? 0 : 1];
  out.node[3] = out.node[0] + step[0] + step[1] + step[2];
  out.node[1] = out.node[0] + first;
  out.node[2] = out.node[3] - last;
  const float weight[4] = {1.0F - greatest, greatest - middle, middle - least, least};
  for (std::size_t i = 0; i < 4; ++i) {
    out.weight[i] = weight[i] * size;
    if (spectra.scale != nullptr) out.weight[i] = out.weight[i] * spectra.scale[lane];
  }
  return out;
}

float mixed(const GridPlace& place, const float* nodes, std::size_t band) {
  float term[4];
  for (std::size_t i = 0; i < 4; ++i) term[i] = place.weight[i] * nodes[place.node[i] + band];
  return ((term[0] + term[1]) + term[2]) + term[3];
}

float grid_sample(const GridPlace& place, const GridTable& table, std::size_t band) {
  const float sample = mixed(place, table.nodes, band);
  return sample < table.lowest ? table.lowest : sample;
}

}  // namespace

void grid_blocks(float* dst, const GridSpectra& spectra, std::size_t blocks, bool /*non_temporal*/) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    const GridPlace place = grid_place(spectra, i, spectra.table.stride);
    for (std::size_t band = 0; band < spectra.table.bands; ++band) {
      dst[((i / kLanes) * spectra.table.bands + band) * kLanes + i % kLanes] =
          grid_sample(place, spectra.table, band);
    }
  }
}

void grid_rows_float(void* const* rows, const GridSpectra& spectra, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const GridPlace place = grid_place(spectra, i, spectra.table.stride);
    for (std::size_t band = 0; band < spectra.table.bands; ++band)
      put(rows[band], i, grid_sample(place, spectra.table, band));
  }
}

void grid_rows_half(void* const* rows, const GridSpectra& spectra, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const GridPlace place = grid_place(spectra, i, spectra.table.stride);
    for (std::size_t band = 0; band < spectra.table.bands; ++band) {
      put(rows[band], i, clamped_half(grid_sample(place, spectra.table, band)));
    }
  }
}

void grid_fold(float* const dst[3], const GridSpectra& spectra, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const GridPlace place = grid_place(spectra, i, kernels::kGridColor);
    for (std::size_t k = 0; k < 3; ++k) dst[k][i] = mixed(place, spectra.table.nodes, k);
  }
}

void grid_at(float* dst, const GridSpectra& spectra, const kernels::CentreTable& centres,
             const float* lambda_nm, std::size_t count, std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    const GridPlace place = grid_place(spectra, i, spectra.table.stride);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = own_sample(i, k, count);
      dst[at] = lambda_nm[at];
      if (std::isnan(lambda_nm[at])) continue;
      const CentrePlace where = place_between(centres, lambda_nm[at]);
      dst[at] = between(grid_sample(place, spectra.table, where.interval),
                        grid_sample(place, spectra.table, where.interval + 1), where.part);
    }
  }
}

}  // namespace spectile::reference
