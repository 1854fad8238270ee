// Spectrum: a continuous spectral distribution of any kind as one value type, with exact integrals.
#pragma once

#include <array>
#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/spectra/measured_spectrum.hpp>
#include <spectile/spectra/observer.hpp>
#include <string>
#include <variant>
#include <vector>

namespace spectile {

/// Operations common to all distributions, beside operator(), integral(), max_value() and to_text().
template <class Distribution>
class SpectrumOperations {
 public:
  /// Values at any wavelengths. Units: nm.
  std::vector<double> sample(std::span<const double> wavelengths_nm) const {
    std::vector<double> out;
    out.reserve(wavelengths_nm.size());
    for (const double nm : wavelengths_nm) out.push_back(self()(nm));
    return out;
  }
  /// Averages over each band: the integral over it, divided by its width. Shapes: one value a band.
  std::vector<float> average_over(const Bands& bands) const {
    std::vector<float> out;
    out.reserve(bands.count());
    for (const Band& band : bands.list()) {
      out.push_back(static_cast<float>(self().integral(band.lower_nm, band.upper_nm) / band.width_nm()));
    }
    return out;
  }
  /// For the distributions' own: there is nothing to compare here.
  friend bool operator==(const SpectrumOperations&, const SpectrumOperations&) = default;

 private:
  const Distribution& self() const { return static_cast<const Distribution&>(*this); }
};

/// The same value at every wavelength.
class ConstantSpectrum : public SpectrumOperations<ConstantSpectrum> {
 public:
  explicit ConstantSpectrum(double value = 0) : value_(value) {}
  double value() const noexcept { return value_; }
  double operator()(double /*lambda_nm*/) const noexcept { return value_; }
  double max_value() const noexcept { return value_; }
  /// Exact; 0 where last is not above first.
  double integral(double first_nm, double last_nm) const noexcept;
  std::string to_text() const;
  friend bool operator==(const ConstantSpectrum&, const ConstantSpectrum&) = default;

 private:
  double value_;
};

/// Linear between samples at irregular wavelengths. Outside them it is 0, as what a lamp emits and a sensor's
/// response are where nobody measured, or keeps the nearest sample, as a reflectance.
class PiecewiseLinearSpectrum : public SpectrumOperations<PiecewiseLinearSpectrum> {
 public:
  /// Errors and order as for MeasuredSpectrum::from_samples: sorted, and two samples at one wavelength are a
  /// step there.
  static Result<PiecewiseLinearSpectrum> from_samples(std::span<const double> wavelengths_nm,
                                                      std::span<const double> values,
                                                      Ends ends = Ends::kZero);
  /// The samples of a measured spectrum; not its ends.
  explicit PiecewiseLinearSpectrum(MeasuredSpectrum samples, Ends ends = Ends::kZero);

  /// At a step, the value on its right; at the last sample, that sample.
  double operator()(double lambda_nm) const noexcept;
  /// The largest sample, but not below 0 where it is that outside.
  double max_value() const noexcept;
  /// Exact; 0 where last is not above first.
  double integral(double first_nm, double last_nm) const noexcept;
  std::string to_text() const;

  PiecewiseLinearSpectrum scaled(double factor) const;
  /// The same samples with constant ends.
  const MeasuredSpectrum& measured() const noexcept { return *samples_; }
  Ends ends() const noexcept { return ends_; }
  std::span<const double> wavelengths_nm() const noexcept { return samples_->wavelengths_nm(); }
  std::span<const double> values() const noexcept { return samples_->values(); }
  friend bool operator==(const PiecewiseLinearSpectrum& a, const PiecewiseLinearSpectrum& b);

 private:
  std::shared_ptr<const MeasuredSpectrum> samples_;  // with constant ends
  Ends ends_ = Ends::kZero;
};

class Spectrum;

/// A table at every nanometre, linear in between and 0 outside: the quickest to look up.
class DenselySampledSpectrum : public SpectrumOperations<DenselySampledSpectrum> {
 public:
  /// Tabulates a spectrum at whole nanometres. Units: nm. Errors: kBadArgument where last is not above first
  /// or the range holds more than 100000 nm.
  static Result<DenselySampledSpectrum> from(const Spectrum& spectrum,
                                             int first_nm = static_cast<int>(kFirstVisibleNm),
                                             int last_nm = static_cast<int>(kLastVisibleNm));
  /// From one value for every nanometre from first_nm on. Errors: kBadArgument for fewer than two values or
  /// one that is not finite.
  static Result<DenselySampledSpectrum> from_values(int first_nm, std::vector<double> values);

  double operator()(double lambda_nm) const noexcept;
  /// Not below 0, which it is outside.
  double max_value() const noexcept;
  /// Exact; 0 where last is not above first.
  double integral(double first_nm, double last_nm) const noexcept;
  std::string to_text() const;
  int first_nm() const noexcept { return first_nm_; }
  int last_nm() const noexcept { return first_nm_ + static_cast<int>(values_->size()) - 1; }
  std::span<const double> values() const noexcept { return *values_; }
  friend bool operator==(const DenselySampledSpectrum& a, const DenselySampledSpectrum& b);

 private:
  DenselySampledSpectrum() = default;
  int first_nm_ = 0;
  std::shared_ptr<const std::vector<double>> values_;
};

/// Thermal radiation of a black body.
/// Source: Planck's law; constants of the SI (2019), exact: h, c, k.
class BlackbodySpectrum : public SpectrumOperations<BlackbodySpectrum> {
 public:
  /// How it is scaled.
  enum class Scale {
    kAbsolute,    ///< W/(m^2 sr nm)
    kNormalized,  ///< 1 at the wavelength of its maximum
  };
  /// Units: K. Errors: kBadArgument for a temperature that is not finite, below 1 or above 1e9.
  static Result<BlackbodySpectrum> create(double temperature_k, Scale scale = Scale::kAbsolute);

  double temperature_k() const noexcept { return temperature_k_; }
  Scale scale() const noexcept { return scale_; }
  /// 0 at wavelengths not above 0. From 1e-3 to 1e15 nm the relative error is below 1e-13, or 2^-51 h c /
  /// (lambda k T) where that is more: far below the peak, where there is next to nothing.
  double operator()(double lambda_nm) const noexcept;
  /// At the wavelength of Wien's displacement law, visible or not.
  double max_value() const noexcept;
  /// By series, to a relative 1e-11 within the range of double; `last_nm` may be infinite. Source: Widger,
  /// Woodall, Integration of the Planck Blackbody Radiation Function, Bulletin of the American Meteorological
  /// Society 57(10), 1976.
  double integral(double first_nm, double last_nm) const noexcept;
  std::string to_text() const;
  friend bool operator==(const BlackbodySpectrum&, const BlackbodySpectrum&) = default;

 private:
  BlackbodySpectrum() = default;
  double temperature_k_ = 0;
  Scale scale_ = Scale::kAbsolute;
  double factor_ = 1;
};

/// A sum of Gaussians whose two halves may differ in width: analytic fits of observers, lasers, LEDs.
class GaussianSumSpectrum : public SpectrumOperations<GaussianSumSpectrum> {
 public:
  /// amplitude * exp(-((lambda - mean) / sigma)^2 / 2), with the sigma of lambda's side. Units: nm.
  struct Lobe {
    double amplitude = 0;
    double mean_nm = 0;
    double sigma_left_nm = 1;
    double sigma_right_nm = 1;
    friend bool operator==(const Lobe&, const Lobe&) = default;
  };
  /// Errors: kBadArgument for no lobe, a number that is not finite, a sigma not above 0.
  static Result<GaussianSumSpectrum> from_lobes(std::vector<Lobe> lobes);

  double operator()(double lambda_nm) const noexcept;
  /// The largest of its local maxima, found by search, to a relative 1e-6.
  double max_value() const noexcept;
  /// By the error function; `first_nm`, `last_nm` may be infinite.
  double integral(double first_nm, double last_nm) const noexcept;
  std::string to_text() const;
  std::span<const Lobe> lobes() const noexcept { return *lobes_; }
  friend bool operator==(const GaussianSumSpectrum& a, const GaussianSumSpectrum& b);

 private:
  GaussianSumSpectrum() = default;
  std::shared_ptr<const std::vector<Lobe>> lobes_;
};

/// The spectrum of an RGB colour as an upsampling method defines it between and beyond the centres of its
/// bands (see rgb_spectrum()): a table, linear in between, or a sigmoid, times a light's table where it is a
/// light; beyond the outer centres it keeps the value there.
class UpsampledSpectrum : public SpectrumOperations<UpsampledSpectrum> {
 public:
  /// The parts that make it up.
  struct Parts {
    std::string method;    ///< name, for to_text()
    std::string quantity;  ///< name, for to_text()
    std::array<double, 3> rgb{};
    double first_nm = 0;  ///< the outer centres
    double last_nm = 0;
    std::optional<std::array<float, 3>> sigmoid;  ///< coefficients; none for a table alone
    std::optional<Observer> observer;             ///< whose functions the sigmoid is of; none for a quadratic
    float scale = 1;                              ///< of the sigmoid
    /// Samples at the centres: of the spectrum itself, or of the light that a sigmoid is multiplied by. May
    /// be null for a sigmoid.
    std::shared_ptr<const MeasuredSpectrum> table;
  };
  /// Errors: kBadArgument for neither sigmoid nor table.
  static Result<UpsampledSpectrum> create(Parts parts);

  double operator()(double lambda_nm) const noexcept;
  /// Over the range of its bands; a sigmoid times a light at every 0.1 nm.
  double max_value() const noexcept;
  /// Exact where it is linear; a sigmoid's by Gauss-Legendre quadrature to a relative 1e-9.
  double integral(double first_nm, double last_nm) const noexcept;
  std::string to_text() const;
  const std::array<double, 3>& rgb() const noexcept { return parts_.rgb; }
  bool is_sigmoid() const noexcept { return parts_.sigmoid.has_value(); }
  /// Of a sigmoid only.
  const std::array<float, 3>& coefficients() const noexcept { return *parts_.sigmoid; }
  /// Whose functions the sigmoid is of; none for a quadratic.
  std::optional<Observer> observer() const noexcept { return parts_.observer; }
  float scale() const noexcept { return parts_.scale; }
  const MeasuredSpectrum* table() const noexcept { return parts_.table.get(); }
  double first_nm() const noexcept { return parts_.first_nm; }
  double last_nm() const noexcept { return parts_.last_nm; }
  friend bool operator==(const UpsampledSpectrum& a, const UpsampledSpectrum& b);

 private:
  explicit UpsampledSpectrum(Parts parts) : parts_(std::move(parts)) {}
  Parts parts_;
};

/// A sum of products of spectra, each times a factor: several lamps, light through a filter, lines on a
/// smooth ground. Made by the operators below.
class CombinedSpectrum : public SpectrumOperations<CombinedSpectrum> {
 public:
  struct Term;  ///< factor times the product of some spectra
  explicit CombinedSpectrum(std::vector<Term> terms);

  double operator()(double lambda_nm) const noexcept;
  /// The largest value where one of its parts has a sample or a lobe, or at a nanometre that is seen.
  double max_value() const;
  /// As inner_product().
  double integral(double first_nm, double last_nm) const;
  std::string to_text() const;
  std::span<const Term> terms() const noexcept;
  friend bool operator==(const CombinedSpectrum& a, const CombinedSpectrum& b);

 private:
  std::shared_ptr<const std::vector<Term>> terms_;
};

/// Any distribution. Cheap to copy.
class Spectrum : public SpectrumOperations<Spectrum> {
 public:
  using Kind = std::variant<ConstantSpectrum, PiecewiseLinearSpectrum, DenselySampledSpectrum,
                            BlackbodySpectrum, GaussianSumSpectrum, UpsampledSpectrum, CombinedSpectrum>;
  template <class Distribution>
  requires std::constructible_from<Kind, Distribution> Spectrum(Distribution distribution)
      : kind_(std::move(distribution)) {}  // NOLINT(*-explicit-*)
  /// Its samples and its ends.
  Spectrum(const MeasuredSpectrum& samples)  // NOLINT(*-explicit-*)
      : kind_(PiecewiseLinearSpectrum(samples, samples.ends())) {}

  /// Which distribution it is; std::visit it once, outside any loop.
  const Kind& kind() const noexcept { return kind_; }
  double operator()(double lambda_nm) const noexcept;  // NOLINT(bugprone-exception-escape)
  double max_value() const;
  double integral(double first_nm = kFirstVisibleNm, double last_nm = kLastVisibleNm) const;
  /// One line that says what it is.
  std::string to_text() const;

  /// Exact, of any two; NaN where values are. What is beyond a part's ends is that part's: 0 or held.
  friend Spectrum operator+(const Spectrum& a, const Spectrum& b);
  friend Spectrum operator-(const Spectrum& a, const Spectrum& b);
  friend Spectrum operator*(const Spectrum& a, const Spectrum& b);
  friend Spectrum operator*(double factor, const Spectrum& spectrum);
  /// The same distribution with the same numbers.
  friend bool operator==(const Spectrum& a, const Spectrum& b);

 private:
  Kind kind_;
};

struct CombinedSpectrum::Term {
  double factor = 1;
  std::vector<Spectrum> of = {};
  friend bool operator==(const Term&, const Term&) = default;
};

/// The spectrum times the factor that gives it this luminance: Y of the CIE 1931 observer, over the visible
/// range, relative to a spectrum that is 1 throughout. Errors: kBadArgument for one without luminance.
Result<Spectrum> with_luminance(const Spectrum& spectrum, double y = 1);
/// The same for max_value(). Errors: kBadArgument for one whose maximum is not above 0, or not finite.
Result<Spectrum> with_maximum(const Spectrum& spectrum, double maximum = 1);

/// A function of the wavelength as a table, linear between its samples. Units: nm. Errors: kBadArgument for a
/// range that does not ascend, a step not above 0, more than 100000 steps, or a value that is not finite.
Result<Spectrum> sampled_function(const std::function<double(double lambda_nm)>& function,
                                  double first_nm = kFirstVisibleNm, double last_nm = kLastVisibleNm,
                                  double step_nm = 1, Ends ends = Ends::kZero);

/// A line of an emission spectrum.
struct EmissionLine {
  double lambda_nm = 0;
  double power = 0;  ///< its integral
};
/// Lines as triangles, `width_nm` wide at half their height, whose integrals are their powers; added where
/// they overlap. Units: nm. Errors: kBadArgument for no lines, numbers that are not finite, a width not above
/// 0.
Result<Spectrum> emission_lines(std::span<const EmissionLine> lines, double width_nm = 0.5);

/// Integral of the product of two spectra: exact where both are piecewise linear, else by Gauss-Legendre
/// quadrature between their samples to a relative 1e-9 of the integral of the product's magnitude. Limits
/// must be finite.
double inner_product(const Spectrum& a, const Spectrum& b, double first_nm = kFirstVisibleNm,
                     double last_nm = kLastVisibleNm);

/// The same of three spectra: a sensor's curve, a light, a reflectance.
double inner_product(const Spectrum& a, const Spectrum& b, const Spectrum& c,
                     double first_nm = kFirstVisibleNm, double last_nm = kLastVisibleNm);

/// Daylight of a correlated colour temperature, 300 to 830 nm, 100 at 560 nm.
/// Units: K (the scale of 1968 and later: D65 is 6504 K). Errors: kBadArgument outside 4000 to 25000 K.
/// Source: CIE 015:2018, 4.1.2: chromaticity, M1 and M2 rounded to three decimals, S0, S1, S2 at 5 nm.
Result<PiecewiseLinearSpectrum> daylight_spectrum(double temperature_k);
/// Its chromaticity (x, y). Errors and source as for daylight_spectrum().
Result<std::array<double, 2>> daylight_chromaticity(double temperature_k);

}  // namespace spectile
