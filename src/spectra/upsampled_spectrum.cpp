// UpsampledSpectrum: what an RGB colour became, at any wavelength.
#include <algorithm>
#include <cmath>
#include <spectile/spectra/spectrum.hpp>

#include "src/base/errors.hpp"
#include "src/spectra/quadrature.hpp"

namespace spectile {
namespace {

/// The sigmoid of the quadratic at a wavelength. Source: Jakob, Hanika 2019; lambda = (nm - 550) / 150.
double sigmoid(const std::array<float, 3>& c, double lambda_nm) {
  const double l = (lambda_nm - 550) / 150;
  const double x =
      (static_cast<double>(c[0]) * l + static_cast<double>(c[1])) * l + static_cast<double>(c[2]);
  const double root = std::sqrt(1 + x * x);
  // From the side where nothing cancels.
  return x < 0 ? 0.5 / (root * (root - x)) : 0.5 + 0.5 * x / root;
}

}  // namespace

double UpsampledSpectrum::operator()(double lambda_nm) const noexcept {
  if (std::isnan(lambda_nm)) return lambda_nm;
  const double held = std::clamp(lambda_nm, first_nm_, last_nm_);
  if (!sigmoid_) return table_->at(held);
  const double white = table_ ? table_->at(held) : 1.0;
  return sigmoid(c_, held) * white * static_cast<double>(scale_);
}

double UpsampledSpectrum::max_value() const noexcept {
  if (!sigmoid_) return *std::max_element(table_->values().begin(), table_->values().end());
  double best = std::max((*this)(first_nm_), (*this)(last_nm_));
  if (!table_) {
    // A sigmoid rises and falls with its quadratic: the other place for a maximum is the vertex.
    const double vertex = c_[0] < 0 ? -0.5 * static_cast<double>(c_[1]) / static_cast<double>(c_[0]) : 0;
    return std::max(best, (*this)(c_[0] < 0 ? 550 + 150 * vertex : first_nm_));
  }
  constexpr double kStepsPerNm = 10;
  const auto steps = static_cast<std::size_t>((last_nm_ - first_nm_) * kStepsPerNm);
  for (std::size_t i = 0; i <= steps; ++i) {
    best = std::max(best, (*this)(first_nm_ + static_cast<double>(i) / kStepsPerNm));
  }
  for (const double nm : table_->wavelengths_nm()) best = std::max(best, (*this)(nm));
  return best;
}

double UpsampledSpectrum::integral(double first_nm, double last_nm) const noexcept {
  if (!(last_nm > first_nm)) return 0;
  if (!sigmoid_) return table_->integral(first_nm, last_nm);
  double sum = 0;
  if (first_nm < first_nm_) sum += (std::min(last_nm, first_nm_) - first_nm) * (*this)(first_nm_);
  if (last_nm > last_nm_) sum += (last_nm - std::max(first_nm, last_nm_)) * (*this)(last_nm_);
  const double from = std::max(first_nm, first_nm_);
  const double to = std::min(last_nm, last_nm_);
  if (!(to > from)) return sum;
  double at = from;
  if (table_) {
    for (const double nm : table_->wavelengths_nm()) {
      if (nm <= at || nm >= to) continue;
      sum += quadrature::adaptive(*this, at, nm, 1e-10);
      at = nm;
    }
  }
  return sum + quadrature::adaptive(*this, at, to, 1e-10);
}

std::string UpsampledSpectrum::to_text() const {
  return fmt::format("{} of RGB {} {} {} by {}, {} to {} nm", to_string(quantity_), rgb_[0], rgb_[1], rgb_[2],
                     to_string(method_), first_nm_, last_nm_);
}

}  // namespace spectile
