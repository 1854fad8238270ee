// Samples at lanes' own wavelengths of lanes whose coefficients, or weights of bases, are known.
#include "src/upsampling/own_wavelengths/samples_at.hpp"

#include "src/lanes/sampler_run.hpp"
#include "src/upsampling/own_wavelengths/wavelength_tables.hpp"

namespace spectile::rows {

void samples_at(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const c[3],
                const float* scale, const SampledSpectraView& lambda_nm, const SampledSpectraSpan& out) {
  const WavelengthTables& tables = UpsamplerAccess::at_wavelengths(upsampler);
  const std::size_t count = out.axis.count();
  if (mixes_bases(upsampler)) {
    kernels.mixtures_at(out.data, c, {tables.ends.data(), upsampler.lowest()}, tables.centres, lambda_nm.data,
                        count, out.blocks());
    return;
  }
  if (stores_rgb(upsampler)) {
    kernels.grid_at(out.data, grid_spectra(upsampler, c, scale), tables.centres, lambda_nm.data, count,
                    out.blocks());
    return;
  }
  kernels::SigmoidLanes sigmoids = tables.sigmoid;
  sigmoids.c = c;
  if (!tables.white) {
    sigmoids.scale = scale;
    kernels.sigmoids_at(out.data, sigmoids, lambda_nm.data, count, out.blocks());
    return;
  }
  // In the order of the batches on bands: the sample, times the white, times the scale.
  // The white first: the samples may be written over the wavelengths.
  alignas(64) float whites[SpectralAxis::kMaxWavelengths * kLanesPerBlock];
  for (std::size_t block = 0; block < out.blocks(); ++block) {
    float* const to = out.row(block, 0);
    const std::size_t at = block * kLanesPerBlock;
    const float* const own[3] = {c[0] + at, c[1] + at, c[2] + at};
    sigmoids.c = own;
    SpectrumSamplerAccess::run(*tables.white, kernels, lambda_nm.row(block, 0), whites,
                               count * kLanesPerBlock);
    kernels.sigmoids_at(to, sigmoids, lambda_nm.row(block, 0), count, 1);
    kernels.multiply(to, to, whites, count * kLanesPerBlock);
    kernels.scale_lanes(to, to, scale + at, count, 1);
  }
}

void samples_of_weights(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* weights,
                        const SampledSpectraView& lambda_nm, const SampledSpectraSpan& out) {
  const WavelengthTables& tables = UpsamplerAccess::at_wavelengths(upsampler);
  kernels.bases_at(out.data, weights, {tables.ends.data(), upsampler.lowest()}, tables.centres,
                   lambda_nm.data, out.axis.count(), out.blocks());
}

}  // namespace spectile::rows
