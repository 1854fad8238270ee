// SpectrumSampler within a tile of other work.
#pragma once

#include <spectile/lanes/spectrum_sampler.hpp>

#include "kernels/abi.hpp"

namespace spectile {

struct SpectrumSamplerAccess {
  /// The values at n wavelengths, a multiple of 64, in other memory.
  static void run(const SpectrumSampler& sampler, const kernels::KernelTable& kernels, const float* lambda_nm,
                  float* values, std::size_t n);
};

}  // namespace spectile
