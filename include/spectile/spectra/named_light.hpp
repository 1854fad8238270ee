// NamedLight: a light with its name, on any scale.
#pragma once

#include <spectile/spectra/measured_spectrum.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <vector>

namespace spectile {

/// A light and its name in files and reports.
struct NamedLight {
  std::string name;
  MeasuredSpectrum spectrum;
  std::vector<std::string> notes = {};  ///< on how a file of it was read; for people
};

/// A light as a table: the samples and ends of a piecewise-linear spectrum, any other every nanometre from
/// 300 to 830 nm, the range in which the CIE tabulates illuminants, and 0 beyond. Of sums and products also
/// at the samples of their parts, steps included: sums of tables are exact, and no line is passed over.
/// Errors: kBadArgument for values that are not finite.
Result<MeasuredSpectrum> tabulated(const Spectrum& light);

/// A light of any distribution. Errors: those of tabulated().
Result<NamedLight> named_light(std::string name, const Spectrum& light);

/// Checks that a spectrum can be a light, and adds to its notes. Errors: kBadArgument for one without energy
/// within 360 to 830 nm, or with a value below 0 that exceeds a hundredth of the largest, as dark noise of an
/// instrument does not.
Result<void> check_light(NamedLight& light);

/// Values of a light at every nanometre of the visible range, relative to the largest magnitude among them;
/// none where that is 0. Two lights on different scales have the same ones but for rounding.
std::vector<double> relative_values(const MeasuredSpectrum& light);

/// True if two spectra are one on different scales: no value over the visible range differs by more than 1e-6
/// of the largest.
bool same_light(const MeasuredSpectrum& a, const MeasuredSpectrum& b);

}  // namespace spectile
