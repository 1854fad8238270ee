// SigmoidFunctions: the two functions of the wavelength that sigmoids combine.
#include "src/spectra/sigmoid_functions.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "src/data/tables.hpp"

namespace spectile {
namespace {

/// Integral from the first sample to each, by trapezoids of width 1.
std::vector<double> integrated(const std::vector<double>& values) {
  std::vector<double> out(values.size(), 0.0);
  for (std::size_t i = 1; i < values.size(); ++i) out[i] = out[i - 1] + 0.5 * (values[i - 1] + values[i]);
  return out;
}

/// The double integral of a - b, each divided by its sum.
std::vector<double> integrated_difference(std::span<const double> a, std::span<const double> b) {
  double sum_a = 0;
  double sum_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_a += a[i];
    sum_b += b[i];
  }
  std::vector<double> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] / sum_a - b[i] / sum_b;
  return integrated(integrated(out));
}

/// Factors of two functions that take their differences at two places to what is wanted there.
std::array<double, 2> factors(const std::array<std::array<double, 2>, 2>& differences,
                              const std::array<double, 2>& wanted) {
  const auto& [first, second] = differences;
  const double determinant = first[0] * second[1] - first[1] * second[0];
  return {(wanted[0] * second[1] - wanted[1] * first[1]) / determinant,
          (wanted[1] * first[0] - wanted[0] * second[0]) / determinant};
}

}  // namespace

SigmoidFunctions::SigmoidFunctions(Observer observer) {
  const data::MatchingFunctions& curves = observer == Observer::kCie1964 ? data::kCie1964 : data::kCie1931;
  const std::vector<double> x = integrated_difference(curves.x_bar, curves.y_bar);
  const std::vector<double> z = integrated_difference(curves.z_bar, curves.y_bar);
  const auto index = [](double nm) { return static_cast<std::size_t>(nm - kFirstNm); };
  const std::size_t zero = index(550);
  const auto difference = [&](double nm) {
    return std::array{x[index(nm)] - x[zero], z[index(nm)] - z[zero]};
  };
  const std::array<std::array<double, 2>, 2> differences = {difference(450), difference(650)};
  const std::array<double, 2> p = factors(differences, {1, 1});
  const std::array<double, 2> q = factors(differences, {-1, 1});
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - x[zero];
    const double dz = z[i] - z[zero];
    table_.push_back({p[0] * dx + p[1] * dz, q[0] * dx + q[1] * dz});
  }
  for (std::size_t i = 0; i + 1 < table_.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      pairs_[k].push_back(static_cast<float>(table_[i][k]));
      pairs_[k].push_back(static_cast<float>(table_[i + 1][k] - table_[i][k]));
    }
  }
}

const SigmoidFunctions& SigmoidFunctions::of(std::optional<Observer> observer) {
  static const SigmoidFunctions quadratic;
  static const SigmoidFunctions cie1931(Observer::kCie1931);
  static const SigmoidFunctions cie1964(Observer::kCie1964);
  if (!observer) return quadratic;
  return *observer == Observer::kCie1964 ? cie1964 : cie1931;
}

std::array<double, 2> SigmoidFunctions::at(double wavelength_nm) const noexcept {
  if (are_quadratic()) {
    const double l = sigmoid_lambda(wavelength_nm);
    return {l * l, l};
  }
  const double place = std::clamp(wavelength_nm, kFirstNm, kLastNm) - kFirstNm;
  const std::size_t i = std::min(static_cast<std::size_t>(place), table_.size() - 2);
  const double t = place - static_cast<double>(i);
  std::array<double, 2> out{};
  for (std::size_t k = 0; k < 2; ++k) out[k] = table_[i][k] + t * (table_[i + 1][k] - table_[i][k]);
  return out;
}

std::array<float, 2> SigmoidFunctions::at_float(double wavelength_nm) const noexcept {
  if (are_quadratic()) {
    const double l = sigmoid_lambda(wavelength_nm);
    return {static_cast<float>(l * l), static_cast<float>(l)};
  }
  const float place =
      static_cast<float>(std::clamp(wavelength_nm, kFirstNm, kLastNm)) - static_cast<float>(kFirstNm);
  const std::size_t i = std::min(static_cast<std::size_t>(place), table_.size() - 2);
  const float part = place - static_cast<float>(i);
  std::array<float, 2> out{};
  for (std::size_t k = 0; k < 2; ++k) out[k] = pairs_[k][2 * i] + part * pairs_[k][2 * i + 1];
  return out;
}

}  // namespace spectile
