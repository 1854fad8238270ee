// Scalar twins of the film's kernels: one sample, one component at a time, the grid by rounding to integers
// rather than by the bits.
#include <algorithm>
#include <array>
#include <cmath>

#include "src/reference/twins.hpp"

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

/// Weighs a sample that has a colour. Returns true if it is within the range.
bool put_quad(float* quad, bool luminance, std::array<float, 3> color, const FilmLimits& limits,
              float weight) {
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

/// The i-th of factors, 1 where there are none.
float factor_at(const float* factors, std::size_t i) {
  return factors == nullptr ? 1.0F : factors[i];
}

/// The i-th quad and its reason.
void finish(const FilmQuads& out, std::size_t i, const std::array<float, 3>& color, const FilmLimits& limits,
            float weight, std::int32_t reason) {
  const bool fits = put_quad(out.quads + 4 * i, out.luminance, color, limits, weight);
  out.reasons[i] = reason == kFilmAccepted && !fits ? kFilmBeyondRange : reason;
}

/// The row of the curves for a wavelength, and its part of the way to the next one.
const float* find_row(const FilmCurves& curves, float lambda, float& part) {
  const float t = lambda - curves.first_nm;
  part = 0;
  if (!(t >= 0.0F && t <= static_cast<float>(curves.intervals))) {
    return curves.rows + std::ptrdiff_t{8} * (curves.intervals + 1);
  }
  part = t - std::floor(t);
  return curves.rows + std::ptrdiff_t{8} * static_cast<std::int32_t>(t);
}

/// Adds v to limbs of ever smaller steps. A limb's step is 2^-52 / 1.5 of its magic number.
void add_limbs(std::int64_t* limbs, std::size_t apart, double v, const double* magic, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    const double step = magic[k] / (1.5 * 0x1p52);
    const double steps = std::nearbyint(v / step);
    limbs[k * apart] += static_cast<std::int64_t>(steps);
    v -= steps * step;
  }
}

/// Calls add(sample, factor, pixel's limbs) for each entry.
template <class Add>
void for_entries(const FilmSums& to, const FilmEntries& entries, Add add) {
  for (std::size_t i = 0; i < entries.count; ++i) {
    if (entries.address[i] < 0) continue;
    const auto at = static_cast<std::size_t>(entries.address[i]);
    add(entries.sample == nullptr ? i : entries.sample[i], factor_at(entries.factor, i),
        to.tiles[at / kFilmTilePixels] + to.offset + (at % kFilmTilePixels) * to.limbs);
  }
}

std::int32_t band_at(const BucketTable& table, float lambda) {
  if (!(lambda >= table.edges[0] && lambda < table.edges[table.count - 1])) return -1;
  const float* const after = std::upper_bound(table.edges, table.edges + table.count, lambda);
  return table.band[after - table.edges - 1];
}

}  // namespace

void film_weigh_wavelengths(const FilmQuads& out, const FilmSamples& samples, const FilmCurves& curves,
                            const FilmLimits& limits, float factor) noexcept {
  for (std::size_t i = 0; i < samples.n; ++i) {
    std::array<float, 3> values{};
    std::array<float, 3> differences{};
    bool nan = false;
    bool infinite = false;
    bool negative = false;
    const std::size_t place = samples.place(i);
    for (std::size_t k = 0; k < samples.count; ++k) {
      const float pdf = samples.density[k][place];
      if (pdf == 0.0F) continue;
      const float lambda = samples.lambda_nm[k][place];
      const float ratio = samples.radiance[k][place] / pdf;
      for (const float v : {pdf, lambda, ratio}) {
        nan = nan || std::isnan(v);
        infinite = infinite || std::isinf(v);
      }
      negative = negative || pdf < 0.0F;
      float part = 0;
      const float* const row = find_row(curves, lambda, part);
      for (std::size_t c = 0; c < 3; ++c) {
        values[c] += row[c] * ratio;
        differences[c] += row[4 + c] * (part * ratio);
      }
    }
    std::array<float, 3> sum{};
    for (std::size_t c = 0; c < 3; ++c) sum[c] = (values[c] + differences[c]) * factor;
    finish(out, i, sum, limits, factor_at(samples.weight, i), first_reason(nan, infinite, negative));
  }
}

void film_weigh_bands(const FilmQuads& out, const FilmSamples& samples, const float* weights,
                      const FilmLimits& limits) noexcept {
  const std::size_t bands = samples.count;
  for (std::size_t i = 0; i < samples.n; ++i) {
    std::array<float, 3> sum{};
    bool nan = false;
    bool infinite = false;
    for (std::size_t first = 0; first < bands; first += kSumRun) {
      std::array<float, 3> run{};
      for (std::size_t b = first; b < std::min(bands, first + kSumRun); ++b) {
        const float v = samples.radiance[b][samples.place(i)];
        nan = nan || std::isnan(v);
        infinite = infinite || std::isinf(v);
        for (std::size_t c = 0; c < 3; ++c) run[c] += weights[4 * b + c] * v;
      }
      for (std::size_t c = 0; c < 3; ++c) sum[c] += run[c];
    }
    finish(out, i, sum, limits, factor_at(samples.weight, i), first_reason(nan, infinite, false));
  }
}

void film_band_quads(float* quads, std::size_t stride, std::int32_t* reasons, const FilmSamples& samples,
                     const FilmLimits& limits) noexcept {
  const float* const* const radiance = samples.radiance;
  const std::size_t bands = samples.count;
  for (std::size_t i = 0; i < samples.n; ++i) {
    float most = 0;
    for (std::size_t b = 0; b < bands; ++b) most = std::max(most, std::abs(radiance[b][samples.place(i)]));
    const float w = factor_at(samples.weight, i);
    const bool clamps = std::isfinite(limits.maximum) && most > limits.maximum;
    float* const quad = quads + i * stride;
    for (std::size_t b = 0; b < (bands + 3) / 4 * 4; ++b) {
      const float v = b < bands ? radiance[b][samples.place(i)] : 0.0F;
      quad[b] = (clamps ? (v / most) * limits.maximum : v) * w;
      if (b >= bands) quad[b] = 0;
      if (reasons[i] == kFilmAccepted && beyond(quad[b], limits.range)) reasons[i] = kFilmBeyondRange;
    }
  }
}

void film_hits(const FilmHits& out, const FilmSamples& samples, const BucketTable& table,
               const FilmLimits& limits, float reference) noexcept {
  for (std::size_t i = 0; i < samples.n; ++i) {
    const bool clamps = std::isfinite(limits.maximum);
    const std::size_t place = samples.place(i);
    float most = 0;
    for (std::size_t k = 0; k < samples.count; ++k) {
      if (samples.density[k][place] != 0.0F) most = std::max(most, std::abs(samples.radiance[k][place]));
    }
    bool fits = true;
    for (std::size_t k = 0; k < samples.count; ++k) {
      const float density = samples.density[k][place];
      const float radiance = samples.radiance[k][place];
      const std::size_t at = k * samples.n + i;
      const float u = factor_at(samples.weight, i) * (reference / density);
      const bool too_large = clamps && most > limits.maximum;
      const float value = (too_large ? (radiance / most) * limits.maximum : radiance) * u;
      out.band[at] = density != 0.0F ? band_at(table, samples.lambda_nm[k][place]) : -1;
      out.values[2 * at] = value;
      out.values[2 * at + 1] = u;
      fits = fits && (out.band[at] < 0 || (!beyond(value, limits.range) && !beyond(u, limits.weight_range)));
    }
    if (out.reasons[i] == kFilmAccepted && !fits) out.reasons[i] = kFilmBeyondRange;
  }
}

void film_place(const FilmPlaces& out, const FilmWindow& window, const FilmPositions& samples) noexcept {
  const auto& [x, y, weight, reasons, n] = samples;
  const auto& [address, tiles, counts] = out;
  for (std::size_t i = 0; i < n; ++i) {
    const float w = factor_at(weight, i);
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

void film_add(const FilmSums& to, const FilmGrid& grid, const FilmEntries& entries, const float* quads,
              std::size_t count) noexcept {
  for_entries(to, entries, [&](std::size_t sample, float factor, std::int64_t* pixel) {
    for (std::size_t c = 0; c < 4 * count; ++c) {
      const float v = quads[4 * sample * count + c] * factor;
      const double magic[2] = {grid.coarse[c % 4], grid.rest[c % 4]};
      add_limbs(pixel + kFilmQuadLimbs * (c / 4) + c % 4, kFilmQuadRest, static_cast<double>(v), magic, 2);
    }
  });
}

void film_add_hits(const FilmSums& to, const FilmGrid& grid, const FilmEntries& entries,
                   const FilmHitRows& hits) noexcept {
  for_entries(to, entries, [&](std::size_t sample, float factor, std::int64_t* pixel) {
    for (std::size_t k = 0; k < hits.count; ++k) {
      const std::size_t at = k * hits.n + sample;
      if (hits.band[at] < 0) continue;
      for (std::size_t c = 0; c < 2; ++c) {
        const float v = hits.values[2 * at + c] * factor;
        const double magic[2] = {grid.coarse[c], grid.rest[c]};
        add_limbs(pixel + kFilmHitLimbs * static_cast<std::size_t>(hits.band[at]) + c, kFilmHitRest,
                  static_cast<double>(v), magic, 2);
      }
    }
  });
}

void film_add_moments(const FilmSums& to, const FilmMomentGrid& grid, const FilmEntries& entries,
                      const float* quads) noexcept {
  for_entries(to, entries, [&](std::size_t sample, float factor, std::int64_t* pixel) {
    const auto w = static_cast<double>(quads[4 * sample + kFilmQuadWeight] * factor);
    const auto y = static_cast<double>(quads[4 * sample + 1] * factor);
    add_limbs(pixel, 1, w == 0.0 ? 0.0 : y * (y / w), grid.luminance, kFilmSquareLimbs);
    std::int64_t square[kFilmWeightSquareLimbs] = {};
    add_limbs(square, 1, w * w, grid.weight, kFilmWeightSquareLimbs);
    for (std::size_t k = 0; k < kFilmWeightSquareLimbs; ++k) pixel[kFilmWeightSquare[k]] += square[k];
    ++pixel[kFilmMomentCount];
  });
}

void film_count(const FilmSums& to, const FilmEntries& entries) noexcept {
  for_entries(to, entries, [](std::size_t, float, std::int64_t* pixel) { ++*pixel; });
}

}  // namespace spectile::reference
