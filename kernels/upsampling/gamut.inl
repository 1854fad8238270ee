// Colours outside a cube moved onto it along the line to their grey.
#pragma once

#include "kernels/abi/color.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

void gamut_clip(float* const rgb[3], const float weights[3], float lowest, float highest,
                std::uint64_t* moved, std::size_t n) noexcept {
  const F32 low(lowest);
  const F32 high(highest);
  const F32 one(1.0F);
  for (std::size_t block = 0; block < n / kLanes; ++block) {
    std::uint64_t outside_lanes = 0;
    for (std::size_t lane = 0; lane < kLanes; lane += kWidth) {
      const std::size_t at = block * kLanes + lane;
      F32 v[3];
      for (std::size_t k = 0; k < 3; ++k) v[k] = load(rgb[k] + at);
      const F32 zero(0.0F);
      const Mask finite = (v[0] - v[0] == zero) & (v[1] - v[1] == zero) & (v[2] - v[2] == zero);
      const Mask outside = finite & ((v[0] < low) | (v[1] < low) | (v[2] < low) | (high < v[0]) |
                                     (high < v[1]) | (high < v[2]));
      const std::uint64_t bits = lane_bits(outside);
      if (bits == 0) continue;
      outside_lanes |= bits << lane;
      const F32 sum = (F32(weights[0]) * v[0] + F32(weights[1]) * v[1]) + F32(weights[2]) * v[2];
      const F32 y = min(high, max(low, sum));
      F32 part = one;
      for (const F32& value : v) {
        // The part of the way from grey at which this component reaches the side that it is beyond.
        const F32 to_low = divide(y - low, y - value);
        const F32 to_high = divide(high - y, value - y);
        const F32 allowed = xsimd::select(value < low, to_low, xsimd::select(high < value, to_high, one));
        part = xsimd::select(allowed < part, allowed, part);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const F32 inside = min(high, max(low, y + part * (v[k] - y)));
        store(rgb[k] + at, xsimd::select(outside, inside, v[k]));
      }
    }
    moved[block] = outside_lanes;
  }
}

}  // namespace
}  // namespace spectile::kernels
