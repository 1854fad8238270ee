// Plan: the few wavelengths that a scene needs, with sensor weights and emission values for each.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <spectile/color/colorimetry.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/spectra/measured_spectrum.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <vector>

namespace spectile {

/// Errors of a plan under one light, CIEDE2000 against integration every nanometre, over reflectances that
/// took no part in making it.
struct PlanError {
  double mean = 0;
  double percentile95 = 0;
  double maximum = 0;
};

/// What a plan promises for one light and a number of bounces (products of so many reflectances).
struct PlanPromise {
  std::string light;
  int bounces = 1;
  PlanError error;
};

/// The same of even bands, for comparison.
struct EvenBandsPromise {
  std::string bands;  ///< as Bands::parse() takes them
  PlanPromise promise;
};

/// A light of a plan.
struct PlanLight {
  std::string name;
  std::vector<double> emission;  ///< [wavelengths]
  MeasuredSpectrum spectrum;     ///< which emission stands for, on any scale
};

/// What a plan's samples are.
enum class PlanSampling {
  kPoints,  ///< a reflectance's values at the wavelengths, as renderers that trace wavelengths take them
  kBands,   ///< its averages over bands, as sampled spectra hold them: a half to a quarter of the error, for
            ///< one bounce
};

/// XYZ of a reflectance r under a light is the sum over k of sensor_k * emission_k * r(lambda_k); that of a
/// reflectance that is 1 everywhere is the light's white, Y = 1, exactly. With bands, r(lambda_k) stands for
/// r's average over band k.
struct Plan {
  Observer observer = Observer::kCie1931;
  std::vector<double> wavelengths_nm;  ///< ascending, whole picometres
  /// Over which a reflectance is averaged to its samples, around the wavelengths; empty where it is taken at
  /// the wavelengths.
  std::vector<Band> bands;
  std::vector<std::array<double, 3>> sensor;  ///< [wavelengths], shared by all lights
  std::vector<PlanLight> lights;
  std::vector<PlanPromise> promises;
  std::vector<EvenBandsPromise> even;  ///< what even bands of about as many, and of more, do
  std::size_t count() const noexcept { return wavelengths_nm.size(); }
  /// XYZ of samples of a reflectance at the wavelengths. Shapes: samples [wavelengths].
  std::array<double, 3> xyz(std::size_t light, std::span<const double> samples) const;
  /// Sum of the magnitudes of the products for Y: 1 where no weight is below 0; noise grows with it.
  double absolute_sum(std::size_t light) const;
};

/// A light to plan for.
struct PlannedLight {
  std::string name;
  Spectrum spectrum;
};

/// What a plan is made for.
struct PlannerOptions {
  std::vector<PlannedLight> lights;
  /// What the scene holds: reflectances, limited to [0, 1], constant beyond their ends.
  std::vector<Spectrum> reflectances;
  PlanSampling sampling = PlanSampling::kPoints;
  int bounces = 1;                   ///< products of up to so many reflectances, 1 to 4
  std::optional<std::size_t> bands;  ///< so many wavelengths, 3 to 64
  std::optional<double> max_error;   ///< or as few as keep every light's and bounce's maximum below this
  Observer observer = Observer::kCie1931;
  int folds = 5;  ///< of the cross-validation behind the promises; 0 for none
};

/// Chooses wavelengths and weights.
///
/// How: the wavelengths start from kernel quadrature (greedy choice and exchange under the second moments of
/// the reflectances, of made-up ones with steep edges, and of a smooth prior), and are then moved, with the
/// widths of bands, sensor weights and emission values, to the least colour differences, each in the
/// CIEDE2000 metric at its own colour; white is held exactly. Promises are cross-validated: each reflectance
/// is judged by a plan that was fitted without it. Errors: kBadArgument for no lights, two of one name, a
/// light without luminance or whose white has no X or Z, a reflectance that is no number somewhere, fewer
/// than 10 reflectances, neither or both of bands and max_error, numbers out of their ranges; kUnavailable
/// where max_error cannot be met, saying the best there is. Source of kernel quadrature: Rasmussen,
/// Ghahramani, Bayesian Monte Carlo, NIPS 2002; of the metric: CIE 142, Sharma, Wu, Dalal 2005.
Result<Plan> make_plan(const PlannerOptions& options);

/// Errors of a plan over reflectances, by the same measure, for products of `bounces` of them: all of them
/// for one, random ones for more. Errors: kBadArgument for a light that the plan has not.
Result<PlanError> plan_error(const Plan& plan, const PlannedLight& light,
                             const std::vector<Spectrum>& reflectances, int bounces);

/// The same for even bands, reflectance and light averaged over each as sampled spectra are.
Result<PlanError> even_bands_error(const Bands& bands, const PlannedLight& light,
                                   const std::vector<Spectrum>& reflectances, int bounces,
                                   Observer observer = Observer::kCie1931);

}  // namespace spectile
