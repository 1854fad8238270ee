// CombinedSpectrum: sums and products of spectra; spectra made to measure.
#include <algorithm>
#include <cmath>
#include <spectile/spectra/named_spectra.hpp>

#include "src/base/errors.hpp"
#include "src/spectra/breaks.hpp"

namespace spectile {
namespace {

using Term = CombinedSpectrum::Term;

std::vector<Term> terms_of(const Spectrum& spectrum) {
  if (const auto* combined = std::get_if<CombinedSpectrum>(&spectrum.kind()))
    return {combined->terms().begin(), combined->terms().end()};
  return {{1, {spectrum}}};
}

const Spectrum& seen_luminance() {
  static const Spectrum kYBar = *named_spectrum("cie1931-y");
  return kYBar;
}

}  // namespace

CombinedSpectrum::CombinedSpectrum(std::vector<Term> terms)
    : terms_(std::make_shared<const std::vector<Term>>(std::move(terms))) {}

std::span<const Term> CombinedSpectrum::terms() const noexcept {
  return *terms_;
}

double CombinedSpectrum::operator()(double lambda_nm) const noexcept {
  double sum = 0;
  for (const Term& term : *terms_) {
    double product = term.factor;
    for (const Spectrum& part : term.of) product *= part(lambda_nm);
    sum += product;
  }
  return sum;
}

double CombinedSpectrum::max_value() const {
  std::vector<double> places;
  constexpr int kFirst = static_cast<int>(kFirstVisibleNm);
  constexpr int kLast = static_cast<int>(kLastVisibleNm);
  for (int nm = kFirst; nm <= kLast; ++nm) places.push_back(nm);
  add_breaks(Spectrum(*this), places);
  double largest = (*this)(places.front());
  for (const double nm : places) largest = std::max(largest, (*this)(nm));
  return largest;
}

double CombinedSpectrum::integral(double first_nm, double last_nm) const {
  double sum = 0;
  for (const Term& term : *terms_) {
    if (term.of.size() == 1) {
      sum += term.factor * term.of.front().integral(first_nm, last_nm);
      continue;
    }
    const Spectrum product = CombinedSpectrum({term});
    sum += inner_product(product, ConstantSpectrum(1), first_nm, last_nm);
  }
  return sum;
}

std::string CombinedSpectrum::to_text() const {
  std::string out;
  for (const Term& term : *terms_) {
    std::string text;
    for (const Spectrum& part : term.of) text += (text.empty() ? "" : " times ") + part.to_text();
    if (term.factor != 1) text = fmt::format("{} times {}", term.factor, text);
    out += (out.empty() ? "" : ", plus ") + text;
  }
  return out;
}

Spectrum operator+(const Spectrum& a, const Spectrum& b) {
  std::vector<Term> terms = terms_of(a);
  const std::vector<Term> more = terms_of(b);
  terms.insert(terms.end(), more.begin(), more.end());
  return CombinedSpectrum(std::move(terms));
}

Spectrum operator-(const Spectrum& a, const Spectrum& b) {
  return a + -1.0 * b;
}

Spectrum operator*(const Spectrum& a, const Spectrum& b) {
  std::vector<Term> terms;
  for (const Term& p : terms_of(a)) {
    for (const Term& q : terms_of(b)) {
      Term& term = terms.emplace_back(Term{p.factor * q.factor, p.of});
      term.of.insert(term.of.end(), q.of.begin(), q.of.end());
    }
  }
  return CombinedSpectrum(std::move(terms));
}

Spectrum operator*(double factor, const Spectrum& spectrum) {
  // Tables stay tables, which are the quickest.
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum.kind()))
    return ConstantSpectrum(factor * constant->value());
  if (const auto* table = std::get_if<PiecewiseLinearSpectrum>(&spectrum.kind()))
    return table->scaled(factor);
  std::vector<Term> terms = terms_of(spectrum);
  for (Term& term : terms) term.factor *= factor;
  return CombinedSpectrum(std::move(terms));
}

bool operator==(const CombinedSpectrum& a, const CombinedSpectrum& b) {
  return std::ranges::equal(a.terms(), b.terms());
}

bool operator==(const PiecewiseLinearSpectrum& a, const PiecewiseLinearSpectrum& b) {
  return a.ends() == b.ends() && std::ranges::equal(a.wavelengths_nm(), b.wavelengths_nm()) &&
         std::ranges::equal(a.values(), b.values());
}

bool operator==(const DenselySampledSpectrum& a, const DenselySampledSpectrum& b) {
  return a.first_nm() == b.first_nm() && std::ranges::equal(a.values(), b.values());
}

bool operator==(const GaussianSumSpectrum& a, const GaussianSumSpectrum& b) {
  return std::ranges::equal(a.lobes(), b.lobes());
}

bool operator==(const UpsampledSpectrum& a, const UpsampledSpectrum& b) {
  const auto table = [](const UpsampledSpectrum& s) {
    return s.table() == nullptr ? Spectrum(ConstantSpectrum()) : Spectrum(*s.table());
  };
  const bool same_sigmoid =
      a.is_sigmoid() == b.is_sigmoid() && (!a.is_sigmoid() || a.coefficients() == b.coefficients());
  return same_sigmoid && a.rgb() == b.rgb() && a.observer() == b.observer() && a.scale() == b.scale() &&
         a.first_nm() == b.first_nm() && a.last_nm() == b.last_nm() && table(a) == table(b);
}

bool operator==(const Spectrum& a, const Spectrum& b) {
  return a.kind() == b.kind();
}

Result<Spectrum> with_luminance(const Spectrum& spectrum, double y) {
  const double seen = inner_product(spectrum, seen_luminance()) / seen_luminance().integral();
  if (!(seen > 0) || !std::isfinite(seen) || !std::isfinite(y)) {
    return make_error(ErrorCode::kBadArgument, "a spectrum of luminance {} cannot be scaled to {}", seen, y);
  }
  return (y / seen) * spectrum;
}

Result<Spectrum> with_maximum(const Spectrum& spectrum, double maximum) {
  const double largest = spectrum.max_value();
  if (!(largest > 0) || !std::isfinite(largest) || !std::isfinite(maximum)) {
    return make_error(ErrorCode::kBadArgument, "a spectrum whose maximum is {} cannot be scaled to {}",
                      largest, maximum);
  }
  return (maximum / largest) * spectrum;
}

Result<Spectrum> sampled_function(const std::function<double(double lambda_nm)>& function, double first_nm,
                                  double last_nm, double step_nm, Ends ends) {
  constexpr double kMaxSteps = 100000;
  const double steps = std::ceil((last_nm - first_nm) / step_nm * (1 - 1e-12));
  if (!(last_nm > first_nm) || !(step_nm > 0) || !(steps <= kMaxSteps)) {
    return make_error(ErrorCode::kBadArgument, "a function cannot be sampled from {} to {} nm every {} nm",
                      first_nm, last_nm, step_nm);
  }
  std::vector<double> wavelengths;
  std::vector<double> values;
  for (int i = 0; i <= static_cast<int>(steps); ++i) {
    wavelengths.push_back(std::min(first_nm + i * step_nm, last_nm));
    values.push_back(function(wavelengths.back()));
  }
  SPECTILE_ASSIGN(auto table, PiecewiseLinearSpectrum::from_samples(wavelengths, values, ends));
  return Spectrum(std::move(table));
}

Result<Spectrum> emission_lines(std::span<const EmissionLine> lines, double width_nm) {
  if (lines.empty() || !(width_nm > 0) || !std::isfinite(width_nm)) {
    return make_error(ErrorCode::kBadArgument, "{} lines, {} nm wide, make no spectrum", lines.size(),
                      width_nm);
  }
  std::vector<Term> terms;
  for (const EmissionLine& line : lines) {
    const double wavelengths[] = {line.lambda_nm - width_nm, line.lambda_nm, line.lambda_nm + width_nm};
    const double values[] = {0, line.power / width_nm, 0};
    SPECTILE_ASSIGN(auto triangle, PiecewiseLinearSpectrum::from_samples(wavelengths, values));
    terms.push_back({1, {Spectrum(std::move(triangle))}});
  }
  return Spectrum(CombinedSpectrum(std::move(terms)));
}

}  // namespace spectile
