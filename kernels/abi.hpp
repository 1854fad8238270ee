// KernelTable: every hot operation as a noexcept function over raw pointers, each with its formula.
//
// Rules common to all:
//  - Float arrays are 64-byte aligned. A count `n` of floats is a multiple of kLanes. A batch of spectra is
//    [blocks][bands][kLanes].
//  - `dst` may be the same array as a source, never a shifted overlap of it.
//  - Formulas are evaluated as written: one rounding per operation, no contraction, sums in ascending order
//  of the
//    band. Therefore every table gives the same bits.
//  - NaN goes through arithmetic as IEEE 754 says (its payload is not specified).
#pragma once

#include <cstddef>
#include <cstdint>

namespace spectile::kernels {

/// Lanes of a block, the unit in which every kernel works.
inline constexpr std::size_t kLanes = 64;

/// Floats of one band's row in a Smits table: white, cyan, magenta, yellow, red, green, blue, 0.
inline constexpr std::size_t kSmitsRow = 8;

/// Largest finite half; rows of halves are limited to it, so that a finite sample stays finite.
inline constexpr float kHalfMax = 65504.0F;

/// Counts over a row of RGB, as filled in by scan_rgb; counts are of pixels.
struct RgbScan {
  std::uint64_t nonfinite = 0;  ///< any component NaN or infinite
  std::uint64_t negative = 0;   ///< any component below 0
  std::uint64_t over_one = 0;   ///< any component above 1
  float maximum = 0;            ///< largest component above 0; NaN passed over
};

/// One instruction set's kernels.
struct KernelTable {
  const char* name;
  int lanes;  ///< float lanes of a vector register; 1 for the reference

  // Element-wise arithmetic on n floats.
  void (*add)(float* dst, const float* a, const float* b, std::size_t n) noexcept;       ///< a + b
  void (*subtract)(float* dst, const float* a, const float* b, std::size_t n) noexcept;  ///< a - b
  void (*multiply)(float* dst, const float* a, const float* b, std::size_t n) noexcept;  ///< a * b
  void (*divide)(float* dst, const float* a, const float* b, std::size_t n) noexcept;    ///< a / b
  /// b == 0 ? 0 : a / b (a NaN divisor gives NaN)
  void (*divide_or_zero)(float* dst, const float* a, const float* b, std::size_t n) noexcept;
  void (*negate)(float* dst, const float* a, std::size_t n) noexcept;  ///< a with its sign bit flipped
  void (*scale)(float* dst, const float* a, float s, std::size_t n) noexcept;  ///< a * s
  /// (a * b) + c, two roundings
  void (*multiply_add)(float* dst, const float* a, const float* b, const float* c, std::size_t n) noexcept;
  /// ((1 - t) * a) + (t * b), with 1 - t rounded once
  void (*lerp)(float* dst, const float* a, const float* b, float t, std::size_t n) noexcept;
  void (*sqrt)(float* dst, const float* a, std::size_t n) noexcept;  ///< correctly rounded; below 0 gives NaN
  /// e to the a, computed in double and rounded once: error below 0.501 ULP on the whole range, denormals
  /// included
  void (*exp)(float* dst, const float* a, std::size_t n) noexcept;
  /// a to the power y as C's pow defines it, special values included: error below 0.501 ULP
  void (*pow)(float* dst, const float* a, float y, std::size_t n) noexcept;
  /// a < lo ? lo : (hi < a ? hi : a); NaN stays
  void (*clamp)(float* dst, const float* a, float lo, float hi, std::size_t n) noexcept;

  // Per lane over the bands of a batch; dst [blocks][kLanes].
  /// least sample; NaN passed over, a lane of nothing but NaN gives +infinity
  void (*minimum)(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
  /// greatest sample; NaN passed over, a lane of nothing but NaN gives -infinity
  void (*maximum)(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
  /// bit i of mask[block]: every sample of lane i is +0 or -0
  void (*black_mask)(std::uint64_t* mask, const float* spectra, std::size_t bands,
                     std::size_t blocks) noexcept;
  /// bit i of mask[block]: some sample of lane i is NaN
  void (*nan_mask)(std::uint64_t* mask, const float* spectra, std::size_t bands, std::size_t blocks) noexcept;
  /// bit i of mask[block]: a == b in every band of lane i (NaN equals nothing, +0 equals -0)
  void (*equal_mask)(std::uint64_t* mask, const float* a, const float* b, std::size_t bands,
                     std::size_t blocks) noexcept;

  // Colorimetry.
  /// y = sum over bands of weights[band] * sample; weights [bands]; y [blocks][kLanes]
  void (*weighted_sum)(float* y, const float* spectra, const float* weights, std::size_t bands,
                       std::size_t blocks) noexcept;
  /// three such sums; weights [bands][4] (x, y, z, unused); x, y, z [blocks][kLanes]
  void (*project)(float* x, float* y, float* z, const float* spectra, const float* weights, std::size_t bands,
                  std::size_t blocks) noexcept;
  /// dst_i = ((m[3i] * a0) + (m[3i+1] * a1)) + (m[3i+2] * a2)
  void (*transform3)(float* const dst[3], const float* const src[3], const float m[9],
                     std::size_t n) noexcept;

  // Smits upsampling. With w0 = least of r, g, b, w1 = middle - least, w2 = greatest - middle, and the
  // secondary s (cyan where r is least, else magenta where g is, else yellow) and the primary p (red where r
  // is greatest, else green where g is, else blue): sample = ((w0 * white) + (w1 * basis_s)) + (w2 *
  // basis_p), then limited from below: sample < lowest ? lowest : sample. table [bands][kSmitsRow], 32-byte
  // aligned.
  /// dst [blocks][bands][kLanes]; with `stream`, stores that go round the caches
  void (*smits_blocks)(float* dst, const float* const rgb[3], const float* table, float lowest,
                       std::size_t bands, std::size_t blocks, bool stream) noexcept;
  /// rows[band] takes n floats, at any address, for any n; rgb readable up to n rounded up to kLanes
  void (*smits_rows_float)(void* const* rows, const float* const rgb[3], const float* table, float lowest,
                           std::size_t bands, std::size_t n) noexcept;
  /// the same in halves: limited to kHalfMax from above and rounded to nearest even
  void (*smits_rows_half)(void* const* rows, const float* const rgb[3], const float* table, float lowest,
                          std::size_t bands, std::size_t n) noexcept;

  // Conversion. Sources and targets of any alignment, n a multiple of kLanes.
  void (*half_to_float)(float* dst, const std::uint16_t* src,
                        std::size_t n) noexcept;  ///< exact; NaN made quiet
  void (*float_to_half)(std::uint16_t* dst, const float* src,
                        std::size_t n) noexcept;  ///< nearest even; NaN quiet
  /// adds a row's counts to *scan
  void (*scan_rgb)(RgbScan* scan, const float* const rgb[3], std::size_t n) noexcept;
};

}  // namespace spectile::kernels
