// WavelengthDistribution: densities of wavelengths made of spectra, to draw from and to look up.
#pragma once

#include <memory>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/spectra/spectrum.hpp>

namespace spectile {

/// A density of wavelengths over whole nanometres, even within each of them. Cheap to copy.
class WavelengthDistribution {
 public:
  /// Share of the draws that is even over the range, however the spectrum falls: what a scene holds at
  /// wavelengths that the spectrum lacks is then seen too, with at most 1 / share of the even draws'
  /// variance.
  static constexpr double kEvenShare = 0.05;

  /// In proportion to a spectrum, whose integral over each nanometre counts; below 0 counts as 0.
  /// Units: nm, within 1 to 100000. Errors: kBadArgument for a range that does not ascend, a share outside 0
  /// to 1 or so small that float loses it, a spectrum that is not finite or nowhere above 0 where no share is
  /// even; kOutOfMemory.
  static Result<WavelengthDistribution> proportional_to(const Spectrum& spectrum,
                                                        double even_share = kEvenShare,
                                                        int first_nm = static_cast<int>(kFirstVisibleNm),
                                                        int last_nm = static_cast<int>(kLastVisibleNm));
  /// In proportion to what an observer sees of a light: light * root((x / X)^2 + (y / Y)^2 + (z / Z)^2), with
  /// the light's own X, Y, Z. Of all densities it gives single draws of the light's colour the least
  /// variances, relative to each component and summed. Errors: likewise.
  static Result<WavelengthDistribution> of_light(const Spectrum& light,
                                                 Observer observer = Observer::kCie1931,
                                                 double even_share = kEvenShare);

  int first_nm() const noexcept;
  int last_nm() const noexcept;
  /// Density at a wavelength: that of its nanometre, of the upper one where two meet; 0 outside the range.
  /// Units: 1/nm.
  double density(double lambda_nm) const noexcept;

 private:
  friend struct WavelengthDistributionAccess;
  struct Tables;
  WavelengthDistribution() = default;
  std::shared_ptr<const Tables> tables_;
};

/// Draws K wavelengths a lane from one random number each, u, u + 1/K, ... as sample_wavelengths() does,
/// through the inverse of the distribution. Shapes: u [lanes], from 0 to 1 (limited to that; NaN gives NaN).
/// Numbers: a wavelength within 2 u of the exact inverse's, or of the end of its nanometre; its density is
/// density() there, rounded to float. Errors: kSizeMismatch; kBadArgument for numbers not aligned.
Result<void> sample_wavelengths(const WavelengthDistribution& distribution, LanesView u,
                                SampledWavelengthsSpan out, const Execution& execution = {});

/// Densities with which the distribution draws given wavelengths, by whatever way those came about.
/// Shapes: lambda_nm and density on one axis, in other memory. Units: nm, 1/nm. Errors: as
/// SpectrumSampler::sample().
Result<void> wavelength_density(const WavelengthDistribution& distribution, SampledSpectraView lambda_nm,
                                SampledSpectraSpan density, const Execution& execution = {});

/// Weight of a path that was made for the first of a lane's wavelengths and could have been for any: by the
/// balance heuristic, its density for the first over the mean of those for all; 1 where the others are
/// terminated; 0 where its density is 0. Shapes: path_density on the axis of the wavelengths, weight [lanes].
/// Errors: as average(). Source: Wilkie, Nawaz, Droske, Weidlich, Hanika, Hero Wavelength Spectral Sampling,
/// Computer Graphics Forum 33(4), 2014.
Result<void> balance_heuristic(SampledSpectraView path_density, const SampledWavelengthsView& wavelengths,
                               LanesSpan weight, const Execution& execution = {});

}  // namespace spectile
