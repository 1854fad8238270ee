// CoefficientSource: an open image of a method's coefficients, the method, and what else passes through.
#pragma once

#include <memory>
#include <spectile/upsampling/upsample.hpp>

#include "src/io/convert/sources/image_source.hpp"

namespace spectile::io {

/// True for a part that is meant to hold coefficients, complete or not.
bool claims_coefficients(const PartHeader& header);

/// Planes 0 to coefficients() - 1 of its strips are the coefficients (and the scale) in float, the others
/// pass through.
class CoefficientSource : public ImageSource {
 public:
  /// Takes the first flat part that claims coefficients. Errors: kBadFile where there is none, where
  /// attributes are missing or damaged, channels missing, subsampled or too many, or spectral channels there
  /// already; those of RegionReader.
  static Result<std::unique_ptr<CoefficientSource>> open(std::unique_ptr<ExrInput> input,
                                                         const std::optional<PixelWindow>& region = {});

  /// The upsampler that made the coefficients.
  const Upsampler& upsampler() const noexcept { return *upsampler_; }
  std::size_t coefficients() const noexcept { return coefficients_; }

 private:
  CoefficientSource() = default;
  Result<void> choose_channels();

  std::unique_ptr<Upsampler> upsampler_;
  std::size_t coefficients_ = 0;
};

}  // namespace spectile::io
