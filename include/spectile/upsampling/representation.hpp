// Representations of light and materials with one interface: sampled over bands, or as three RGB
// coefficients.
#pragma once

#include <memory>
#include <spectile/color/colorimetry.hpp>
#include <spectile/lanes/arithmetic.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <spectile/upsampling/upsample.hpp>

namespace spectile {

// Code written once as a template over the representation runs on either: it makes batches with constant(),
// light(), reflectance() and their *_from_rgb(), computes on them with the operations of arithmetic.hpp,
// which take both, and looks at the result with to_xyz(), to_rgb() and luminance().
//
// Light and what reaches the eye are relative to luminance 1 of a spectrum that is 1 everywhere; RGB is
// linear sRGB, whose 1, 1, 1 is, for a reflectance, the perfect diffuser under D65 and, for light, D65 with Y
// = 1. Errors common to both: kBandsMismatch for a batch of another representation, kSizeMismatch,
// kOutOfMemory.

/// Spectra sampled over bands.
class SampledRepresentation {
 public:
  /// With the method that makes spectra of RGB. Errors: those of Upsampler::create() and of Projector.
  static Result<SampledRepresentation> create(const Bands& bands = {}, Method method = kDefaultMethod);

  const Bands& bands() const noexcept { return reflectances_->bands(); }
  /// A batch in which every coefficient is `value`.
  Result<SampledSpectra> constant(std::size_t lanes, float value) const;
  /// A batch with one light, one reflectance in every lane: its averages over the bands.
  Result<SampledSpectra> light(const Spectrum& spectrum, std::size_t lanes) const;
  Result<SampledSpectra> reflectance(const Spectrum& spectrum, std::size_t lanes) const;
  Result<void> light_from_rgb(ColorView rgb, SampledSpectraSpan out, const Execution& execution = {}) const;
  Result<void> reflectance_from_rgb(ColorView rgb, SampledSpectraSpan out,
                                    const Execution& execution = {}) const;
  /// Colours of light.
  Result<void> to_xyz(SampledSpectraView light, ColorSpan xyz, const Execution& execution = {}) const;
  Result<void> to_rgb(SampledSpectraView light, ColorSpan rgb, const Execution& execution = {}) const;
  Result<void> luminance(SampledSpectraView light, LanesSpan y, const Execution& execution = {}) const;

 private:
  SampledRepresentation(Upsampler reflectances, Upsampler lights, Projector projector);
  std::shared_ptr<const Upsampler> reflectances_, lights_;
  std::shared_ptr<const Projector> projector_;
};

/// Three coefficients a lane: linear sRGB. Products of them are what renderers without spectra compute. Their
/// batches have three bands that stand for red, green and blue, at 1, 2 and 3 nm: no spectrum has those, so
/// the two kinds cannot be mixed by mistake.
class RgbRepresentation {
 public:
  /// Errors: none but kOutOfMemory.
  static Result<RgbRepresentation> create();

  const Bands& bands() const noexcept { return bands_; }
  Result<SampledSpectra> constant(std::size_t lanes, float value) const;
  /// The colour of the light; of the reflectance under D65. Integrals over 360 to 830 nm.
  Result<SampledSpectra> light(const Spectrum& spectrum, std::size_t lanes) const;
  Result<SampledSpectra> reflectance(const Spectrum& spectrum, std::size_t lanes) const;
  Result<void> light_from_rgb(ColorView rgb, SampledSpectraSpan out, const Execution& execution = {}) const;
  Result<void> reflectance_from_rgb(ColorView rgb, SampledSpectraSpan out,
                                    const Execution& execution = {}) const;
  Result<void> to_xyz(SampledSpectraView light, ColorSpan xyz, const Execution& execution = {}) const;
  Result<void> to_rgb(SampledSpectraView light, ColorSpan rgb, const Execution& execution = {}) const;
  Result<void> luminance(SampledSpectraView light, LanesSpan y, const Execution& execution = {}) const;

  /// The conversions to the other representation and back: what a batch of sampled lights looks like as RGB,
  /// and spectra with the colours of a batch of RGB.
  Result<void> from_sampled(const SampledRepresentation& other, SampledSpectraView light,
                            SampledSpectraSpan out, const Execution& execution = {}) const;
  Result<void> to_sampled(const SampledRepresentation& other, SampledSpectraView light,
                          SampledSpectraSpan out, const Execution& execution = {}) const;

 private:
  RgbRepresentation() = default;
  Result<void> weighted(const Matrix3& matrix, SampledSpectraView light, ColorSpan out,
                        const Execution& execution) const;
  Bands bands_;
};

}  // namespace spectile
