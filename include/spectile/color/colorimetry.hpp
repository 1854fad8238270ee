// From spectra to CIE XYZ, luminance, a sensor's RGB and linear sRGB.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <spectile/color/rgb_space.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/spectra/measured_spectrum.hpp>
#include <spectile/spectra/observer.hpp>
#include <vector>

namespace spectile {

class Sensor;
class Spectrum;

/// Two bands of a list: light absorbed in one, and emitted in the other.
struct BandPair {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// Three weights a band that turn sampled spectra into XYZ, or into a sensor's RGB.
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

  /// The same under a light of any distribution, as tabulated() has it. Errors: also those of tabulated().
  static Result<Projector> reflective(const Bands& bands, const Spectrum& light,
                                      Observer observer = Observer::kCie1931);

  /// For reflectances that also re-radiate, as fluorescent ones do: the weights of reflective(), then one for
  /// each pair of bands, for the share of the light absorbed in one that is emitted in the other: average of
  /// the light over the first * integral of the matching function over the second. A share is what the
  /// spectral layout's channels of two wavelengths hold: radiance emitted in the second band over irradiance
  /// times 1 / pi in the first, both averages. Errors: those of reflective(); kBadArgument for planned bands
  /// and for pairs of bands that there are not. Source: Fichet, Pacanowski, Wilkie, An OpenEXR Layout for
  /// Spectral Images, JCGT 10(3), 2021.
  static Result<Projector> reradiating(const Bands& bands, const MeasuredSpectrum& light,
                                       std::span<const BandPair> pairs,
                                       Observer observer = Observer::kCie1931);

  /// For a sensor: weight = its factor * integral of its curve, for reflectances of curve times light, over
  /// the band. Units: as Sensor::response(). Errors: kBadArgument for planned bands, which an observer's
  /// weights belong to.
  static Result<Projector> emissive(const Bands& bands, const Sensor& sensor);
  static Result<Projector> reflective(const Bands& bands, const Spectrum& light, const Sensor& sensor);

  const Bands& bands() const noexcept { return bands_; }
  /// None for a sensor.
  std::optional<Observer> observer() const noexcept { return observer_; }
  /// The colour of a spectrum that is 1 in every band: for an observer the white, whose Y is 1.
  std::array<double, 3> white() const noexcept;
  /// This projector's XYZ to linear sRGB, such that D65 is exactly RGB 1, 1, 1 as these bands and this
  /// observer see it: a perfect diffuser under D65, or D65 itself scaled to Y = 1. So bands that cut off part
  /// of the visible range do not tint white, and a method's RGB comes back exactly. Where they cut off so
  /// much that D65 is more than 10 % off in a component, part of the tint stays: see white_compensation().
  /// Other lights are not adapted. For a sensor it is the identity: see fit_sensor_to_xyz().
  const Matrix3& xyz_to_srgb() const noexcept { return xyz_to_srgb_; }
  /// Share of the tint of D65 that xyz_to_srgb() takes out: 1 up to 10 % off in a component of sRGB, 0 from 30 % on,
  /// evenly less in between. 1 for a sensor.
  double white_compensation() const noexcept { return white_compensation_; }
  /// Shapes: [bands][3], in double before rounding to the kernels' float.
  std::span<const std::array<double, 3>> weights() const noexcept { return weights_; }

 private:
  friend struct ProjectorAccess;
  Projector() = default;
  static Result<Projector> of_observer(const Bands& bands, const MeasuredSpectrum* light, Observer observer);
  static Result<Projector> of_sensor(const Bands& bands, const Spectrum* light, const Sensor& sensor);
  void add_band(const std::array<double, 3>& weights);
  Bands bands_;
  std::optional<Observer> observer_;
  Matrix3 xyz_to_srgb_ = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  double white_compensation_ = 1;
  std::vector<std::array<double, 3>> weights_;
  std::vector<float> float_weights_;
  std::vector<float> luminance_weights_;
};

/// Projects spectra to CIE XYZ or a sensor's RGB.
/// Shapes: spectra [block][band][64]; color three times [lanes].
/// Numbers: sums in runs of eight bands, relative error at most (bands / 8 + 11) * 2^-24 of the sum of
/// magnitudes; NaN and infinities go through. Errors: kBandsMismatch when the projector was built for other
/// bands; kSizeMismatch.
Result<void> project(const Projector& projector, SampledSpectraView spectra, ColorSpan color,
                     const Execution& execution = {});

/// The second component alone, for a third of the work: an observer's luminance Y. The same bits as that of
/// project(). Shapes, numbers, errors as for project().
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
