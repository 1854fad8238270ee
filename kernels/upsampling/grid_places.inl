// Places of colours in a grid of spectra: the four nodes around each, and their weights.
#pragma once

#include "kernels/abi/upsampling.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

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

}  // namespace
}  // namespace spectile::kernels
