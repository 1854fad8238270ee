// From radiant to luminous quantities, photons, and the laws of thermal radiation.
#pragma once

#include <spectile/constants.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <spectile/units.hpp>

namespace spectile {

// --- photons ---------------------------------------------------------------------------------------------

/// Energy of one photon, h c / lambda. Units: nm, in vacuum. Infinite at 0 nm, 0 at an infinite wavelength,
/// NaN below 0 nm and for NaN.
RadiantEnergy photon_energy(double lambda_nm) noexcept;

/// Photons per second in a flux of one wavelength. 0 at 0 nm; else as IEEE 754 says for flux /
/// photon_energy().
Rate photon_rate(RadiantFlux flux, double lambda_nm) noexcept;

/// Photons per second in a flux of many, from its density in W/nm. Numbers: as inner_product(). Errors:
/// kBadArgument unless 0 <= first_nm < last_nm < infinity.
Result<Rate> photon_rate(const Spectrum& spectral_flux, double first_nm = kFirstVisibleNm,
                         double last_nm = kLastVisibleNm);

// --- luminous quantities ---------------------------------------------------------------------------------

/// y-bar of the CIE 1931 observer, linear between whole nanometres and 0 outside 360 to 830 nm: the weight
/// of all that follows. Source: CIE 015:2018.
const Spectrum& luminous_efficiency_function();

/// Lumens in a watt of one wavelength: times any radiant quantity it is the luminous one. 0 outside 360 to
/// 830 nm; NaN for NaN. Units: nm.
LuminousEfficacy luminous_efficacy_at(double lambda_nm) noexcept;

/// 683 lm/W times the integral of y-bar times the density over wavelength of a radiant quantity.
/// Units: the density's is that of the type asked for: `luminous_from<Luminance>` takes W/(m^2 sr nm),
/// `luminous_from<Illuminance>` W/(m^2 nm). Numbers: as inner_product(), so exact for piecewise-linear
/// spectra; negative values count, NaN gives NaN, an infinity an infinity or NaN.
template <class Luminous>
Luminous luminous_from(const Spectrum& density) {
  static_assert(Luminous::unit().lumen == 1 && Luminous::unit().watt == 0 && Luminous::unit().nanometre == 0,
                "lumens, or lumens per area, solid angle or both");
  return Luminous(kMaxLuminousEfficacy.value() * inner_product(luminous_efficiency_function(), density));
}
/// The same by name. Units: W/(m^2 sr nm); W/nm; W/(sr nm); W/(m^2 nm). (luminance(Projector, ...) does
/// batches, relative to a white.)
inline Luminance luminance(const Spectrum& spectral_radiance) {
  return luminous_from<Luminance>(spectral_radiance);
}
inline LuminousFlux luminous_flux(const Spectrum& spectral_flux) {
  return luminous_from<LuminousFlux>(spectral_flux);
}
inline LuminousIntensity luminous_intensity(const Spectrum& spectral_intensity) {
  return luminous_from<LuminousIntensity>(spectral_intensity);
}
inline Illuminance illuminance(const Spectrum& spectral_irradiance) {
  return luminous_from<Illuminance>(spectral_irradiance);
}

/// Lumens per watt of radiation, for a spectrum on any scale. The watts are those of all wavelengths: of a
/// black body or Gaussians from 0 to infinity, of samples from the first to the last; constant and upsampled
/// spectra, which have no end, count from 360 to 830 nm. Errors: kBadArgument where these watts are not
/// finite and above 0.
Result<LuminousEfficacy> luminous_efficacy(const Spectrum& spectrum);
/// Only the watts between two wavelengths count (the lumens are all). Errors: as above.
Result<LuminousEfficacy> luminous_efficacy(const Spectrum& spectrum, double first_nm, double last_nm);
/// The efficacy as a fraction of 683 lm/W. Errors: as for luminous_efficacy().
Result<double> luminous_efficiency(const Spectrum& spectrum);

// --- black bodies ----------------------------------------------------------------------------------------

// Units: K. At 0 K nothing is emitted and the peak is at infinity; NaN below 0 K and for NaN.

/// Wavelength of the maximum of radiance per unit of wavelength. Units: nm, in vacuum. Source: Wien's
/// displacement law.
double wien_peak_nm(double temperature_k) noexcept;
/// Radiant exitance of a black body over all wavelengths. Source: law of Stefan and Boltzmann.
RadiantExitance blackbody_exitance(double temperature_k) noexcept;
/// Its radiance over all wavelengths: the exitance divided by pi steradian.
Radiance blackbody_radiance(double temperature_k) noexcept;

}  // namespace spectile
