// Projection of spectra, transforms and gamut of colours, and conversion between half and float.
#pragma once

#include "kernels/abi/lanes.hpp"

namespace spectile::kernels {

/// Counts over a row of RGB, as filled in by scan_rgb; counts are of pixels.
struct RgbScan {
  std::uint64_t nonfinite = 0;  ///< any component NaN or infinite
  std::uint64_t negative = 0;   ///< any component below 0
  std::uint64_t over_one = 0;   ///< any component above 1
  float maximum = 0;            ///< largest component above 0; NaN ignored
};

struct ColorKernels {
  // Projection of a batch [blocks][bands][kLanes]; results [blocks][kLanes].
  /// y = sum(bands) weights[band] * sample; weights [bands]
  void (*weighted_sum)(float* y, const float* spectra, const float* weights, std::size_t bands,
                       std::size_t blocks) noexcept;
  /// dst[k] = sum(bands) weights[band][k] * sample; weights [bands][4], the last unused
  void (*project)(float* const dst[3], const float* spectra, const float* weights, std::size_t bands,
                  std::size_t blocks) noexcept;

  // Colours, three planes of n.
  /// dst[i] = ((m[3i] * a0) + (m[3i+1] * a1)) + (m[3i+2] * a2)
  void (*transform3)(float* const dst[3], const float* const src[3], const float m[9],
                     std::size_t n) noexcept;
  /// y = clamp(((w0 * r) + (w1 * g)) + (w2 * b), lowest, highest)
  /// a component outside [lowest, highest]: c = y + part * (c - y), part: the largest that is inside
  /// all inside, or one NaN or infinite: as they are; moved[i / kLanes], bit i: true if outside
  void (*gamut_clip)(float* const rgb[3], const float weights[3], float lowest, float highest,
                     std::uint64_t* moved, std::size_t n) noexcept;
  /// adds a row's counts to *scan
  void (*scan_rgb)(RgbScan* scan, const float* const rgb[3], std::size_t n) noexcept;

  // Conversion of n numbers; any alignment.
  /// exact; NaN made quiet
  void (*half_to_float)(float* dst, const std::uint16_t* src, std::size_t n) noexcept;
  /// nearest, ties to even; beyond the range infinity; NaN made quiet
  void (*float_to_half)(std::uint16_t* dst, const float* src, std::size_t n) noexcept;

  // Batches from and to rows of one lane each, `count` numbers from rows + lane * stride on; any n, any
  // alignment of rows; the last block is whole.
  /// dst[block][k][lane] = rows[lane][k], 0 beyond the n lanes; dst not rows
  void (*rows_to_blocks)(float* dst, const float* rows, std::size_t stride, std::size_t count,
                         std::size_t n) noexcept;
  /// rows[lane][k] = src[block][k][lane]; numbers of rows beyond `count` stay
  void (*blocks_to_rows)(float* rows, std::size_t stride, const float* src, std::size_t count,
                         std::size_t n) noexcept;
};

}  // namespace spectile::kernels
