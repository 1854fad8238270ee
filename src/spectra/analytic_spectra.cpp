// Distributions given by formulas: black body and sum of Gaussians.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <spectile/constants.hpp>
#include <spectile/spectra/spectrum.hpp>

#include "src/base/errors.hpp"
#include "src/spectra/quadrature.hpp"

namespace spectile {
namespace {

constexpr double kPlanck = kPlanckConstant.value();        // J s
constexpr double kLight = kSpeedOfLight.value();           // m/s
constexpr double kBoltzmann = kBoltzmannConstant.value();  // J/K
constexpr double kNmInMetres = 1e-9;                       // m

/// Planck's law per nanometre. Units: W/(m^2 sr nm).
double planck(double lambda_nm, double temperature_k) {
  const double lambda = lambda_nm * kNmInMetres;
  const double x = kPlanck * kLight / (lambda * kBoltzmann * temperature_k);
  const double power = lambda * lambda * lambda * lambda * lambda;
  return 2 * kPlanck * kLight * kLight / power / std::expm1(x) * kNmInMetres;
}

/// Integral of u^3 / (exp(u) - 1) from 0 to x, for x below 1, by Bernoulli's numbers: B_n x^(n + 3) / (n! (n
/// + 3)).
double below(double x) {
  constexpr double kTerms[] = {1.0 / 3,
                               -1.0 / 8,
                               1.0 / 60,
                               -1.0 / 5040,
                               1.0 / 272160,
                               -1.0 / 13305600,
                               1.0 / 622702080,
                               -691.0 / 19615115520000,
                               1.0 / 1270312243200};
  const double x2 = x * x;
  double even = 0;
  for (int i = 8; i >= 2; --i) even = even * x2 + kTerms[i];
  return x * x2 * (kTerms[0] + x * kTerms[1] + x2 * even);
}

/// The same from x to infinity.
double tail(double x) {
  if (x < 1) return std::pow(std::numbers::pi, 4) / 15 - below(x);
  double sum = 0;
  for (int n = 1; n < 60; ++n) {
    const double e = std::exp(-n * x);
    const double term = e * (x * x * x / n + 3 * x * x / (n * n) + 6 * x / (n * n * n) + 6.0 / n / n / n / n);
    sum += term;
    if (!(term > 1e-17 * sum)) break;
  }
  return sum;
}

}  // namespace

Result<BlackbodySpectrum> BlackbodySpectrum::create(double temperature_k, Scale scale) {
  if (!(temperature_k >= 1 && temperature_k <= 1e9)) {
    return make_error(ErrorCode::kBadArgument, "a black body's temperature is 1 to 1e9 K, not {} K",
                      temperature_k);
  }
  BlackbodySpectrum out;
  out.temperature_k_ = temperature_k;
  out.scale_ = scale;
  const double peak_nm = kPlanck * kLight / (kBoltzmann * temperature_k * kWienRoot) / kNmInMetres;
  if (scale == Scale::kNormalized) out.factor_ = 1 / planck(peak_nm, temperature_k);
  return out;
}

double BlackbodySpectrum::operator()(double lambda_nm) const noexcept {
  if (!(lambda_nm > 0)) return std::isnan(lambda_nm) ? lambda_nm : 0;
  const double value = factor_ * planck(lambda_nm, temperature_k_);
  // An infinite wavelength, or one so short that its fifth power is 0.
  return std::isfinite(value) ? value : 0;
}

double BlackbodySpectrum::max_value() const noexcept {
  if (scale_ == Scale::kNormalized) return 1;
  return planck(kPlanck * kLight / (kBoltzmann * temperature_k_ * kWienRoot) / kNmInMetres, temperature_k_);
}

double BlackbodySpectrum::integral(double first_nm, double last_nm) const noexcept {
  const double from = std::max(first_nm, 0.0);
  if (!(last_nm > from)) return 0;
  // Narrow ranges would be lost in the difference of two series.
  if (last_nm < 4 * from) return quadrature::adaptive(*this, from, last_nm, 1e-13);
  const double unit = kPlanck * kLight / (kNmInMetres * kBoltzmann * temperature_k_);  // nm
  const double whole =
      2 * kPlanck * kLight * kLight * std::pow(kBoltzmann * temperature_k_ / (kPlanck * kLight), 4);
  // Far beyond the peak both tails are nearly the whole.
  if (unit < from) return factor_ * whole * (below(unit / from) - below(unit / last_nm));
  return factor_ * whole * (tail(unit / last_nm) - (from > 0 ? tail(unit / from) : 0));
}

std::string BlackbodySpectrum::to_text() const {
  return fmt::format("blackbody at {} K, {}", temperature_k_,
                     scale_ == Scale::kAbsolute ? "W/(m^2 sr nm)" : "normalised to a maximum of 1");
}

Result<GaussianSumSpectrum> GaussianSumSpectrum::from_lobes(std::vector<Lobe> lobes) {
  if (lobes.empty()) return make_error(ErrorCode::kBadArgument, "a sum of Gaussians needs at least one");
  for (std::size_t i = 0; i < lobes.size(); ++i) {
    const Lobe& l = lobes[i];
    const bool finite = std::isfinite(l.amplitude) && std::isfinite(l.mean_nm) &&
                        std::isfinite(l.sigma_left_nm) && std::isfinite(l.sigma_right_nm);
    if (!finite || !(l.sigma_left_nm > 0) || !(l.sigma_right_nm > 0)) {
      return make_error(
          ErrorCode::kBadArgument,
          "Gaussian {} has amplitude {}, mean {} nm, widths {} and {} nm; all must be finite and "
          "the widths above 0",
          i + 1, l.amplitude, l.mean_nm, l.sigma_left_nm, l.sigma_right_nm);
    }
  }
  GaussianSumSpectrum out;
  out.lobes_ = std::make_shared<const std::vector<Lobe>>(std::move(lobes));
  return out;
}

double GaussianSumSpectrum::operator()(double lambda_nm) const noexcept {
  double sum = 0;
  for (const Lobe& l : *lobes_) {
    const double z = (lambda_nm - l.mean_nm) / (lambda_nm < l.mean_nm ? l.sigma_left_nm : l.sigma_right_nm);
    sum += l.amplitude * std::exp(-0.5 * z * z);
  }
  return sum;
}

double GaussianSumSpectrum::max_value() const noexcept {
  // Local maxima lie between the outermost lobes; each is bracketed on a grid finer than any lobe.
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  double finest = first;
  for (const Lobe& l : *lobes_) {
    first = std::min(first, l.mean_nm - l.sigma_left_nm);
    last = std::max(last, l.mean_nm + l.sigma_right_nm);
    finest = std::min({finest, l.sigma_left_nm, l.sigma_right_nm});
  }
  std::vector<double> places;
  for (const Lobe& l : *lobes_) places.push_back(l.mean_nm);
  constexpr double kMaxPlaces = 100000;
  const double step = std::max(finest / 8, (last - first) / kMaxPlaces);
  const auto count = static_cast<std::size_t>(std::min(kMaxPlaces, (last - first) / step));
  for (std::size_t i = 0; i <= count; ++i) places.push_back(first + static_cast<double>(i) * step);
  double best = 0;
  for (const double place : places) {
    if (!((*this)(place) >= 0.9 * best)) continue;
    // By thirds between the neighbours.
    double a = place - step;
    double b = place + step;
    for (int i = 0; i < 40; ++i) {
      const double third = (b - a) / 3;
      if ((*this)(a + third) < (*this)(b - third)) {
        a += third;
      } else {
        b -= third;
      }
    }
    best = std::max({best, (*this)(place), (*this)(0.5 * (a + b))});
  }
  return best;
}

double GaussianSumSpectrum::integral(double first_nm, double last_nm) const noexcept {
  if (!(last_nm > first_nm)) return 0;
  const auto half = [](double z) {
    return std::sqrt(std::numbers::pi / 2) * std::erf(z / std::numbers::sqrt2);
  };
  double sum = 0;
  for (const Lobe& l : *lobes_) {
    const auto from_mean = [&](double nm) {
      const double sigma = nm < l.mean_nm ? l.sigma_left_nm : l.sigma_right_nm;
      return sigma * half((nm - l.mean_nm) / sigma);
    };
    sum += l.amplitude * (from_mean(last_nm) - from_mean(first_nm));
  }
  return sum;
}

std::string GaussianSumSpectrum::to_text() const {
  std::string out = lobes_->size() == 1 ? "Gaussian" : "sum of Gaussians";
  for (std::size_t i = 0; i < lobes_->size(); ++i) {
    const Lobe& l = (*lobes_)[i];
    out +=
        fmt::format("{} {} at {} nm, sigma {}", i == 0 ? "" : ";", l.amplitude, l.mean_nm, l.sigma_left_nm);
    if (l.sigma_right_nm != l.sigma_left_nm) out += fmt::format(" and {}", l.sigma_right_nm);
    out += " nm";
  }
  return out;
}

}  // namespace spectile
