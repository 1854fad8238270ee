// MeasuredSpectrum: a spectrum given as (wavelength, value) samples, linear in between, with exact integrals.
#pragma once

#include <span>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// Value of a table beyond its first and last sample.
enum class Ends {
  kZero,  ///< 0: what a lamp emits, or a sensor sees, where nobody measured
  kHeld,  ///< the nearest sample: a reflectance
};

/// A piecewise-linear spectrum; beyond both ends constant, or 0. Immutable; holds its own sorted copy of the
/// samples.
class MeasuredSpectrum {
 public:
  /// From samples in any order, which are not changed.
  /// Shapes: as many values as wavelengths, at least one. Units: nm.
  /// Two samples at one wavelength are a step there (the first given on its left, the last on its right).
  /// Errors: kSizeMismatch; kBadArgument for no samples, or for one that is not finite.
  static Result<MeasuredSpectrum> from_samples(std::span<const double> wavelengths_nm,
                                               std::span<const double> values, Ends ends = Ends::kHeld);

  /// The same samples, with the given value beyond them.
  MeasuredSpectrum with_ends(Ends ends) const;
  Ends ends() const noexcept { return ends_; }

  /// Value at a wavelength; at a step, the value on its right; at the last sample, that sample. Units: nm.
  double at(double lambda_nm) const noexcept;

  /// Exact integral from `first_nm` to `last_nm`; 0 where the latter is not above the former.
  double integral(double first_nm, double last_nm) const noexcept;

  /// Exact averages over each band. Shapes: one value a band.
  std::vector<float> average_over(const Bands& bands) const;

  /// The same spectrum times a factor.
  MeasuredSpectrum scaled(double factor) const;

  std::span<const double> wavelengths_nm() const noexcept { return wavelengths_nm_; }
  std::span<const double> values() const noexcept { return values_; }

 private:
  MeasuredSpectrum() = default;
  std::vector<double> wavelengths_nm_;
  std::vector<double> values_;
  Ends ends_ = Ends::kHeld;
};

/// Exact averages over each band of the piecewise-linear spectrum through samples in any order, constant
/// beyond both ends. Shapes, units and errors as for MeasuredSpectrum::from_samples.
Result<std::vector<float>> average_over(const Bands& bands, std::span<const double> wavelengths_nm,
                                        std::span<const double> values);

/// Exact integral from `first_nm` to `last_nm` of the product of two spectra.
double product_integral(const MeasuredSpectrum& a, const MeasuredSpectrum& b, double first_nm,
                        double last_nm);

/// A CIE illuminant by name (A, C, D50, D55, D60, D65, D75, E, FL1 to FL12, HP1, LED-B1, LED-B3, LED-RGB1),
/// whatever its case, on its published scale; 0 beyond the published range. Errors: kUnknownName, listing the
/// names. Source: CIE 015:2018.
Result<MeasuredSpectrum> illuminant(std::string_view name);

/// Names that illuminant() knows.
std::vector<std::string> illuminant_names();

/// The only spectrum of a file, as load_spectrum() reads it, held beyond its ends. Errors: those of
/// load_spectrum().
Result<MeasuredSpectrum> load_spectrum_csv(const std::string& path);

}  // namespace spectile
