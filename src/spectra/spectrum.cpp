// Spectrum: any distribution behind one value type, and products of two.
#include <algorithm>
#include <cmath>
#include <spectile/constants.hpp>
#include <spectile/spectra/spectrum.hpp>

#include "src/spectra/breaks.hpp"
#include "src/spectra/quadrature.hpp"

namespace spectile {
namespace {

// See breaks.hpp.
void add_breaks(const ConstantSpectrum& /*unused*/, std::vector<double>& /*unused*/) {}
void add_breaks(const BlackbodySpectrum& s, std::vector<double>& breaks) {
  // Octaves about the peak: over a very wide range bisection alone would not find it.
  double nm = kWienDisplacement.value() * 1e9 / s.temperature_k() / 64;
  for (int octave = 0; octave < 50; ++octave) {
    breaks.push_back(nm);
    nm *= 2;
  }
}
void add_breaks(const PiecewiseLinearSpectrum& s, std::vector<double>& breaks) {
  breaks.insert(breaks.end(), s.wavelengths_nm().begin(), s.wavelengths_nm().end());
}
void add_breaks(const DenselySampledSpectrum& s, std::vector<double>& breaks) {
  for (int nm = s.first_nm(); nm <= s.last_nm(); ++nm) breaks.push_back(nm);
}
void add_breaks(const GaussianSumSpectrum& s, std::vector<double>& breaks) {
  for (const auto& lobe : s.lobes()) {
    for (const double sigmas : {1.0, 2.0, 4.0, 8.0}) {
      breaks.push_back(lobe.mean_nm - sigmas * lobe.sigma_left_nm);
      breaks.push_back(lobe.mean_nm + sigmas * lobe.sigma_right_nm);
    }
    breaks.push_back(lobe.mean_nm);
  }
}
void add_breaks(const UpsampledSpectrum& s, std::vector<double>& breaks) {
  if (const MeasuredSpectrum* table = s.table()) {
    breaks.insert(breaks.end(), table->wavelengths_nm().begin(), table->wavelengths_nm().end());
  }
  breaks.push_back(s.first_nm());
  breaks.push_back(s.last_nm());
}

void add_breaks(const CombinedSpectrum& s, std::vector<double>& breaks) {
  for (const auto& term : s.terms()) {
    for (const Spectrum& part : term.of) spectile::add_breaks(part, breaks);
  }
}

/// A degree that no quadrature of two points is exact for.
constexpr int kSmooth = 4;

/// Degree of the polynomial that a distribution is between its breaks.
int degree_of(const Spectrum::Kind& kind) {
  if (std::holds_alternative<ConstantSpectrum>(kind)) return 0;
  if (const auto* upsampled = std::get_if<UpsampledSpectrum>(&kind))
    return upsampled->is_sigmoid() ? kSmooth : 1;
  if (const auto* combined = std::get_if<CombinedSpectrum>(&kind)) {
    int degree = 0;
    for (const auto& term : combined->terms()) {
      int product = 0;
      for (const Spectrum& part : term.of) product = std::min(kSmooth, product + degree_of(part.kind()));
      degree = std::max(degree, product);
    }
    return degree;
  }
  const bool smooth =
      std::holds_alternative<BlackbodySpectrum>(kind) || std::holds_alternative<GaussianSumSpectrum>(kind);
  return smooth ? kSmooth : 1;
}

/// Gauss's rule of two points inside [a, b], so that steps at the ends do not count: exact up to the third
/// power, the product of three straight lines.
template <class Function>
double two_points(const Function& f, double a, double b) {
  const double offset = 0.5 * (b - a) / std::sqrt(3.0);
  const double middle = 0.5 * (a + b);
  return 0.5 * (b - a) * (f(middle - offset) + f(middle + offset));
}

/// Integral of a product of spectra, piece by piece between all their breaks.
template <class Product>
double over_pieces(std::initializer_list<const Spectrum*> spectra, double first_nm, double last_nm,
                   const Product& product) {
  if (!(last_nm > first_nm)) return 0;
  std::vector<double> breaks = {first_nm};
  int degree = 0;
  for (const Spectrum* s : spectra) {
    spectile::add_breaks(*s, breaks);
    degree += degree_of(s->kind());
  }
  breaks.push_back(last_nm);
  std::sort(breaks.begin(), breaks.end());
  const auto sum_pieces = [&](const auto& piece) {
    double sum = 0;
    for (std::size_t i = 1; i < breaks.size(); ++i) {
      const double from = std::clamp(breaks[i - 1], first_nm, last_nm);
      const double to = std::clamp(breaks[i], first_nm, last_nm);
      if (to > from) sum += piece(from, to);
    }
    return sum;
  };
  if (degree < kSmooth)
    return sum_pieces([&](double from, double to) { return two_points(product, from, to); });
  // Pieces that hold next to nothing, a lobe's tails, need no precision of their own.
  const double size = sum_pieces([&](double from, double to) {
    return quadrature::ten_points([&](double nm) { return std::abs(product(nm)); }, from, to);
  });
  const double negligible = 1e-12 * size / static_cast<double>(breaks.size());
  return sum_pieces(
      [&](double from, double to) { return quadrature::adaptive(product, from, to, 1e-10, negligible); });
}

}  // namespace

void add_breaks(const Spectrum& spectrum, std::vector<double>& breaks) {
  std::visit([&](const auto& kind) { add_breaks(kind, breaks); }, spectrum.kind());
}

// NOLINTNEXTLINE(bugprone-exception-escape): no alternative is ever without a value
double Spectrum::operator()(double lambda_nm) const noexcept {
  return std::visit([&](const auto& s) { return s(lambda_nm); }, kind_);
}

double Spectrum::max_value() const {
  return std::visit([](const auto& s) { return s.max_value(); }, kind_);
}

double Spectrum::integral(double first_nm, double last_nm) const {
  return std::visit([&](const auto& s) { return s.integral(first_nm, last_nm); }, kind_);
}

std::string Spectrum::to_text() const {
  return std::visit([](const auto& s) { return s.to_text(); }, kind_);
}

double inner_product(const Spectrum& a, const Spectrum& b, double first_nm, double last_nm) {
  return std::visit(
      [&](const auto& f, const auto& g) {
        return over_pieces({&a, &b}, first_nm, last_nm, [&](double nm) { return f(nm) * g(nm); });
      },
      a.kind(), b.kind());
}

double inner_product(const Spectrum& a, const Spectrum& b, const Spectrum& c, double first_nm,
                     double last_nm) {
  return over_pieces({&a, &b, &c}, first_nm, last_nm, [&](double nm) { return a(nm) * b(nm) * c(nm); });
}

}  // namespace spectile
