// Tetrahedral interpolation of the spectra at a grid's nodes: vectors along the bands of one pixel, then
// transposed into lanes.
#pragma once

#include "kernels/abi/upsampling.hpp"
#include "kernels/simd/quad_lanes.hpp"
#include "kernels/upsampling/grid_places.inl"
#include "kernels/upsampling/smits.inl"

namespace spectile::kernels {
namespace {

// Pixels and bands that are mixed before they are transposed, which stay in the first-level cache: lanes of a
// line of it, which non-temporal stores fill at once.
inline constexpr std::size_t kGridPixels = 16;
inline constexpr std::size_t kGridBands = 64;

/// Samples of kGridPixels pixels over `bands` bands, a multiple of 16, from the first of them on: kBands,
/// unless that is 0.
template <std::size_t kBands>
inline void mix_pixels(float* dst, const GridPlaces& places, std::size_t lane, const float* first,
                       std::size_t bands) noexcept {
  const std::size_t count = kBands == 0 ? bands : kBands;
  for (std::size_t i = 0; i < kGridPixels; ++i, ++lane, dst += kGridBands) {
    const float* const n0 = first + places.node[0][lane];
    const float* const n1 = first + places.node[1][lane];
    const float* const n2 = first + places.node[2][lane];
    const float* const n3 = first + places.node[3][lane];
    const F32 w0(places.weight[0][lane]);
    const F32 w1(places.weight[1][lane]);
    const F32 w2(places.weight[2][lane]);
    const F32 w3(places.weight[3][lane]);
    for (std::size_t band = 0; band < count; band += kWidth) {
      store(dst + band,
            ((w0 * load(n0 + band) + w1 * load(n1 + band)) + w2 * load(n2 + band)) + w3 * load(n3 + band));
    }
  }
}

/// Calls put(band, lane, sample) for every band and vector of lanes of a block, of the first `used` lanes.
template <class Put>
inline void mix_block(const GridTable& table, const GridPlaces& places, std::size_t used, Put put) noexcept {
  const F32 lowest(table.lowest);
  alignas(64) float mixed[kGridPixels * kGridBands];
  for (std::size_t first = 0; first < table.bands; first += kGridBands) {
    const std::size_t left = table.stride - first;
    const std::size_t bands = left < kGridBands ? left : kGridBands;
    const std::size_t count = table.bands - first < bands ? table.bands - first : bands;
    for (std::size_t lane = 0; lane < used; lane += kGridPixels) {
      const float* const nodes = table.nodes + first;
      if (bands == kGridBands) {
        mix_pixels<kGridBands>(mixed, places, lane, nodes, bands);
      } else {
        mix_pixels<0>(mixed, places, lane, nodes, bands);
      }
      for (std::size_t band = 0; band < count; band += kWidth) {
        for (std::size_t group = 0; group < kGridPixels; group += kWidth) {
          F32 v[kWidth];
          for (std::size_t i = 0; i < kWidth; ++i) v[i] = load(mixed + (group + i) * kGridBands + band);
          transpose_rows(v);
#pragma GCC unroll 16
          for (std::size_t i = 0; i < kWidth; ++i) {
            if (band + i < count) put(first + band + i, lane + group, max(lowest, v[i]));
          }
        }
      }
    }
  }
}

/// Calls put(block, band, lane, sample) for n lanes, in blocks of which the last may be a part.
template <class Put>
inline void grid_lanes(const GridSpectra& spectra, std::size_t n, Put put) noexcept {
  const GridSpectra s = spectra;  // a copy that stores through `put` leave alone
  GridPlaces places;
  for (std::size_t at = 0; at < n; at += kLanes) {
    place_block(places, s, at, s.table.stride);
    const std::size_t used = n - at < kLanes ? n - at : kLanes;
    mix_block(s.table, places, used,
              [at, put](std::size_t band, std::size_t lane, F32 v) { put(at / kLanes, band, lane, v); });
  }
}

void grid_blocks(float* dst, const GridSpectra& spectra, std::size_t blocks, bool non_temporal) noexcept {
  const std::size_t bands = spectra.table.bands;
  const auto place = [=](std::size_t block, std::size_t band, std::size_t lane) {
    return dst + (block * bands + band) * kLanes + lane;
  };
  if (non_temporal) {
    grid_lanes(spectra, blocks * kLanes, [=](std::size_t block, std::size_t band, std::size_t lane, F32 v) {
      stream(place(block, band, lane), v);
    });
    stream_fence();
  } else {
    grid_lanes(spectra, blocks * kLanes, [=](std::size_t block, std::size_t band, std::size_t lane, F32 v) {
      store(place(block, band, lane), v);
    });
  }
}

template <class Sample>
inline void grid_rows(void* const* rows, const GridSpectra& spectra, std::size_t n) noexcept {
  grid_lanes(spectra, n, [=](std::size_t block, std::size_t band, std::size_t lane, F32 v) {
    const std::size_t at = block * kLanes + lane;
    Sample* const row = static_cast<Sample*>(rows[band]);
    if (at + kWidth <= n) {
      put_sample(row + at, v);
    } else if (at < n) {
      // The rest of the row goes through a small buffer: what follows a row's end is not ours.
      alignas(64) Sample tail[kWidth];
      put_sample(tail, v);
      std::memcpy(row + at, tail, (n - at) * sizeof(Sample));
    }
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
