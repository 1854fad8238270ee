// Response curves, and radiance at sampled wavelengths added up to colours with them.
#pragma once

#include <array>
#include <memory>
#include <spectile/color/colorimetry.hpp>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/spectra/spectrum.hpp>

namespace spectile {

/// Three response curves that radiance at sampled wavelengths is weighed with.
class ResponseCurves {
 public:
  /// Of an observer: XYZ, scaled so that Y is 1 for a spectrum that is 1 everywhere.
  static Result<ResponseCurves> of_observer(Observer observer = Observer::kCie1931);
  /// Any three, times a factor each, tabulated at 1 nm over the range of the observers.
  /// Errors: kOutOfMemory; kBadArgument for a value that is not finite.
  static Result<ResponseCurves> create(const std::array<Spectrum, 3>& curves,
                                       const std::array<double, 3>& factors = {1, 1, 1});

 private:
  friend struct ResponseCurvesAccess;
  ResponseCurves() = default;
  std::shared_ptr<const FloatBuffer> table_;
};

/// Radiance at K sampled wavelengths a lane to XYZ or sensor RGB: the mean over k of curve(lambda_k) *
/// radiance_k / density_k. Unbiased for wavelengths drawn with those densities; a terminated wavelength adds
/// nothing, whatever its radiance.
/// Shapes: radiance on the axis of the wavelengths, color three times [lanes].
/// Numbers: error below (K + 6) u of the sum of the magnitudes, each with the larger value of the curve at
/// the nanometres beside the wavelength; NaN and infinities go through. Errors: kBandsMismatch,
/// kSizeMismatch.
Result<void> project(const ResponseCurves& curves, SampledSpectraView radiance,
                     const SampledWavelengthsView& wavelengths, ColorSpan color,
                     const Execution& execution = {});

}  // namespace spectile
