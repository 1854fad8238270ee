// Samples at lanes' own wavelengths of lanes whose coefficients, or weights of bases, are known.
#pragma once

#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "kernels/abi.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile::rows {

/// Coefficients, and a scale where there is one (else null), to samples.
void samples_at(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const c[3],
                const float* scale, const SampledSpectraView& lambda_nm, const SampledSpectraSpan& out);

/// Weights as of basis_weights(), of methods that mix bases, to samples. Shapes: weights [block][8][64], the
/// last unused.
void samples_of_weights(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* weights,
                        const SampledSpectraView& lambda_nm, const SampledSpectraSpan& out);

}  // namespace spectile::rows
