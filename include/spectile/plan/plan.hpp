// Plan: the few wavelengths that a scene needs, with sensor weights and emission values for each.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <spectile/color/color_difference.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/band_weights.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <vector>

namespace spectile {

/// Error of a plan under one light for a number of bounces (products of so many reflectances), over
/// reflectances that took no part in making it. Units: CIEDE2000 against integration every nanometre.
struct CrossValidatedError {
  std::string light;
  int bounces = 1;
  ColorError error;
};

/// How samples over even bands become a colour.
enum class EvenBandsSums {
  /// Weights are integrals of light times matching function over each band, as Projector and
  /// `spectile project` have them, and colours are seen in the white of these bands.
  kAsProjected,
  /// Light and matching functions are sampled spectra too, averaged over each band and multiplied, as the
  /// book Physically Based Rendering does it; colours are seen in the light's own white.
  kAveragesMultiplied,
};

/// The same of even bands, for comparison.
struct EvenBandsError {
  EvenBandsSums sums = EvenBandsSums::kAsProjected;
  std::string bands;  ///< as Bands::parse() takes them
  std::string light;
  int bounces = 1;
  ColorError error;
};

/// Errors of a plan, beside those of even bands of about as many, and of more: of all as projected, then of
/// all with averages multiplied.
struct PlanReport {
  std::vector<CrossValidatedError> errors;
  std::vector<EvenBandsError> even_bands;
};

/// Wavelengths, their weights, and the errors that remain. With bands, a reflectance's sample in the formula
/// of BandWeights is its average over the band, else its value at the wavelength.
struct Plan {
  std::vector<double> wavelengths_nm;  ///< ascending, whole picometres
  /// Over which a reflectance is averaged to its samples, around the wavelengths; empty where it is taken at
  /// the wavelengths.
  std::vector<Band> bands;
  BandWeights weights;  ///< [wavelengths]
  PlanReport report;
  std::size_t count() const noexcept { return wavelengths_nm.size(); }
  /// XYZ of samples of a reflectance at the wavelengths. Shapes: samples [wavelengths].
  std::array<double, 3> xyz(std::size_t light, std::span<const double> samples) const;
  /// Sum of the magnitudes of the products for Y: 1 where no weight is below 0; noise grows with it.
  double absolute_sum(std::size_t light) const;
};

/// The bands of a plan, with its weights and report. Errors: kBadArgument for a plan without wavelengths, of
/// lists that differ in length, or as for Bands::from_overlapping().
Result<Bands> planned_bands(const Plan& plan);

/// The plan that bands with weights are of.
Plan plan_of_bands(const Bands& bands);

/// The scene that a plan is made for, and its size.
struct PlannerOptions {
  std::vector<NamedLight> lights = {};  ///< 0 beyond their tables' ends
  /// Reflectances of the scene, constant beyond their ends; outside -0.1 to 2 they are an error.
  std::vector<Spectrum> reflectances = {};
  BandSampling sampling = BandSampling::kPoints;  ///< averages err less, much less for one light
  bool apart =
      false;  ///< bands never overlap, as films fed with wavelengths need; with several lights they do not
  int bounces = 1;                        ///< products of up to so many reflectances, 1 to 4
  std::optional<std::size_t> bands = {};  ///< number of wavelengths, 3 to 64
  std::optional<double> max_error =
      {};  ///< or the smallest number that keeps every light's and bounce's maximum below this
  Observer observer = Observer::kCie1931;
  int folds = 5;                     ///< of the cross-validation; 0 for none
  std::function<bool()> go_on = {};  ///< asked some times a second; false stops with kCancelled
};

/// Chooses wavelengths and weights.
///
/// Method: the wavelengths start from kernel quadrature (greedy choice and exchange under the second moments
/// of the reflectances, of synthetic ones with steep edges, and of a smooth prior), and are then moved, with
/// the widths of bands, sensor weights and emission values, to the least colour differences, each in the
/// CIEDE2000 metric at its own colour; white is held exactly. Errors in the report are cross-validated: each
/// reflectance is held out of the fit that it is evaluated by. Errors: kBadArgument for no lights, two of one
/// name, a light without luminance or whose white has no X or Z, a reflectance that is no number or far
/// outside 0 to 1 somewhere, fewer than 10 reflectances, neither or both of bands and max_error, numbers out
/// of their ranges; kUnavailable where max_error cannot be met, saying the best there is. Source of kernel
/// quadrature: Rasmussen, Ghahramani, Bayesian Monte Carlo, NIPS 2002; of the metric: CIE 142, Sharma, Wu,
/// Dalal 2005.
Result<Plan> make_plan(const PlannerOptions& options);

/// Errors of a plan over reflectances, by the same measure, for products of `bounces` of them: all of them
/// for one, random ones for more. Errors: kBadArgument for a light that the plan has not.
Result<ColorError> plan_error(const Plan& plan, const NamedLight& light,
                              const std::vector<Spectrum>& reflectances, int bounces);

/// The same for even bands, over which reflectances are averaged. Errors: kBadArgument for a light
/// whose white has no X, Y or Z in these bands.
Result<ColorError> even_bands_error(const Bands& bands, const NamedLight& light,
                                    const std::vector<Spectrum>& reflectances, int bounces,
                                    EvenBandsSums sums = EvenBandsSums::kAsProjected,
                                    Observer observer = Observer::kCie1931);

}  // namespace spectile
