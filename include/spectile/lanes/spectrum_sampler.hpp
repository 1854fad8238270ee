// Spectra looked up at sampled wavelengths, in batches.
#pragma once

#include <memory>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/spectra/spectrum.hpp>

namespace spectile {

/// A spectrum made ready to be looked up in batches.
///
/// Numbers: NaN wavelengths give NaN, infinite ones what the distribution is there. In float: tables within 4
/// u (u = 2^-24) of the larger neighbour in magnitude, for wavelengths and knots rounded to float; black
/// bodies within 6 u from 0.1 to 10^7 nm (and the least float); Gaussians within 1 u of the sum of the lobes'
/// magnitudes; sigmoids as upsampled.
class SpectrumSampler {
 public:
  /// Errors: kOutOfMemory; kBadArgument for samples, slopes and ranges beyond that of float.
  static Result<SpectrumSampler> create(const Spectrum& spectrum);

  /// Values at wavelengths: a batch of them, such as SampledWavelengths::lambda_nm, gives a batch on the same
  /// axis, in other memory. Units: nm. Errors: kBandsMismatch, kSizeMismatch; kBadArgument for samples not
  /// aligned.
  Result<void> sample(SampledSpectraView lambda_nm, SampledSpectraSpan values,
                      const Execution& execution = {}) const;

 private:
  friend struct SpectrumSamplerAccess;
  SpectrumSampler() = default;
  struct Tables;
  std::shared_ptr<const Tables> tables_;
};

/// The same for a spectrum that is looked up once.
Result<void> sample(const Spectrum& spectrum, SampledSpectraView lambda_nm, SampledSpectraSpan values,
                    const Execution& execution = {});

}  // namespace spectile
