// The sigmoid at one wavelength.
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

/// The functions of a quadratic at one wavelength.
struct Quadratic {
  F32 q;
  Quadratic() = default;
  explicit Quadratic(const float* row) noexcept : q(row[kSigmoidQ]) {}
  F32 argument(const Coefficients& a) const noexcept { return fused(fused(a.c[0], q, a.c[1]), q, a.c[2]); }
};

/// Two functions at one wavelength.
struct Functions {
  F32 p, q;
  Functions() = default;
  explicit Functions(const float* row) noexcept : p(row[kSigmoidP]), q(row[kSigmoidQ]) {}
  F32 argument(const Coefficients& a) const noexcept { return fused(a.c[0], p, fused(a.c[1], q, a.c[2])); }
};

/// Calls body with the form's functions.
template <class Body>
inline void with_form(SigmoidForm form, Body body) noexcept {
  if (form == SigmoidForm::kFunctions) {
    body(Functions());
  } else {
    body(Quadratic());
  }
}

template <class Form>
inline SigmoidPoint sigmoid_point(const Coefficients& a, const Form& at) noexcept {
  const F32 x = at.argument(a);
  const F32 root = half_inverse_root(fused(x, x, F32(1.0F)));
  return {fused(x, root, F32(0.5F)), root};
}

template <class Form>
inline F32 sigmoid_sample(const Coefficients& a, const Form& at) noexcept {
  return min(F32(1.0F), max(F32(0.0F), sigmoid_point(a, at).sample));
}

}  // namespace
}  // namespace spectile::kernels
