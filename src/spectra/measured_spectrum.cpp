// Piecewise-linear spectra with exact integrals, and the CIE illuminants by name.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <spectile/spectra/measured_spectrum.hpp>

#include "src/base/errors.hpp"
#include "src/data/tables.hpp"
#include "src/spectra/band_weights.hpp"

namespace spectile {

Result<MeasuredSpectrum> MeasuredSpectrum::from_samples(std::span<const double> wavelengths_nm,
                                                        std::span<const double> values, Ends ends) {
  if (wavelengths_nm.size() != values.size()) {
    return make_error(ErrorCode::kSizeMismatch, "the spectrum has {} wavelengths and {} values",
                      wavelengths_nm.size(), values.size());
  }
  if (values.empty()) return make_error(ErrorCode::kBadArgument, "the spectrum has no samples");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(wavelengths_nm[i]) || !std::isfinite(values[i])) {
      return make_error(ErrorCode::kBadArgument,
                        "sample {} of the spectrum is {} at {} nm; both must be finite", i + 1, values[i],
                        wavelengths_nm[i]);
    }
  }
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return wavelengths_nm[a] < wavelengths_nm[b]; });
  MeasuredSpectrum spectrum;
  spectrum.ends_ = ends;
  for (const std::size_t i : order) {
    spectrum.wavelengths_nm_.push_back(wavelengths_nm[i]);
    spectrum.values_.push_back(values[i]);
  }
  return spectrum;
}

MeasuredSpectrum MeasuredSpectrum::with_ends(Ends ends) const {
  MeasuredSpectrum out = *this;
  out.ends_ = ends;
  return out;
}

double MeasuredSpectrum::at(double lambda_nm) const noexcept {
  const auto& w = wavelengths_nm_;
  if (ends_ == Ends::kZero && (lambda_nm < w.front() || lambda_nm > w.back())) return 0;
  const auto above = std::upper_bound(w.begin(), w.end(), lambda_nm);
  if (above == w.begin()) return values_.front();
  if (above == w.end()) return values_.back();
  const auto i = static_cast<std::size_t>(above - w.begin());
  const double t = (lambda_nm - w[i - 1]) / (w[i] - w[i - 1]);
  return (1 - t) * values_[i - 1] + t * values_[i];
}

namespace {

/// Calls segment(a, b) for the pieces of [first, last] between `breaks`.
template <class Segment>
void for_segments(std::span<const double> breaks, double first, double last, Segment segment) {
  double from = first;
  for (auto it = std::upper_bound(breaks.begin(), breaks.end(), first); it != breaks.end() && *it < last;
       ++it) {
    if (*it > from) segment(from, *it);
    from = *it;
  }
  if (last > from) segment(from, last);
}

/// A spectrum restricted to a segment that holds none of its breaks inside: its values just within both ends.
struct EndValues {
  double left, right;
};

EndValues ends_within(const MeasuredSpectrum& s, double from, double to) {
  // Two points inside a straight piece give its ends, on the right side of a step.
  const double third = (to - from) / 3;
  const double a = s.at(from + third);
  const double b = s.at(to - third);
  return {2 * a - b, 2 * b - a};
}

}  // namespace

double MeasuredSpectrum::integral(double first_nm, double last_nm) const noexcept {
  double sum = 0;
  for_segments(wavelengths_nm_, first_nm, last_nm,
               [&](double from, double to) { sum += (to - from) * at(0.5 * (from + to)); });
  return sum;
}

std::vector<float> MeasuredSpectrum::average_over(const Bands& bands) const {
  std::vector<float> averages;
  averages.reserve(bands.count());
  for (std::size_t b = 0; b < bands.count(); ++b) {
    averages.push_back(static_cast<float>(sample_in(*this, bands, b)));
  }
  return averages;
}

MeasuredSpectrum MeasuredSpectrum::scaled(double factor) const {
  MeasuredSpectrum out = *this;
  for (double& v : out.values_) v *= factor;
  return out;
}

Result<std::vector<float>> average_over(const Bands& bands, std::span<const double> wavelengths_nm,
                                        std::span<const double> values) {
  SPECTILE_ASSIGN(const auto spectrum, MeasuredSpectrum::from_samples(wavelengths_nm, values));
  return spectrum.average_over(bands);
}

double product_integral(const MeasuredSpectrum& a, const MeasuredSpectrum& b, double first_nm,
                        double last_nm) {
  std::vector<double> breaks;
  std::merge(a.wavelengths_nm().begin(), a.wavelengths_nm().end(), b.wavelengths_nm().begin(),
             b.wavelengths_nm().end(), std::back_inserter(breaks));
  double sum = 0;
  for_segments(breaks, first_nm, last_nm, [&](double from, double to) {
    const EndValues p = ends_within(a, from, to);
    const EndValues q = ends_within(b, from, to);
    // The product is a parabola, for which Simpson's rule is exact.
    const double middle = 0.25 * (p.left + p.right) * (q.left + q.right);
    sum += (to - from) / 6 * (p.left * q.left + 4 * middle + p.right * q.right);
  });
  return sum;
}

Result<MeasuredSpectrum> illuminant(std::string_view name) {
  const auto same = [](char a, char b) {
    return std::toupper(static_cast<unsigned char>(a)) == std::toupper(static_cast<unsigned char>(b));
  };
  for (const data::NamedTable& table : data::illuminants()) {
    if (!std::ranges::equal(std::string_view(table.name), name, same)) continue;
    std::vector<double> wavelengths;
    for (std::size_t i = 0; i < table.values.size(); ++i) {
      wavelengths.push_back(table.first_nm + static_cast<double>(i) * table.step_nm);
    }
    return MeasuredSpectrum::from_samples(wavelengths, table.values, Ends::kZero);
  }
  return make_error(ErrorCode::kUnknownName, "illuminant \"{}\" is unknown; there are {}", name,
                    fmt::join(illuminant_names(), ", "));
}

std::vector<std::string> illuminant_names() {
  std::vector<std::string> names;
  for (const data::NamedTable& table : data::illuminants()) names.emplace_back(table.name);
  return names;
}

}  // namespace spectile
