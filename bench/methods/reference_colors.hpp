// Reference colours, which methods are evaluated against: sums at every nanometre in double.
#pragma once

#include <array>
#include <spectile/bench/benchmark.hpp>
#include <spectile/spectra/measured_spectrum.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <vector>

namespace spectile::measure {

using Xyz = std::array<double, 3>;

/// A light, on the scale on which the perfect diffuser under it has Y = 1.
struct ReferenceLight {
  std::string name;
  MeasuredSpectrum spectrum;
  std::vector<double> weights[3];  ///< matching function times light at 360, 361, ... 830 nm
  Xyz white{};
  bool line_spectrum = false;  ///< somewhere twice its mean over the 40 nm around
};

/// Reflectances as they were measured, limited to [0, 1], constant beyond their ends.
struct ReferenceReflectance {
  MeasuredSpectrum spectrum;
  std::vector<double> values;  ///< at 360, 361, ... 830 nm
};

/// Errors: kBadArgument for a light without luminance.
Result<ReferenceLight> reference_light(const std::string& name);
Result<std::vector<ReferenceReflectance>> reference_reflectances(const std::vector<Spectrum>& spectra);
/// The 24 of the ColorChecker.
Result<std::vector<Spectrum>> chart_reflectances();

/// XYZ of the product of reflectances under a light.
Xyz reference_xyz(const ReferenceLight& light, const std::vector<const ReferenceReflectance*>& reflectances);

/// Colours whose errors are collected.
class ErrorList {
 public:
  explicit ErrorList(const Xyz& white) : white_(white) {}
  void add(const Xyz& reference, const Xyz& found);
  ColorError summary() const { return summarize(values_); }
  const std::vector<double>& differences() const { return values_; }

 private:
  Xyz white_;
  std::vector<double> values_;
};

}  // namespace spectile::measure
