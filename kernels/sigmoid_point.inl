// The sigmoid of a quadratic at one wavelength.
#pragma once

#include "kernels/sigmoid_constants.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

/// Half the inverse square root of t.
inline F32 half_inverse_root(F32 t) noexcept {
  const F32 y0 = bits_as<float>(U32(kRootGuess) - (bits_as<std::uint32_t>(t) >> 1));
  const F32 f = (y0 * y0) * t;
  const F32 y1 = y0 * fused(f, f - F32(kRootSecond), F32(kRootFirst));
  return y1 * fused_minus(y1 * y1, t, F32(kRootThird));
}

/// Three coefficients of a vector of lanes.
struct Coefficients {
  F32 c[3];
};

struct SigmoidPoint {
  F32 sample, root;
};

inline SigmoidPoint sigmoid_point(const Coefficients& a, F32 lambda) noexcept {
  const F32 x = fused(fused(a.c[0], lambda, a.c[1]), lambda, a.c[2]);
  const F32 root = half_inverse_root(fused(x, x, F32(1.0F)));
  return {fused(x, root, F32(0.5F)), root};
}

inline F32 sigmoid_sample(const Coefficients& a, F32 lambda) noexcept {
  return min(F32(1.0F), max(F32(0.0F), sigmoid_point(a, lambda).sample));
}

}  // namespace
}  // namespace spectile::kernels
