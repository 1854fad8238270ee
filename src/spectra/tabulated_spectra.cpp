// Distributions given by numbers: constant, piecewise linear, dense.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <spectile/spectra/spectrum.hpp>

#include "src/base/errors.hpp"

namespace spectile {

double ConstantSpectrum::integral(double first_nm, double last_nm) const noexcept {
  return last_nm > first_nm && value_ != 0 ? value_ * (last_nm - first_nm) : 0.0;
}

std::string ConstantSpectrum::to_text() const {
  return fmt::format("constant {}", value_);
}

Result<PiecewiseLinearSpectrum> PiecewiseLinearSpectrum::from_samples(std::span<const double> wavelengths_nm,
                                                                      std::span<const double> values,
                                                                      Ends ends) {
  SPECTILE_ASSIGN(auto samples, MeasuredSpectrum::from_samples(wavelengths_nm, values));
  return PiecewiseLinearSpectrum(std::move(samples), ends);
}

PiecewiseLinearSpectrum::PiecewiseLinearSpectrum(MeasuredSpectrum samples, Ends ends)
    : samples_(std::make_shared<const MeasuredSpectrum>(
          samples.ends() == Ends::kHeld ? std::move(samples) : samples.with_ends(Ends::kHeld))),
      ends_(ends) {}

double PiecewiseLinearSpectrum::operator()(double lambda_nm) const noexcept {
  const auto w = samples_->wavelengths_nm();
  if (ends_ == Ends::kZero && (lambda_nm < w.front() || lambda_nm > w.back())) return 0;
  if (std::isnan(lambda_nm)) return lambda_nm;
  return samples_->at(lambda_nm);
}

double PiecewiseLinearSpectrum::max_value() const noexcept {
  const double largest = *std::max_element(values().begin(), values().end());
  return ends_ == Ends::kZero ? std::max(0.0, largest) : largest;
}

double PiecewiseLinearSpectrum::integral(double first_nm, double last_nm) const noexcept {
  if (ends_ == Ends::kHeld) return samples_->integral(first_nm, last_nm);
  const auto w = samples_->wavelengths_nm();
  return samples_->integral(std::max(first_nm, w.front()), std::min(last_nm, w.back()));
}

std::string PiecewiseLinearSpectrum::to_text() const {
  const auto w = samples_->wavelengths_nm();
  if (w.size() == 1) return fmt::format("piecewise linear, 1 sample at {} nm", w.front());
  return fmt::format("piecewise linear, {} samples from {} to {} nm", w.size(), w.front(), w.back());
}

PiecewiseLinearSpectrum PiecewiseLinearSpectrum::scaled(double factor) const {
  return PiecewiseLinearSpectrum(samples_->scaled(factor), ends_);
}

namespace {
constexpr int kMaxNanometres = 100000;
}

Result<DenselySampledSpectrum> DenselySampledSpectrum::from(const Spectrum& spectrum, int first_nm,
                                                            int last_nm) {
  const std::int64_t count = std::int64_t{last_nm} - first_nm;
  if (count < 1 || count > kMaxNanometres) {
    return make_error(ErrorCode::kBadArgument, "a table from {} to {} nm holds {} nm; it takes 1 to {}",
                      first_nm, last_nm, count, kMaxNanometres);
  }
  std::vector<double> values;
  std::visit(
      [&](const auto& s) {
        for (std::int64_t i = 0; i <= count; ++i) values.push_back(s(static_cast<double>(first_nm + i)));
      },
      spectrum.kind());
  return from_values(first_nm, std::move(values));
}

Result<DenselySampledSpectrum> DenselySampledSpectrum::from_values(int first_nm, std::vector<double> values) {
  if (values.size() < 2 || values.size() > kMaxNanometres + 1) {
    return make_error(ErrorCode::kBadArgument, "a table at every nanometre takes 2 to {} values, not {}",
                      kMaxNanometres + 1, values.size());
  }
  if (std::int64_t{first_nm} + static_cast<std::int64_t>(values.size()) - 1 >
      std::numeric_limits<int>::max()) {
    return make_error(ErrorCode::kBadArgument, "a table of {} nm from {} nm on is beyond what can be counted",
                      values.size(), first_nm);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      return make_error(ErrorCode::kBadArgument, "the value at {} nm is {}; it must be finite",
                        first_nm + static_cast<std::int64_t>(i), values[i]);
    }
  }
  DenselySampledSpectrum out;
  out.first_nm_ = first_nm;
  out.values_ = std::make_shared<const std::vector<double>>(std::move(values));
  return out;
}

double DenselySampledSpectrum::operator()(double lambda_nm) const noexcept {
  const double at = lambda_nm - first_nm_;
  const std::vector<double>& v = *values_;
  if (!(at >= 0 && at <= static_cast<double>(v.size() - 1))) return std::isnan(at) ? at : 0;
  const std::size_t i = std::min(static_cast<std::size_t>(at), v.size() - 2);
  const double t = at - static_cast<double>(i);
  return (1 - t) * v[i] + t * v[i + 1];
}

double DenselySampledSpectrum::max_value() const noexcept {
  return std::max(0.0, *std::max_element(values_->begin(), values_->end()));
}

double DenselySampledSpectrum::integral(double first_nm, double last_nm) const noexcept {
  const double from = std::max(first_nm, static_cast<double>(first_nm_));
  const double to = std::min(last_nm, static_cast<double>(this->last_nm()));
  if (!(to > from)) return 0;
  double sum = 0;
  for (double at = from; at < to;) {
    const double next = std::min(std::floor(at) + 1, to);
    sum += (next - at) * (*this)(0.5 * (at + next));
    at = next;
  }
  return sum;
}

std::string DenselySampledSpectrum::to_text() const {
  return fmt::format("densely sampled, every nanometre from {} to {} nm", first_nm(), last_nm());
}

}  // namespace spectile
