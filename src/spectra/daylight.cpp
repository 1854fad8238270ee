// Daylight by its correlated colour temperature.
#include <cmath>
#include <spectile/spectra/spectrum.hpp>
#include <vector>

#include "src/base/errors.hpp"
#include "src/data/tables.hpp"

namespace spectile {

Result<std::array<double, 2>> daylight_chromaticity(double temperature_k) {
  // The negation takes in NaN.
  if (!(temperature_k >= 4000 && temperature_k <= 25000)) {
    return make_error(ErrorCode::kBadArgument,
                      "daylight of {} K is not defined; its colour temperature is 4000 to 25000 K",
                      temperature_k);
  }
  const double t = 1 / temperature_k;
  // Source: CIE 015:2018, 4.1.2.
  const double x = temperature_k <= 7000 ? ((-4.6070e9 * t + 2.9678e6) * t + 0.09911e3) * t + 0.244063
                                         : ((-2.0064e9 * t + 1.9018e6) * t + 0.24748e3) * t + 0.237040;
  return std::array{x, (-3.000 * x + 2.870) * x - 0.275};
}

Result<PiecewiseLinearSpectrum> daylight_spectrum(double temperature_k) {
  SPECTILE_ASSIGN(const auto xy, daylight_chromaticity(temperature_k));
  const auto [x, y] = xy;
  const auto rounded = [](double m) { return std::round(1000 * m) / 1000; };
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = rounded((-1.3515 - 1.7703 * x + 5.9114 * y) / m);
  const double m2 = rounded((0.0300 - 31.4424 * x + 30.0717 * y) / m);
  const data::DaylightBasis& basis = data::kDaylightBasis;
  std::vector<double> wavelengths;
  std::vector<double> values;
  for (std::size_t i = 0; i < basis.s0.size(); ++i) {
    wavelengths.push_back(basis.first_nm + static_cast<double>(i) * basis.step_nm);
    values.push_back(basis.s0[i] + m1 * basis.s1[i] + m2 * basis.s2[i]);
  }
  return PiecewiseLinearSpectrum::from_samples(wavelengths, values);
}

}  // namespace spectile
