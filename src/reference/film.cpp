// Scalar twins of the film's kernels: one sample, one component at a time, the grid by rounding to whole
// numbers rather than by the bits.
#include "src/reference/film.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace spectile::reference {
namespace {

using namespace kernels;

std::int32_t first_reason(bool nan, bool infinite, bool negative) {
  if (nan) return kFilmNan;
  if (infinite) return kFilmInfinite;
  return negative ? kFilmNegative : kFilmAccepted;
}

bool beyond(float v, float limit) {
  return !(std::abs(v) <= limit);
}

/// What is left of weighing once a sample has a colour. Returns whether it is within the range.
bool put(float* quad, bool luminance, std::array<float, 3> color, const FilmLimits& limits, float weight) {
  if (std::isfinite(limits.maximum)) {
    float most = std::abs(color[0]);
    if (most < std::abs(color[1])) most = std::abs(color[1]);
    if (most < std::abs(color[2])) most = std::abs(color[2]);
    if (most > limits.maximum) {
      for (float& v : color) v = (v / most) * limits.maximum;
    }
  }
  bool fits = !beyond(weight, limits.weight_range);
  if (luminance) fits = fits && !beyond(color[1], limits.range);
  for (std::size_t c = 0; c < 3; ++c) {
    quad[c] = color[c] * weight;
    fits = fits && !beyond(quad[c], limits.range);
  }
  quad[3] = weight;
  return fits;
}

float weight_of(const float* weight, std::size_t i) {
  return weight == nullptr ? 1.0F : weight[i];
}

/// The row of the curves for a wavelength, and its part of the way to the next one.
const float* look_up(const FilmCurves& curves, float lambda, float& part) {
  const float t = lambda - curves.first_nm;
  part = 0;
  if (!(t >= 0.0F && t <= static_cast<float>(curves.intervals))) {
    return curves.rows + std::ptrdiff_t{8} * (curves.intervals + 1);
  }
  part = t - std::floor(t);
  return curves.rows + std::ptrdiff_t{8} * static_cast<std::int32_t>(t);
}

/// Adds v to limbs of ever smaller steps. A limb's step is 2^-52 / 1.5 of its magic number.
void add_limbs(std::int64_t* limbs, std::ptrdiff_t apart, double v, const double* magic, int count) {
  for (int k = 0; k < count; ++k) {
    const double step = magic[k] / (1.5 * 0x1p52);
    const double steps = std::nearbyint(v / step);
    limbs[k * apart] += static_cast<std::int64_t>(steps);
    v -= steps * step;
  }
}

std::int64_t* place_of(std::int64_t* const* tiles, std::size_t offset, std::size_t per_pixel,
                       std::int32_t address) {
  const auto at = static_cast<std::size_t>(address);
  return tiles[at / kFilmTilePixels] + offset + (at % kFilmTilePixels) * per_pixel;
}

std::size_t sample_of(const FilmEntries& entries, std::size_t i) {
  return entries.sample == nullptr ? i : entries.sample[i];
}

float factor_of(const FilmEntries& entries, std::size_t i) {
  return entries.factor == nullptr ? 1.0F : entries.factor[i];
}

std::int32_t band_at(const BucketTable& table, float lambda) {
  if (!(lambda >= table.edges[0] && lambda < table.edges[table.count - 1])) return -1;
  const float* const after = std::upper_bound(table.edges, table.edges + table.count, lambda);
  return table.band[after - table.edges - 1];
}

}  // namespace

void film_weigh_wavelengths(float* quads, bool luminance, std::int32_t* reasons, const FilmCurves& curves,
                            const FilmLimits& limits, const float* const* radiance,
                            const float* const* lambda_nm, const float* const* density, const float* weight,
                            float factor, std::size_t count, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    std::array<float, 3> values{};
    std::array<float, 3> differences{};
    bool nan = false;
    bool infinite = false;
    bool negative = false;
    for (std::size_t k = 0; k < count; ++k) {
      const float pdf = density[k][i];
      if (pdf == 0.0F) continue;
      const float lambda = lambda_nm[k][i];
      const float ratio = radiance[k][i] / pdf;
      for (const float v : {pdf, lambda, ratio}) {
        nan = nan || std::isnan(v);
        infinite = infinite || std::isinf(v);
      }
      negative = negative || pdf < 0.0F;
      float part = 0;
      const float* const row = look_up(curves, lambda, part);
      for (std::size_t c = 0; c < 3; ++c) {
        values[c] += row[c] * ratio;
        differences[c] += row[4 + c] * (part * ratio);
      }
    }
    std::array<float, 3> sum{};
    for (std::size_t c = 0; c < 3; ++c) sum[c] = (values[c] + differences[c]) * factor;
    const bool fits = put(quads + 4 * i, luminance, sum, limits, weight_of(weight, i));
    reasons[i] = first_reason(nan, infinite, negative);
    if (reasons[i] == kFilmAccepted && !fits) reasons[i] = kFilmBeyondRange;
  }
}

void film_weigh_bands(float* quads, bool luminance, std::int32_t* reasons, const float* weights,
                      const FilmLimits& limits, const float* const* radiance, const float* weight,
                      std::size_t bands, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    std::array<float, 3> sum{};
    bool nan = false;
    bool infinite = false;
    for (std::size_t first = 0; first < bands; first += kSumRun) {
      std::array<float, 3> run{};
      for (std::size_t b = first; b < std::min(bands, first + kSumRun); ++b) {
        const float v = radiance[b][i];
        nan = nan || std::isnan(v);
        infinite = infinite || std::isinf(v);
        for (std::size_t c = 0; c < 3; ++c) run[c] += weights[4 * b + c] * v;
      }
      for (std::size_t c = 0; c < 3; ++c) sum[c] += run[c];
    }
    const bool fits = put(quads + 4 * i, luminance, sum, limits, weight_of(weight, i));
    reasons[i] = first_reason(nan, infinite, false);
    if (reasons[i] == kFilmAccepted && !fits) reasons[i] = kFilmBeyondRange;
  }
}

void film_band_quads(float* quads, std::size_t stride, std::int32_t* reasons, const FilmLimits& limits,
                     const float* const* radiance, const float* weight, std::size_t bands,
                     std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    float most = 0;
    for (std::size_t b = 0; b < bands; ++b) most = std::max(most, std::abs(radiance[b][i]));
    const float w = weight_of(weight, i);
    const bool clamps = std::isfinite(limits.maximum) && most > limits.maximum;
    float* const quad = quads + i * stride;
    for (std::size_t b = 0; b < (bands + 3) / 4 * 4; ++b) {
      const float v = b < bands ? radiance[b][i] : 0.0F;
      quad[b] = (clamps ? (v / most) * limits.maximum : v) * w;
      if (b >= bands) quad[b] = 0;
      if (reasons[i] == kFilmAccepted && beyond(quad[b], limits.range)) reasons[i] = kFilmBeyondRange;
    }
  }
}

void film_hits(std::int32_t* band, float* hits, std::int32_t* reasons, const BucketTable& table,
               const FilmLimits& limits, const float* const* radiance, const float* const* lambda_nm,
               const float* const* density, const float* weight, float reference, std::size_t count,
               std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const bool clamps = std::isfinite(limits.maximum);
    float most = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (density[k][i] != 0.0F) most = std::max(most, std::abs(radiance[k][i]));
    }
    bool fits = true;
    for (std::size_t k = 0; k < count; ++k) {
      const bool live = density[k][i] != 0.0F;
      const float u = weight_of(weight, i) * (reference / density[k][i]);
      const bool too_large = clamps && most > limits.maximum;
      const float value = (too_large ? (radiance[k][i] / most) * limits.maximum : radiance[k][i]) * u;
      band[k * n + i] = live ? band_at(table, lambda_nm[k][i]) : -1;
      hits[2 * (k * n + i)] = value;
      hits[2 * (k * n + i) + 1] = u;
      fits =
          fits && (band[k * n + i] < 0 || (!beyond(value, limits.range) && !beyond(u, limits.weight_range)));
    }
    if (reasons[i] == kFilmAccepted && !fits) reasons[i] = kFilmBeyondRange;
  }
}

void film_place(std::int32_t* address, std::int32_t tiles[2], std::uint64_t counts[kFilmReasons],
                const FilmWindow& window, const float* x, const float* y, const float* weight,
                const std::int32_t* reasons, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const float w = weight_of(weight, i);
    bool nan = false;
    bool infinite = false;
    for (const float v : {x[i], y[i], w}) {
      nan = nan || std::isnan(v);
      infinite = infinite || std::isinf(v);
    }
    std::int32_t reason = first_reason(nan, infinite, !window.negative_weights && w < 0.0F);
    if (reason == kFilmAccepted &&
        !(x[i] >= window.x0 && x[i] < window.x1 && y[i] >= window.y0 && y[i] < window.y1)) {
      reason = kFilmOutside;
    }
    if (reasons[i] != kFilmAccepted) {
      reason = reason == kFilmAccepted ? reasons[i] : std::min(reason, reasons[i]);
    }
    ++counts[reason];
    if (reason != kFilmAccepted) {
      address[i] = -reason;
      continue;
    }
    constexpr std::int32_t kSide = 1 << kFilmTileLog2;
    const std::int32_t column = static_cast<std::int32_t>(std::floor(x[i])) - window.origin_x;
    const std::int32_t row = static_cast<std::int32_t>(std::floor(y[i])) - window.origin_y;
    const std::int32_t tile = (row / kSide) * window.tiles_x + column / kSide;
    address[i] = tile * kSide * kSide + (row % kSide) * kSide + column % kSide;
    tiles[0] = std::min(tiles[0], tile);
    tiles[1] = std::max(tiles[1], tile);
  }
}

void film_add(std::int64_t* const* tiles, std::size_t offset, const FilmGrid& grid,
              const FilmEntries& entries, const float* quads, std::size_t count, std::size_t limbs) noexcept {
  for (std::size_t i = 0; i < entries.count; ++i) {
    if (entries.address[i] < 0) continue;
    std::int64_t* const pixel = place_of(tiles, offset, limbs, entries.address[i]);
    for (std::size_t c = 0; c < 4 * count; ++c) {
      const float v = quads[4 * sample_of(entries, i) * count + c] * factor_of(entries, i);
      const double magic[2] = {grid.coarse[c % 4], grid.rest[c % 4]};
      add_limbs(pixel + 8 * (c / 4) + c % 4, 4, static_cast<double>(v), magic, 2);
    }
  }
}

void film_add_hits(std::int64_t* const* tiles, std::size_t offset, const FilmGrid& grid,
                   const FilmEntries& entries, const std::int32_t* band, const float* hits, std::size_t count,
                   std::size_t n, std::size_t bands) noexcept {
  for (std::size_t i = 0; i < entries.count; ++i) {
    if (entries.address[i] < 0) continue;
    std::int64_t* const pixel = place_of(tiles, offset, 4 * bands, entries.address[i]);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = k * n + sample_of(entries, i);
      if (band[at] < 0) continue;
      for (std::size_t c = 0; c < 2; ++c) {
        const float v = hits[2 * at + c] * factor_of(entries, i);
        const double magic[2] = {grid.coarse[c], grid.rest[c]};
        add_limbs(pixel + 4 * static_cast<std::ptrdiff_t>(band[at]) + c, 2, static_cast<double>(v), magic, 2);
      }
    }
  }
}

void film_add_moments(std::int64_t* const* tiles, std::size_t offset, const FilmMomentGrid& grid,
                      const FilmEntries& entries, const float* quads) noexcept {
  for (std::size_t i = 0; i < entries.count; ++i) {
    if (entries.address[i] < 0) continue;
    std::int64_t* const pixel = place_of(tiles, offset, 8, entries.address[i]);
    const std::size_t sample = sample_of(entries, i);
    const auto w = static_cast<double>(quads[4 * sample + 3] * factor_of(entries, i));
    const auto y = static_cast<double>(quads[4 * sample + 1] * factor_of(entries, i));
    add_limbs(pixel, 1, w == 0.0 ? 0.0 : y * (y / w), grid.luminance, 4);
    std::int64_t square[3] = {pixel[4], pixel[5], pixel[7]};
    add_limbs(square, 1, w * w, grid.weight, 3);
    pixel[4] = square[0];
    pixel[5] = square[1];
    pixel[7] = square[2];
    ++pixel[6];
  }
}

void film_count(std::int64_t* const* tiles, std::size_t offset, const FilmEntries& entries) noexcept {
  for (std::size_t i = 0; i < entries.count; ++i) {
    if (entries.address[i] >= 0) ++*place_of(tiles, offset, 1, entries.address[i]);
  }
}

}  // namespace spectile::reference
