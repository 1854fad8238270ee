// The sigmoid of a quadratic in one lane, and the search for its coefficients, operation by operation as the
// kernels do it.
#pragma once

#include "kernels/abi.hpp"

namespace spectile::reference {

/// Half the inverse square root of a t from 1 to 2^126: a guess from its bits, then a step of third and one
/// of second order. Within 2.5 * 2^-24 up to 2^124, 3.1 * 2^-24 beyond, where the steps' terms are denormal.
float half_inverse_root(float t) noexcept;

/// The sigmoid's value, and half the inverse root of 1 + x * x, four times whose cube is its slope.
struct SigmoidPoint {
  float sample, root;
};
SigmoidPoint sigmoid_point(const float c[3], float lambda) noexcept;

/// A sample as the kernels write it: limited to [0, 1].
float sigmoid_sample(const float c[3], float lambda) noexcept;

/// Coefficients for one colour; false where none come within 1e-5 of it.
bool sigmoid_coefficients(float c[3], const float rgb[3], const kernels::SigmoidTable& table) noexcept;

/// Coefficients for the part of the line from the colour's grey to the colour that sigmoids have; that part.
float sigmoid_continuation(float c[3], const float rgb[3], const kernels::SigmoidTable& table,
                           const float luminance[3]) noexcept;

// The twins of the kernels of the same names.
void sigmoid_solve(float* const c[3], const float* const rgb[3], const kernels::SigmoidTable& table,
                   std::uint64_t* unsolved, std::size_t n) noexcept;
void sigmoid_continuation(float* const c[3], float* reached, const float* const rgb[3],
                          const kernels::SigmoidTable& table, const float luminance[3],
                          std::size_t n) noexcept;
void sigmoid_blocks(float* dst, const float* const c[3], const float* scale, const float* rows, bool white,
                    std::size_t bands, std::size_t blocks, bool stream) noexcept;
void sigmoid_rows_float(void* const* out, const float* const c[3], const float* scale, const float* rows,
                        bool white, std::size_t bands, std::size_t n) noexcept;
void sigmoid_rows_half(void* const* out, const float* const c[3], const float* scale, const float* rows,
                       bool white, std::size_t bands, std::size_t n) noexcept;
void sigmoid_project(float* const dst[3], const float* const c[3], const float* scale, const float* rows,
                     bool white, const float* weights, std::size_t bands, std::size_t n) noexcept;
void gamut_clip(float* const rgb[3], const float weights[3], float lowest, float highest,
                std::uint64_t* moved, std::size_t n) noexcept;

}  // namespace spectile::reference
