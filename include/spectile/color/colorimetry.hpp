// From spectra to CIE XYZ, luminance and linear sRGB.
#pragma once

#include <array>
#include <span>
#include <spectile/color/rgb_space.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/spectra/measured_spectrum.hpp>
#include <vector>

namespace spectile {

/// The CIE standard observers.
enum class Observer {
  kCie1931,  ///< 2 degree
  kCie1964,  ///< 10 degree
};

/// Three weights a band that turn a sampled spectrum into XYZ.
class Projector {
 public:
  /// For emitted or arriving light: weight = integral of the matching function over the band.
  /// Units: scaled so that Y is 1 for a spectrum that is 1 in every band.
  /// Errors: kBadArgument when no band reaches the observer's 360 to 830 nm.
  /// Source: CIE 015:2018.
  static Result<Projector> emissive(const Bands& bands, Observer observer = Observer::kCie1931);

  /// For reflectances under a light: weight = integral of matching function times light over the band.
  /// Units: scaled so that Y is 1 for a reflectance that is 1 in every band, whatever the light's scale.
  /// Errors: kBadArgument when the light gives no luminance in the bands.
  /// Source: CIE 015:2018.
  static Result<Projector> reflective(const Bands& bands, const MeasuredSpectrum& light,
                                      Observer observer = Observer::kCie1931);

  const Bands& bands() const noexcept { return bands_; }
  Observer observer() const noexcept { return observer_; }
  /// XYZ of a spectrum that is 1 in every band: the white; its Y is 1.
  std::array<double, 3> white() const noexcept;
  /// This projector's XYZ to linear sRGB, such that D65 is exactly RGB 1, 1, 1 as these bands and this
  /// observer see it: a white reflector under D65, or D65 itself scaled to Y = 1. So bands that cut off part
  /// of the visible range do not tint white, and a method's RGB comes back exactly. Where they cut off so
  /// much that D65 is more than 10 % off in a component, it is xyz_to_srgb_matrix(). Other lights are not
  /// adapted.
  const Matrix3& xyz_to_srgb() const noexcept { return xyz_to_srgb_; }
  /// Shapes: [bands][3], in double before rounding to the kernels' float.
  std::span<const std::array<double, 3>> weights() const noexcept { return weights_; }
  /// Shapes: [bands][4], x y z 0.
  const float* float_weights() const noexcept { return float_weights_.data(); }
  /// Shapes: [bands].
  const float* luminance_weights() const noexcept { return luminance_weights_.data(); }

 private:
  Projector() = default;
  static Result<Projector> from_light(const Bands& bands, const MeasuredSpectrum* light, Observer observer);
  Bands bands_;
  Observer observer_ = Observer::kCie1931;
  Matrix3 xyz_to_srgb_{};
  std::vector<std::array<double, 3>> weights_;
  std::vector<float> float_weights_;
  std::vector<float> luminance_weights_;
};

/// Projects spectra to CIE XYZ.
/// Shapes: spectra [block][band][64]; xyz three times [lanes].
/// Numbers: sums in runs of eight bands, relative error at most (bands / 8 + 11) * 2^-24 of the sum of
/// magnitudes; NaN and infinities go through. Errors: kBandsMismatch when the projector was built for other
/// bands; kSizeMismatch.
Result<void> project(const Projector& projector, SampledSpectraView spectra, ColorSpan xyz,
                     const Execution& execution = {});

/// Luminance Y alone, for a third of the work; the same bits as the Y of project().
/// Shapes, numbers, errors as for project().
Result<void> luminance(const Projector& projector, SampledSpectraView spectra, LanesSpan y,
                       const Execution& execution = {});

/// Linear sRGB to CIE XYZ (1931). White assumed: D65 at chromaticity (0.3127, 0.3290), so RGB 1, 1, 1 is
/// XYZ 0.9505, 1, 1.0891; no chromatic adaptation. Source: primaries and white of IEC 61966-2-1:1999.
const Matrix3& srgb_to_xyz_matrix();
/// The inverse of srgb_to_xyz_matrix(), with the same white.
const Matrix3& xyz_to_srgb_matrix();

/// out = matrix applied to each lane. Errors: kSizeMismatch.
Result<void> transform(const Matrix3& matrix, ColorView in, ColorSpan out, const Execution& execution = {});
/// XYZ to linear sRGB. White assumed: D65 (0.3127, 0.3290); no adaptation; values outside the gamut stay as
/// they are.
Result<void> xyz_to_srgb(ColorView xyz, ColorSpan rgb, const Execution& execution = {});
/// Linear sRGB to XYZ. White assumed: D65 (0.3127, 0.3290); no adaptation.
Result<void> srgb_to_xyz(ColorView rgb, ColorSpan xyz, const Execution& execution = {});

}  // namespace spectile
