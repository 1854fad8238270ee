// The sigmoid in one lane, and the search for its coefficients, operation by operation as the
// kernels do it.
#pragma once

#include "kernels/abi/upsampling.hpp"

namespace spectile::reference {

/// Half the inverse square root of a t from 1 to 2^126: a guess from its bits, then a step of third and one
/// of second order. Within 2.5 * 2^-24 up to 2^124, 3.1 * 2^-24 beyond, where the steps' terms are denormal.
float half_inverse_root(float t) noexcept;

/// The sigmoid's value, and half the inverse root of 1 + x * x, four times whose cube is its slope.
struct SigmoidPoint {
  float sample, root;
};
SigmoidPoint sigmoid_point(float x) noexcept;

/// x of the form, of coefficients and the functions at one wavelength.
float sigmoid_argument(kernels::SigmoidForm form, const float c[3], float p, float q) noexcept;
/// The same of a band's row.
float sigmoid_argument(kernels::SigmoidForm form, const float c[3], const float* row) noexcept;

/// A sample as the kernels write it: clamped to [0, 1].
float sigmoid_sample(float x) noexcept;

/// Coefficients for one colour; false where none come within 1e-5 of it.
bool sigmoid_coefficients(float c[3], const float rgb[3], const kernels::SigmoidTable& table) noexcept;

/// Continuation toward the grey axis: coefficients for the part of the line from the colour's grey to the
/// colour that sigmoids cover, and that part.
float sigmoid_continuation(float c[3], const float rgb[3], const kernels::SigmoidTable& table,
                           const float luminance[3]) noexcept;

}  // namespace spectile::reference
