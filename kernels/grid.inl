// Tetrahedral interpolation of the spectra at a grid's nodes: vectors along the bands of one pixel, then
// transposed into lanes.
#pragma once

#include "kernels/abi/upsampling.hpp"
#include "kernels/simd/quad_lanes.hpp"
#include "kernels/smits.inl"

namespace spectile::kernels {
namespace {

// Bands that are mixed before they are transposed: a block of them stays in the first-level cache.
inline constexpr std::size_t kGridBands = 64;
// Floats from pixel to pixel of what is mixed: not a power of two, which would share few sets of the cache.
inline constexpr std::size_t kGridStride = kGridBands + 16;
inline constexpr std::size_t kVectors = kLanes / kWidth;

/// Where a block's pixels lie in the grid: the four nodes around each, in floats from the first, and their
/// weights.
struct GridPlaces {
  alignas(64) std::int32_t node[4][kLanes];
  alignas(64) float weight[4][kLanes];
};

/// A component's cell, and the part of it that lies below the component.
struct GridCell {
  F32 cell, part;
};

inline GridCell cell_of(F32 v, const GridTable& table) noexcept {
  F32 cell(0.0F);
  F32 level(table.levels[0]);
  F32 inverse(table.per_width[0]);
  for (std::int32_t i = 1; i + 1 < table.count; ++i) {
    const Mask above = v >= F32(table.levels[i]);
    cell = xsimd::select(above, F32(static_cast<float>(i)), cell);
    level = xsimd::select(above, F32(table.levels[i]), level);
    inverse = xsimd::select(above, F32(table.per_width[i]), inverse);
  }
  return {cell, (v - level) * inverse};
}

/// `stride`: floats of a node.
inline void place_block(GridPlaces& out, const GridSpectra& spectra, std::size_t at,
                        std::size_t stride) noexcept {
  const GridTable& table = spectra.table;
  const F32 limit(table.homogeneous ? 0.0F : 1.0F);
  const F32 one(1.0F);
  // Places as floats, which hold those of any grid exactly.
  const auto count = static_cast<float>(table.count);
  const auto node_floats = static_cast<float>(stride);
  const F32 step[3] = {F32(count * count * node_floats), F32(count * node_floats), F32(node_floats)};
  const F32 across = (step[0] + step[1]) + step[2];
  for (std::size_t lane = 0; lane < kLanes; lane += kWidth) {
    F32 v[3];
    for (std::size_t k = 0; k < 3; ++k) v[k] = load(spectra.rgb[k] + at + lane);
    const F32 high = xsimd::select(v[0] < v[1], v[1], v[0]);
    const F32 most = xsimd::select(high < v[2], v[2], high);
    const F32 size = xsimd::select(limit < most, most, one);
    GridCell c[3];
    for (std::size_t k = 0; k < 3; ++k) c[k] = cell_of(divide(v[k], size), table);
    const F32 node = (c[0].cell * step[0] + c[1].cell * step[1]) + c[2].cell * step[2];
    // As for Smits mixtures: ties and NaN choose alike everywhere.
    const F32 r = c[0].part;
    const F32 g = c[1].part;
    const F32 b = c[2].part;
    const Mask g_below = g < r;
    const F32 low_rg = xsimd::select(g_below, g, r);
    const F32 high_rg = xsimd::select(g_below, r, g);
    const Mask b_least = b < low_rg;
    const Mask b_most = high_rg < b;
    const F32 least = xsimd::select(b_least, b, low_rg);
    const F32 greatest = xsimd::select(b_most, b, high_rg);
    const F32 capped = xsimd::select(b_most, high_rg, b);
    const F32 middle = xsimd::select(capped < low_rg, low_rg, capped);
    const F32 last_rg = xsimd::select(g_below, step[1], step[0]);
    const F32 first_rg = xsimd::select(g_below, step[0], step[1]);
    const F32 last = xsimd::select(b_least, step[2], last_rg);
    const F32 first = xsimd::select(b_most, step[2], first_rg);
    const F32 nodes[4] = {node, node + first, (node + across) - last, node + across};
    const F32 weights[4] = {one - greatest, greatest - middle, middle - least, least};
    for (std::size_t i = 0; i < 4; ++i) {
      xsimd::to_int(nodes[i]).store_aligned(out.node[i] + lane);
      const F32 weight = weights[i] * size;
      store(out.weight[i] + lane,
            spectra.scale == nullptr ? weight : weight * load(spectra.scale + at + lane));
    }
  }
}

/// Samples of one pixel over `bands` bands, a multiple of 16, from the first of them on.
inline void mix_pixel(float* dst, const GridPlaces& places, std::size_t lane, const float* first,
                      std::size_t bands) noexcept {
  const float* node[4];
  F32 weight[4];
  for (std::size_t i = 0; i < 4; ++i) {
    node[i] = first + places.node[i][lane];
    weight[i] = F32(places.weight[i][lane]);
  }
  for (std::size_t band = 0; band < bands; band += kWidth) {
    F32 sum = weight[0] * load(node[0] + band) + weight[1] * load(node[1] + band);
    for (std::size_t i = 2; i < 4; ++i) sum = sum + weight[i] * load(node[i] + band);
    store(dst + band, sum);
  }
}

/// Calls put(band, samples) for every band, with the kVectors vectors of a block's pixels.
template <class Put>
inline void grid_block(const GridSpectra& spectra, std::size_t at, Put put) noexcept {
  const GridTable& table = spectra.table;
  GridPlaces places;
  place_block(places, spectra, at, table.stride);
  const F32 lowest(table.lowest);
  alignas(64) float mixed[kLanes * kGridStride];
  for (std::size_t first = 0; first < table.bands; first += kGridBands) {
    const std::size_t left = table.stride - first;
    const std::size_t bands = left < kGridBands ? left : kGridBands;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      mix_pixel(mixed + lane * kGridStride, places, lane, table.nodes + first, bands);
    }
    const std::size_t rest = table.bands - first;
    const std::size_t used = rest < bands ? rest : bands;
    for (std::size_t band = 0; band < used; band += 4) {
      F32 samples[4][kVectors];
      for (std::size_t j = 0; j < kVectors; ++j) {
        F32 quads[4];
        quads_to_lanes(mixed + j * kWidth * kGridStride + band, kGridStride, quads);
        for (std::size_t i = 0; i < 4; ++i) samples[i][j] = max(lowest, quads[i]);
      }
      for (std::size_t i = 0; i < 4 && band + i < used; ++i) put(first + band + i, samples[i]);
    }
  }
}

void grid_blocks(float* dst, const GridSpectra& spectra, std::size_t blocks, bool non_temporal) noexcept {
  const GridSpectra s = spectra;  // a copy that stores through dst leave alone
  for (std::size_t block = 0; block < blocks; ++block, dst += s.table.bands * kLanes) {
    if (non_temporal) {
      grid_block(s, block * kLanes, [dst](std::size_t band, const F32* samples) {
        for (std::size_t j = 0; j < kVectors; ++j) stream(dst + band * kLanes + j * kWidth, samples[j]);
      });
    } else {
      grid_block(s, block * kLanes, [dst](std::size_t band, const F32* samples) {
        for (std::size_t j = 0; j < kVectors; ++j) store(dst + band * kLanes + j * kWidth, samples[j]);
      });
    }
  }
  if (non_temporal) stream_fence();
}

template <class Sample>
inline void grid_rows(void* const* rows, const GridSpectra& spectra, std::size_t n) noexcept {
  const GridSpectra s = spectra;
  const std::size_t whole = n / kLanes * kLanes;
  for (std::size_t at = 0; at < whole; at += kLanes) {
    grid_block(s, at, [rows, at](std::size_t band, const F32* samples) {
      for (std::size_t j = 0; j < kVectors; ++j)
        put_sample(static_cast<Sample*>(rows[band]) + at + j * kWidth, samples[j]);
    });
  }
  if (whole == n) return;
  // The rest of the row goes through a small buffer: what follows a row's end is not ours.
  grid_block(s, whole, [rows, whole, n](std::size_t band, const F32* samples) {
    alignas(64) Sample tail[kLanes];
    for (std::size_t j = 0; j < kVectors; ++j) put_sample(tail + j * kWidth, samples[j]);
    std::memcpy(static_cast<Sample*>(rows[band]) + whole, tail, (n - whole) * sizeof(Sample));
  });
}

void grid_rows_float(void* const* rows, const GridSpectra& spectra, std::size_t n) noexcept {
  grid_rows<float>(rows, spectra, n);
}

void grid_rows_half(void* const* rows, const GridSpectra& spectra, std::size_t n) noexcept {
  grid_rows<std::uint16_t>(rows, spectra, n);
}

void grid_fold(float* const dst[3], const GridSpectra& spectra, std::size_t n) noexcept {
  const GridSpectra s = spectra;
  GridPlaces places;
  for (std::size_t at = 0; at < n; at += kLanes) {
    place_block(places, s, at, kGridColor);
    for (std::size_t lane = 0; lane < kLanes; lane += kWidth) {
      F32 out[4];
      for (std::size_t i = 0; i < 4; ++i) {
        // Pixels i, i + 4, ... as quads of colours.
        const auto term = [&](std::size_t k) {
          return strided_spread(places.weight[k] + lane + i) *
                 strided_quads(s.table.nodes, places.node[k] + lane + i);
        };
        out[i] = ((term(0) + term(1)) + term(2)) + term(3);
      }
      transpose_quads(out);
      for (std::size_t k = 0; k < 3; ++k) store(dst[k] + at + lane, out[k]);
    }
  }
}

}  // namespace
}  // namespace spectile::kernels
