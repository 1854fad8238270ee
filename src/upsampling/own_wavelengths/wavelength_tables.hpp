// WavelengthTables: a method's tables for wavelengths between the centres of its bands.
#pragma once

#include <memory>
#include <optional>
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "kernels/abi.hpp"
#include "src/lanes/knot_index.hpp"

namespace spectile {

/// Tables as the kernels take them, and the memory that they lie in.
struct WavelengthTables {
  kernels::CentreTable centres;
  KnotIndex knots;                       ///< of centres that are not even
  FloatBuffer per_width;                 ///< likewise
  FloatBuffer ends;                      ///< of kernels::MixtureTable, for the methods that mix basis spectra
  kernels::SigmoidLanes sigmoid;         ///< of the sigmoids, but for the lanes' own
  std::optional<SpectrumSampler> white;  ///< that sigmoids of lights are multiplied by
};

/// The centres of bands alone. Errors: kOutOfMemory; kBadArgument for bands beyond the range of float.
Result<std::shared_ptr<const WavelengthTables>> centre_tables(const Bands& bands);

/// Errors: the same.
Result<std::shared_ptr<const WavelengthTables>> wavelength_tables(const Upsampler& upsampler);

}  // namespace spectile
