// Luminous quantities of spectra, photons, black bodies, and quantities as text.
#include <cmath>
#include <limits>
#include <numbers>
#include <spectile/radiometry/radiometry.hpp>
#include <utility>
#include <vector>

#include "src/base/errors.hpp"
#include "src/data/tables.hpp"

namespace spectile {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// A wavelength as a length.
constexpr Length metres(double lambda_nm) {
  return Length(lambda_nm * 1e-9);
}

/// Range of a distribution's radiation: see luminous_efficacy().
struct Range {
  double first_nm = kFirstVisibleNm;
  double last_nm = kLastVisibleNm;
};
template <class Kind>
Range radiation_range(const Kind& /*spectrum*/) {
  return {};
}
Range radiation_range(const BlackbodySpectrum& /*spectrum*/) {
  return {0, kInfinity};
}
Range radiation_range(const GaussianSumSpectrum& /*spectrum*/) {
  return {0, kInfinity};
}
Range radiation_range(const PiecewiseLinearSpectrum& spectrum) {
  return {spectrum.wavelengths_nm().front(), spectrum.wavelengths_nm().back()};
}
Range radiation_range(const DenselySampledSpectrum& spectrum) {
  return {static_cast<double>(spectrum.first_nm()), static_cast<double>(spectrum.last_nm())};
}
/// Of products what all factors cover, of sums all of it.
Range radiation_range(const CombinedSpectrum& spectrum) {
  Range sum = {kInfinity, 0};
  for (const auto& term : spectrum.terms()) {
    Range product = {0, kInfinity};
    for (const Spectrum& part : term.of) {
      const Range range = std::visit([](const auto& s) { return radiation_range(s); }, part.kind());
      product = {std::max(product.first_nm, range.first_nm), std::min(product.last_nm, range.last_nm)};
    }
    if (!(product.last_nm > product.first_nm)) continue;
    sum = {std::min(sum.first_nm, product.first_nm), std::max(sum.last_nm, product.last_nm)};
  }
  return sum;
}

/// 1 for a temperature that is one, NaN else.
double valid_temperature(double temperature_k) {
  return temperature_k >= 0 ? 1 : kNotANumber;
}

}  // namespace

std::string to_text(const Unit& unit) {
  const std::pair<const char*, int> powers[] = {
      {"W", unit.watt},       {"lm", unit.lumen},     {"s", unit.second}, {"m", unit.metre},
      {"sr", unit.steradian}, {"nm", unit.nanometre}, {"K", unit.kelvin}};
  std::string out;
  for (const auto& [name, power] : powers) {
    if (power == 0) continue;
    if (!out.empty()) out += ' ';
    out += name;
    if (power != 1) out += fmt::format("^{}", power);
  }
  return out.empty() ? "1" : out;
}

std::string detail::to_text(double value, const Unit& unit) {
  return fmt::format("{} {}", value, spectile::to_text(unit));
}

RadiantEnergy photon_energy(double lambda_nm) noexcept {
  if (!(lambda_nm >= 0)) return RadiantEnergy(kNotANumber);
  return kPlanckConstant * kSpeedOfLight / metres(std::abs(lambda_nm));
}

Rate photon_rate(RadiantFlux flux, double lambda_nm) noexcept {
  return flux / photon_energy(lambda_nm);
}

Result<Rate> photon_rate(const Spectrum& spectral_flux, double first_nm, double last_nm) {
  if (!(first_nm >= 0 && first_nm < last_nm && std::isfinite(last_nm))) {
    return make_error(
        ErrorCode::kBadArgument,
        "photons from {} to {} nm asked for; the range must be finite, not below 0 and not empty", first_nm,
        last_nm);
  }
  // As many photons a joule as the wavelength over h c.
  const double ends_nm[] = {first_nm, last_nm};
  SPECTILE_ASSIGN(const auto wavelength, PiecewiseLinearSpectrum::from_samples(ends_nm, ends_nm));
  const RadiantFlux flux_times_nm(inner_product(wavelength, spectral_flux, first_nm, last_nm));
  return flux_times_nm / photon_energy(1);
}

const Spectrum& luminous_efficiency_function() {
  static const Spectrum kYBar = [] {
    const data::MatchingFunctions& table = data::kCie1931;
    std::vector<double> wavelengths_nm;
    for (std::size_t i = 0; i < table.y_bar.size(); ++i) {
      wavelengths_nm.push_back(table.first_nm + table.step_nm * static_cast<double>(i));
    }
    return *PiecewiseLinearSpectrum::from_samples(wavelengths_nm, table.y_bar);
  }();
  return kYBar;
}

LuminousEfficacy luminous_efficacy_at(double lambda_nm) noexcept {
  if (std::isnan(lambda_nm)) return LuminousEfficacy(lambda_nm);
  return luminous_efficiency_function()(lambda_nm) * kMaxLuminousEfficacy;
}

Result<LuminousEfficacy> luminous_efficacy(const Spectrum& spectrum) {
  const Range range = std::visit([](const auto& s) { return radiation_range(s); }, spectrum.kind());
  return luminous_efficacy(spectrum, range.first_nm, range.last_nm);
}

Result<LuminousEfficacy> luminous_efficacy(const Spectrum& spectrum, double first_nm, double last_nm) {
  const double watts = spectrum.integral(first_nm, last_nm);
  if (!(watts > 0) || !std::isfinite(watts)) {
    return make_error(ErrorCode::kBadArgument,
                      "the spectrum's integral from {} to {} nm is {}; it must be finite and above 0",
                      first_nm, last_nm, watts);
  }
  return luminous_flux(spectrum) / RadiantFlux(watts);
}

Result<double> luminous_efficiency(const Spectrum& spectrum) {
  SPECTILE_ASSIGN(const auto efficacy, luminous_efficacy(spectrum));
  return efficacy / kMaxLuminousEfficacy;
}

double wien_peak_nm(double temperature_k) noexcept {
  return kWienDisplacement / Temperature(std::abs(temperature_k)) / metres(1) *
         valid_temperature(temperature_k);
}

RadiantExitance blackbody_exitance(double temperature_k) noexcept {
  const Temperature t(temperature_k);
  return kStefanBoltzmann * t * t * t * t * valid_temperature(temperature_k);
}

Radiance blackbody_radiance(double temperature_k) noexcept {
  return blackbody_exitance(temperature_k) / (std::numbers::pi * kSteradian);
}

}  // namespace spectile
