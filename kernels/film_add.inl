// Placing film samples in pixels, and adding their contributions to the limbs of exact sums.
#pragma once

#include "kernels/film_weigh.inl"
#include "kernels/simd/quads.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

/// Entries ahead of the one being added whose pixels are fetched: a few hundred cycles of work.
inline constexpr std::size_t kFilmAhead = 16;

void film_place(const FilmPlaces& out, const FilmWindow& given, const FilmPositions& samples) noexcept {
  const FilmWindow window = given;  // copies that stores leave alone
  const auto [x, y, weight, reasons, n] = samples;
  const auto [address, tiles, counts] = out;
  I32 lowest(tiles[0]);
  I32 highest(tiles[1]);
  const F32 zero(0.0F);
  const F32 x0(window.x0);
  const F32 y0(window.y0);
  const I32 inner((1 << kFilmTileLog2) - 1);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 px = load_any(x + i);
    const F32 py = load_any(y + i);
    const F32 w = weight == nullptr ? F32(1.0F) : load_any(weight + i);
    const Mask inside = (px >= x0) & (px < F32(window.x1)) & (py >= y0) & (py < F32(window.y1));
    const I32 column = xsimd::to_int(xsimd::select(inside, px, x0)) - I32(window.origin_x);
    const I32 row = xsimd::to_int(xsimd::select(inside, py, y0)) - I32(window.origin_y);
    const I32 tile = (row >> kFilmTileLog2) * I32(window.tiles_x) + (column >> kFilmTileLog2);
    const I32 pixel = ((row & inner) << kFilmTileLog2) | (column & inner);
    ((tile << (2 * kFilmTileLog2)) | pixel).store_unaligned(address + i);
    Mask good = inside & ((((px + py) + w) * zero) == zero);
    if (!window.negative_weights) good = good & (w >= zero);
    const I32 why = I32::load_unaligned(reasons + i);
    const std::uint64_t fine = lane_bits(good & (xsimd::to_float(why) == zero));
    const std::size_t lanes = n - i < kWidth ? n - i : kWidth;
    if (lanes == kWidth && fine == (std::uint64_t{1} << kWidth) - 1) {
      counts[kFilmAccepted] += kWidth;
      lowest = xsimd::min(lowest, tile);
      highest = xsimd::max(highest, tile);
      continue;
    }
    for (std::size_t lane = i; lane < i + lanes; ++lane) {
      const float lane_weight = weight == nullptr ? 1.0F : weight[lane];
      Faults faults;
      faults.scan(x[lane]);
      faults.scan(y[lane]);
      faults.scan(lane_weight);
      faults.negative = lane_weight < 0.0F && !window.negative_weights;
      std::int32_t reason = faults.reason();
      const bool within =
          x[lane] >= window.x0 && x[lane] < window.x1 && y[lane] >= window.y0 && y[lane] < window.y1;
      if (reason == kFilmAccepted && !within) reason = kFilmOutside;
      const std::int32_t known = reasons[lane];
      if (known != kFilmAccepted && (reason == kFilmAccepted || known < reason)) reason = known;
      ++counts[reason];
      if (reason != kFilmAccepted) {
        address[lane] = -reason;
        continue;
      }
      const std::int32_t at = address[lane] >> (2 * kFilmTileLog2);
      tiles[0] = at < tiles[0] ? at : tiles[0];
      tiles[1] = at > tiles[1] ? at : tiles[1];
    }
  }
  alignas(64) std::int32_t ends[2][kWidth];
  lowest.store_aligned(ends[0]);
  highest.store_aligned(ends[1]);
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    tiles[0] = ends[0][lane] < tiles[0] ? ends[0][lane] : tiles[0];
    tiles[1] = ends[1][lane] > tiles[1] ? ends[1][lane] : tiles[1];
  }
}

/// Calls add(sample, factor, pixel's place) for each entry. A run within one tile need not find it again.
template <class Add>
inline void for_entries(const FilmSums& to, const FilmEntries& entries, Add add) noexcept {
  const FilmSums sums = to;  // a copy that additions leave alone
  const auto call = [&](std::size_t i, std::int64_t* pixel) {
    add(entries.sample == nullptr ? i : entries.sample[i],
        entries.factor == nullptr ? 1.0F : entries.factor[i], pixel);
  };
  if (entries.tile >= 0) {
    std::int64_t* const tile = sums.tiles[entries.tile] + sums.offset;
    for (std::size_t i = 0; i < entries.count; ++i) {
      if (entries.address[i] < 0) continue;
      call(i, tile + (static_cast<std::size_t>(entries.address[i]) % kFilmTilePixels) * sums.limbs);
    }
    return;
  }
  const auto place = [&sums](std::int32_t address) {
    const auto at = static_cast<std::size_t>(address);
    return sums.tiles[at / kFilmTilePixels] + sums.offset + (at % kFilmTilePixels) * sums.limbs;
  };
  for (std::size_t i = 0; i < entries.count; ++i) {
    if (i + kFilmAhead < entries.count && entries.address[i + kFilmAhead] >= 0) {
      prefetch(place(entries.address[i + kFilmAhead]));
    }
    if (entries.address[i] >= 0) call(i, place(entries.address[i]));
  }
}

void film_add(const FilmSums& to, const FilmGrid& grid, const FilmEntries& entries, const float* quads,
              std::size_t count) noexcept {
  const QuadGrid magic(grid);
  if (entries.tile >= 0 && entries.sample == nullptr && entries.factor == nullptr && count == 1) {
    // As samples come from a renderer's tile: two side by side.
    std::int64_t* const tile = to.tiles[entries.tile] + to.offset;
    const auto place = [tile, limbs = to.limbs](std::int32_t address) {
      return tile + (static_cast<std::size_t>(address) % kFilmTilePixels) * limbs;
    };
    std::size_t i = 0;
    for (; i + 1 < entries.count; i += 2) {
      const std::int32_t first = entries.address[i];
      const std::int32_t second = entries.address[i + 1];
      if ((first | second) >= 0) {
        add_two_quads(place(first), place(second), quads + 4 * i, magic);
        continue;
      }
      if (first >= 0) add_quad(place(first), quad_load(quads + 4 * i), magic);
      if (second >= 0) add_quad(place(second), quad_load(quads + 4 * i + 4), magic);
    }
    if (i < entries.count && entries.address[i] >= 0) {
      add_quad(place(entries.address[i]), quad_load(quads + 4 * i), magic);
    }
    return;
  }
  if (entries.factor == nullptr && count == 1) {
    for_entries(to, entries, [&](std::size_t sample, float, std::int64_t* pixel) {
      add_quad(pixel, quad_load(quads + 4 * sample), magic);
    });
    return;
  }
  for_entries(to, entries, [&](std::size_t sample, float factor, std::int64_t* pixel) {
    const Quad factors = quad_all(factor);
    for (std::size_t q = 0; q < count; ++q) {
      add_quad(pixel + kFilmQuadLimbs * q,
               quad_multiply(quad_load(quads + 4 * (sample * count + q)), factors), magic);
    }
  });
}

void film_add_hits(const FilmSums& to, const FilmGrid& grid, const FilmEntries& entries,
                   const FilmHitRows& hits) noexcept {
  const FilmHitRows rows = hits;
  const Double2 coarse = double2_load(grid.coarse);
  const Double2 rest = double2_load(grid.rest);
  for_entries(to, entries, [&](std::size_t sample, float factor, std::int64_t* pixel) {
    for (std::size_t k = 0; k < rows.count; ++k) {
      const std::size_t at = k * rows.n + sample;
      if (rows.band[at] < 0) continue;
      std::int64_t* const limbs = pixel + kFilmHitLimbs * static_cast<std::size_t>(rows.band[at]);
      const Quad hit = quad_multiply(pair_load(rows.values + 2 * at), quad_all(factor));
      add_pair(limbs, limbs + kFilmHitRest, widen_first(hit), coarse, rest);
    }
  });
}

/// Adds v to a limb, of which `magic` is 1.5 * 2^52 steps. Returns the rest.
inline double add_limb(std::int64_t& limb, double v, double magic) noexcept {
  const double sum = v + magic;
  std::int64_t bits = 0;
  std::int64_t magic_bits = 0;
  std::memcpy(&bits, &sum, sizeof bits);
  std::memcpy(&magic_bits, &magic, sizeof magic_bits);
  limb += bits - magic_bits;
  return v - (sum - magic);
}

void film_add_moments(const FilmSums& to, const FilmMomentGrid& grid, const FilmEntries& entries,
                      const float* quads) noexcept {
  for_entries(to, entries, [&](std::size_t sample, float factor, std::int64_t* pixel) {
    const auto w = static_cast<double>(quads[4 * sample + kFilmQuadWeight] * factor);
    const auto y = static_cast<double>(quads[4 * sample + 1] * factor);
    double left = w == 0.0 ? 0.0 : y * (y / w);
    for (std::size_t k = 0; k < kFilmSquareLimbs; ++k) left = add_limb(pixel[k], left, grid.luminance[k]);
    left = w * w;
    for (std::size_t k = 0; k < kFilmWeightSquareLimbs; ++k) {
      left = add_limb(pixel[kFilmWeightSquare[k]], left, grid.weight[k]);
    }
    ++pixel[kFilmMomentCount];
  });
}

void film_count(const FilmSums& to, const FilmEntries& entries) noexcept {
  for_entries(to, entries, [](std::size_t, float, std::int64_t* pixel) { ++*pixel; });
}

}  // namespace
}  // namespace spectile::kernels
