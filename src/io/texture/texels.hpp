// TexelFormat: what a cached tile holds of a texel, so that filtering its numbers filters spectra.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "src/io/exr/strips.hpp"
#include "src/upsampling/sampled_rows.hpp"

namespace spectile::io {

/// Numbers of a texel.
enum class TexelKind {
  kBands,         ///< a sample for each band; of a single band twice
  kCoefficients,  ///< three coefficients, and a scale or 0
  kWeights,       ///< weights of the seven bases, which mixtures are linear in, and 0
};

struct TexelFormat {
  TexelKind kind = TexelKind::kBands;
  bool linear = true;             ///< samples are linear in a texel's numbers, before any is clamped
  std::size_t floats = 0;         ///< of a texel
  std::vector<PlaneSpec> planes;  ///< that it is made of
  std::array<float, 4> limits{};  ///< largest magnitudes of coefficients; a texel beyond is NaN
  std::vector<float> black;       ///< of a texel beyond a black edge

  static TexelFormat of_bands(std::vector<PlaneSpec> channels);
  /// `channels`: three coefficients, and a scale where there is one.
  static TexelFormat of_coefficients(const Upsampler& upsampler, const rows::SampledRows& rows,
                                     std::vector<PlaneSpec> channels);

  /// Up to kLanesPerBlock texels. Shapes: samples [planes][64], changed; texels [n][floats].
  void pack(const kernels::KernelTable& kernels, float* samples, std::size_t n, float* texels) const;
};

}  // namespace spectile::io
