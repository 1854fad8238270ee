// Element-wise arithmetic, folds of a batch over its bands, and loops that reach the machine's peak rates.
#pragma once

#include "kernels/abi/lanes.hpp"

namespace spectile::kernels {

/// Floats in the chains of a peak loop: a multiple of 24 vectors, whatever their width.
inline constexpr std::size_t kPeakChains = 384;

struct ArithmeticKernels {
  // dst[i] = ..., for n floats.
  void (*add)(float* dst, const float* a, const float* b, std::size_t n) noexcept;       ///< a + b
  void (*subtract)(float* dst, const float* a, const float* b, std::size_t n) noexcept;  ///< a - b
  void (*multiply)(float* dst, const float* a, const float* b, std::size_t n) noexcept;  ///< a * b
  void (*divide)(float* dst, const float* a, const float* b, std::size_t n) noexcept;    ///< a / b
  /// b == 0 ? 0 : a / b; b NaN: NaN
  void (*divide_or_zero)(float* dst, const float* a, const float* b, std::size_t n) noexcept;
  void (*negate)(float* dst, const float* a, std::size_t n) noexcept;          ///< sign bit flipped, NaN too
  void (*complement)(float* dst, const float* a, std::size_t n) noexcept;      ///< 1 - a
  void (*scale)(float* dst, const float* a, float s, std::size_t n) noexcept;  ///< a * s
  /// (a * b) + c, two roundings
  void (*multiply_add)(float* dst, const float* a, const float* b, const float* c, std::size_t n) noexcept;
  /// ((1 - t) * a) + (t * b), 1 - t rounded once
  void (*lerp)(float* dst, const float* a, const float* b, float t, std::size_t n) noexcept;
  void (*sqrt)(float* dst, const float* a, std::size_t n) noexcept;  ///< correctly rounded; a < 0: NaN
  /// e^a in double, rounded once: within 0.501 ULP, denormals included; infinity beyond the range, 0 below it
  void (*exp)(float* dst, const float* a, std::size_t n) noexcept;
  /// a^y, likewise; zeros, infinities, NaN and a < 0 as C17 F.10.4.4
  void (*pow)(float* dst, const float* a, float y, std::size_t n) noexcept;
  /// a < lo ? lo : (hi < a ? hi : a); NaN stays
  void (*clamp)(float* dst, const float* a, float lo, float hi, std::size_t n) noexcept;

  // A batch [blocks][bands][kLanes] with one number a lane, f and t [blocks][kLanes], or one a band, s
  // [bands].
  /// a * f
  void (*scale_lanes)(float* dst, const float* a, const float* f, std::size_t bands,
                      std::size_t blocks) noexcept;
  /// a * s
  void (*scale_bands)(float* dst, const float* a, const float* s, std::size_t bands,
                      std::size_t blocks) noexcept;
  /// (a * f) + c, two roundings
  void (*multiply_add_lanes)(float* dst, const float* a, const float* f, const float* c, std::size_t bands,
                             std::size_t blocks) noexcept;
  /// ((1 - t) * a) + (t * b), 1 - t rounded once
  void (*lerp_lanes)(float* dst, const float* a, const float* b, const float* t, std::size_t bands,
                     std::size_t blocks) noexcept;
  /// e^-(a * t) by the product in two parts, the upper halves' exact one and the rest, and a series in float:
  /// within 1.1 ULP on the whole range, denormals included. 0 * infinity: NaN
  void (*transmittance)(float* dst, const float* a, const float* t, std::size_t bands,
                        std::size_t blocks) noexcept;

  /// A bounce and Russian roulette: p = a * f, m = largest p, NaN ignored
  /// by = m < density ? m : density; by >= 2^-126 and u * density < m: p * (1 / by); else 0, and the lane's
  /// bit of `ended`. u null: density >= 2^-126 ? p * (1 / density) : 0, no bit
  void (*update_throughput)(float* dst, std::uint64_t* ended, const float* a, const float* f,
                            const float* density, const float* u, std::size_t bands,
                            std::size_t blocks) noexcept;

  // One number a lane over the bands of a batch [blocks][bands][kLanes]; dst [blocks][kLanes].
  /// smallest sample; NaN ignored; all NaN: +infinity
  void (*minimum)(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
  /// largest sample; NaN ignored; all NaN: -infinity
  void (*maximum)(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;

  // One bit a lane: bit i of mask[block].
  /// all samples +0 or -0; a denormal is not 0
  void (*black_mask)(std::uint64_t* mask, const float* spectra, std::size_t bands,
                     std::size_t blocks) noexcept;
  /// any sample NaN
  void (*nan_mask)(std::uint64_t* mask, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
  /// a == b in every band; NaN equals nothing, +0 equals -0
  void (*equal_mask)(std::uint64_t* mask, const float* a, const float* b, std::size_t bands,
                     std::size_t blocks) noexcept;

  // Peak rates of the machine.
  /// dst[i] = bits(src[i]) xor bits(src[i + kLanes]) xor ...; dst [kLanes]
  void (*peak_load)(std::uint32_t* dst, const float* src, std::size_t n) noexcept;
  void (*peak_store)(float* dst, float value, std::size_t n, bool non_temporal) noexcept;  ///< value
  void (*peak_copy)(float* dst, const float* src, std::size_t n) noexcept;                 ///< src
  // Chains from x = src; n a multiple of kPeakChains.
  /// `steps` times x = (x * m) + a, two roundings
  void (*peak_multiply_add)(float* dst, const float* src, float m, float a, std::size_t steps,
                            std::size_t n) noexcept;
  /// `steps` times x = fma(x, m, a)
  void (*peak_fused)(float* dst, const float* src, float m, float a, std::size_t steps,
                     std::size_t n) noexcept;
  /// `steps` times x = m / x
  void (*peak_divide)(float* dst, const float* src, float m, std::size_t steps, std::size_t n) noexcept;
};

}  // namespace spectile::kernels
