// Weights of a colour's Smits mixture.
#pragma once

#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

/// The mixtures of one vector of pixels: three weights, and the secondary and primary that two of them go to.
struct MixtureWeights {
  F32 white, second, first;
  I32 second_basis, first_basis;
};

inline MixtureWeights mixture_weights(F32 r, F32 g, F32 b) noexcept {
  // Ordered comparisons with the operands that the reference uses, so that ties and NaN choose alike.
  const F32 low_rg = xsimd::select(g < r, g, r);
  const F32 high_rg = xsimd::select(g < r, r, g);
  const F32 least = xsimd::select(b < low_rg, b, low_rg);
  const F32 most = xsimd::select(high_rg < b, b, high_rg);
  const F32 capped = xsimd::select(high_rg < b, high_rg, b);
  const F32 middle = xsimd::select(capped < low_rg, low_rg, capped);

  const F32 rg_second = xsimd::select(g < r, F32(2.0F), F32(1.0F));
  const F32 rg_first = xsimd::select(g < r, F32(4.0F), F32(5.0F));
  const F32 second = xsimd::select(b < low_rg, F32(3.0F), rg_second);
  const F32 first = xsimd::select(high_rg < b, F32(6.0F), rg_first);
  return {least, middle - least, most - middle, xsimd::to_int(second), xsimd::to_int(first)};
}

}  // namespace
}  // namespace spectile::kernels
