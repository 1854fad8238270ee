// TexelFormat: what a cached tile holds of a texel, so that filtering its numbers filters spectra.
#include "src/io/texture/texels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/stages/band_filter.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile::io {

TexelFormat TexelFormat::of_bands(std::vector<PlaneSpec> channels) {
  TexelFormat out;
  out.planes = std::move(channels);
  out.floats = std::max<std::size_t>(out.planes.size(), 2);
  out.black.assign(out.floats, 0.0F);
  return out;
}

TexelFormat TexelFormat::of_coefficients(const Upsampler& upsampler, const rows::SampledRows& rows,
                                         std::vector<PlaneSpec> channels) {
  TexelFormat out;
  out.linear = rows::mixes_bases(upsampler) && rows.linear(false);
  const bool weights = out.linear && !linear_in_coefficients(upsampler);
  out.kind = weights ? TexelKind::kWeights : TexelKind::kCoefficients;
  out.floats = weights ? kernels::kSmitsRow : 4;
  out.planes = std::move(channels);
  out.limits = rows.limits();
  out.black.assign(out.floats, 0.0F);
  if (!weights) std::copy_n(rows.black().begin(), out.planes.size(), out.black.begin());
  return out;
}

void TexelFormat::pack(const kernels::KernelTable& kernels, float* samples, std::size_t n,
                       float* texels) const {
  if (kind == TexelKind::kBands) {
    kernels.blocks_to_rows(texels, floats, samples, planes.size(), n);
    for (std::size_t i = 0; i < n && planes.size() == 1; ++i) texels[2 * i + 1] = texels[2 * i];
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    bool bad = false;
    for (std::size_t k = 0; k < planes.size(); ++k)
      bad = bad || !(std::fabs(samples[k * kLanesPerBlock + i]) <= limits[k]);
    for (std::size_t k = 0; k < planes.size() && bad; ++k)
      samples[k * kLanesPerBlock + i] = std::numeric_limits<float>::quiet_NaN();
  }
  alignas(64) float numbers[kernels::kSmitsRow * kLanesPerBlock] = {};
  if (kind == TexelKind::kCoefficients) {
    std::copy_n(samples, planes.size() * kLanesPerBlock, numbers);
  } else {
    const float* const rgb[3] = {samples, samples + kLanesPerBlock, samples + 2 * kLanesPerBlock};
    float* weights[7];
    for (std::size_t k = 0; k < 7; ++k) weights[k] = numbers + k * kLanesPerBlock;
    rows::basis_weights(rgb, n, weights);
  }
  kernels.blocks_to_rows(texels, floats, numbers, floats, n);
}

}  // namespace spectile::io
