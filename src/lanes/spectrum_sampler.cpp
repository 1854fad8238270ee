// SpectrumSampler: distributions as tables for the kernels.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <spectile/constants.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/knot_index.hpp"
#include "src/lanes/sampler_run.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"
#include "src/spectra/sigmoid_functions.hpp"

namespace spectile {

using kernels::EvenTable;
using kernels::GaussianLobe;
using kernels::KernelTable;
using kernels::KnotTable;

namespace {

/// Knots, slopes and buckets of a piecewise-linear function, and the memory that they lie in.
struct Knots {
  KnotIndex index;
  FloatBuffer pairs;
  KnotTable table;
};

bool fits_float(double v) {
  return std::abs(v) <= static_cast<double>(std::numeric_limits<float>::max());
}

Result<Knots> make_knots(const MeasuredSpectrum& spectrum, bool held) {
  const auto w = spectrum.wavelengths_nm();
  const auto v = spectrum.values();
  const std::size_t n = w.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!fits_float(w[i]) || !fits_float(v[i])) {
      return make_error(ErrorCode::kBadArgument, "the sample {} at {} nm is beyond the range of float", v[i],
                        w[i]);
    }
  }
  const auto first = static_cast<float>(w.front());
  const auto last = static_cast<float>(w.back());
  const float range = last - first;
  if (!std::isfinite(range)) {
    return make_error(ErrorCode::kBadArgument, "samples from {} to {} nm are too far apart for float",
                      w.front(), w.back());
  }
  std::vector<float> knots;
  knots.reserve(n);
  for (const double nm : w) knots.push_back(static_cast<float>(nm));
  Knots out;
  SPECTILE_ASSIGN(out.index, index_knots(knots));
  SPECTILE_ASSIGN(out.pairs, FloatBuffer::create(2 * n));
  for (std::size_t i = 0; i < n; ++i) {
    // Between the knots as they are in float: two that became one are a step.
    const double length = i + 1 < n ? static_cast<double>(knots[i + 1]) - static_cast<double>(knots[i]) : 0;
    const double slope = length > 0 ? (v[i + 1] - v[i]) / length : 0;
    if (!fits_float(slope)) {
      return make_error(ErrorCode::kBadArgument, "the slope from {} to {} nm is beyond the range of float",
                        w[i], w[i + 1]);
    }
    out.pairs.data()[2 * i] = static_cast<float>(v[i]);
    out.pairs.data()[2 * i + 1] = static_cast<float>(slope);
  }
  out.table = {out.index.knots.data(),       out.pairs.data(),
               static_cast<std::int32_t>(n), out.index.start.data(),
               out.index.buckets_per_nm,     static_cast<std::int32_t>(out.index.start.size()),
               out.index.halvings,           held};
  return out;
}

struct Even {
  FloatBuffer pairs;
  EvenTable table;
};

Result<Even> make_even_table(const DenselySampledSpectrum& spectrum) {
  const auto v = spectrum.values();
  Even out;
  SPECTILE_ASSIGN(out.pairs, FloatBuffer::create(2 * (v.size() - 1)));
  for (std::size_t i = 0; i + 1 < v.size(); ++i) {
    if (!fits_float(v[i]) || !fits_float(v[i + 1]) || !fits_float(v[i + 1] - v[i])) {
      return make_error(ErrorCode::kBadArgument, "the sample {} at {} nm is beyond the range of float", v[i],
                        spectrum.first_nm() + static_cast<int>(i));
    }
    out.pairs.data()[2 * i] = static_cast<float>(v[i]);
    out.pairs.data()[2 * i + 1] = static_cast<float>(v[i + 1] - v[i]);
  }
  out.table = {out.pairs.data(), static_cast<float>(spectrum.first_nm()), 1.0F,
               static_cast<std::int32_t>(v.size() - 1)};
  return out;
}

}  // namespace

/// A distribution's kernel, by kind, and its tables.
struct SpectrumSampler::Tables {
  enum class Kind { kConstant, kKnots, kEven, kPlanck, kGaussians, kSigmoid, kCombined };
  struct Term;
  Kind kind = Kind::kConstant;
  float constant = 0;
  Knots knots;  // also the white of a sigmoid's light
  Even even;
  kernels::PlanckTable planck;
  std::vector<GaussianLobe> lobes;
  std::array<float, 3> c{};
  float lowest_nm = 0;
  float highest_nm = 0;
  float scale = 1;
  bool white = false;
  std::optional<Observer> observer;  // of a sigmoid's functions
  std::vector<Term> terms;           // of a combined one

  Result<void> set(const CombinedSpectrum& s);
  void combined_row(const KernelTable& kernels, const float* lambda_nm, float* out, std::size_t n) const;

  Result<void> set(const ConstantSpectrum& s) {
    if (!fits_float(s.value()) && !std::isnan(s.value())) {
      return make_error(ErrorCode::kBadArgument, "the constant {} is beyond the range of float", s.value());
    }
    constant = static_cast<float>(s.value());
    return {};
  }
  Result<void> set(const PiecewiseLinearSpectrum& s) {
    return set_knots(s.measured(), s.ends() == Ends::kHeld, Kind::kKnots);
  }
  Result<void> set(const DenselySampledSpectrum& s) {
    kind = Kind::kEven;
    SPECTILE_ASSIGN(even, make_even_table(s));
    return {};
  }
  Result<void> set(const BlackbodySpectrum& s) {
    kind = Kind::kPlanck;
    // From two places: the law's exponent from the temperature, the factor from a value.
    constexpr double kSecondRadiationNmK =
        (kPlanckConstant * kSpeedOfLight / kBoltzmannConstant).value() * 1e9;  // h c / k
    constexpr double kUnitNm = 1024;                                           // of the kernel
    const double exponent = kSecondRadiationNmK / s.temperature_k() * std::numbers::log2e / kUnitNm;
    const double peak_nm = kSecondRadiationNmK / s.temperature_k() / kWienRoot;
    const double factor = s(peak_nm) * std::pow(peak_nm / kUnitNm, 5) *
                          std::expm1(kSecondRadiationNmK / (peak_nm * s.temperature_k()));
    planck.factor = static_cast<float>(factor);
    planck.exponent = static_cast<float>(exponent);
    planck.exponent_rest = static_cast<float>(exponent - static_cast<double>(planck.exponent));
    return {};
  }
  Result<void> set(const GaussianSumSpectrum& s) {
    kind = Kind::kGaussians;
    // The inverse of a denormal width would be infinite, and its lobe no number at its mean.
    const auto inverse = [](double sigma) { return std::min(1 / sigma, std::numeric_limits<double>::max()); };
    for (const auto& l : s.lobes()) {
      if (!fits_float(l.amplitude)) {
        return make_error(ErrorCode::kBadArgument, "the amplitude {} is beyond the range of float",
                          l.amplitude);
      }
      lobes.push_back({l.amplitude, l.mean_nm, inverse(l.sigma_left_nm), inverse(l.sigma_right_nm)});
    }
    return {};
  }
  Result<void> set(const UpsampledSpectrum& s) {
    if (!s.is_sigmoid()) return set_knots(*s.table(), true, Kind::kKnots);
    c = s.coefficients();
    scale = s.scale();
    lowest_nm = static_cast<float>(s.first_nm());
    highest_nm = static_cast<float>(s.last_nm());
    observer = s.observer();
    if (observer) {
      lowest_nm =
          static_cast<float>(std::clamp(s.first_nm(), SigmoidFunctions::kFirstNm, SigmoidFunctions::kLastNm));
      highest_nm =
          static_cast<float>(std::clamp(s.last_nm(), SigmoidFunctions::kFirstNm, SigmoidFunctions::kLastNm));
    }
    white = s.table() != nullptr;
    kind = Kind::kSigmoid;
    return white ? set_knots(*s.table(), true, Kind::kSigmoid) : Result<void>{};
  }
  Result<void> set_knots(const MeasuredSpectrum& samples, bool held, Kind of) {
    kind = of;
    SPECTILE_ASSIGN(knots, make_knots(samples, held));
    return {};
  }

  void row(const KernelTable& kernels, const float* lambda_nm, float* out, std::size_t n) const {
    switch (kind) {
      case Kind::kConstant:
        for (std::size_t i = 0; i < n; ++i) out[i] = std::isnan(lambda_nm[i]) ? lambda_nm[i] : constant;
        break;
      case Kind::kKnots:
        kernels.interpolate_knots(out, lambda_nm, knots.table, n);
        break;
      case Kind::kEven:
        kernels.interpolate_even(out, lambda_nm, even.table, n);
        break;
      case Kind::kPlanck:
        kernels.planck(out, lambda_nm, planck, n);
        break;
      case Kind::kGaussians:
        kernels.gaussians(out, lambda_nm, lobes.data(), lobes.size(), n);
        break;
      case Kind::kSigmoid:
        sigmoid_row(kernels, lambda_nm, out, n);
        break;
      case Kind::kCombined:
        combined_row(kernels, lambda_nm, out, n);
        break;
    }
  }

  kernels::EvenTable functions_table(std::size_t k) const {
    const std::vector<float>& pairs = SigmoidFunctions::of(observer).pairs(k);
    return {pairs.data(), static_cast<float>(SigmoidFunctions::kFirstNm), 1.0F,
            static_cast<std::int32_t>(pairs.size() / 2)};
  }

  void sigmoid_row(const KernelTable& kernels, const float* lambda_nm, float* out, std::size_t n) const {
    kernels::SigmoidSpectrum spectrum = {
        {c[0], c[1], c[2]}, lowest_nm, highest_nm, white ? 1.0F : scale, {}, {}, {}};
    if (observer) {
      spectrum.form = kernels::SigmoidForm::kFunctions;
      spectrum.p = functions_table(0);
      spectrum.q = functions_table(1);
    }
    kernels.sigmoid_at(out, lambda_nm, spectrum, n);
    if (!white) return;
    // In the order of the batches of pixels: the sample, times the white, times the scale.
    alignas(64) float whites[kLanesPerBlock];
    for (std::size_t at = 0; at < n; at += kLanesPerBlock) {
      kernels.interpolate_knots(whites, lambda_nm + at, knots.table, kLanesPerBlock);
      kernels.multiply(out + at, out + at, whites, kLanesPerBlock);
      kernels.scale(out + at, out + at, scale, kLanesPerBlock);
    }
  }
};

struct SpectrumSampler::Tables::Term {
  float factor = 1;
  std::vector<std::shared_ptr<const Tables>> of;
};

Result<void> SpectrumSampler::Tables::set(const CombinedSpectrum& s) {
  kind = Kind::kCombined;
  for (const CombinedSpectrum::Term& term : s.terms()) {
    if (!fits_float(term.factor))
      return make_error(ErrorCode::kBadArgument, "the factor {} is beyond the range of float", term.factor);
    Term out = {static_cast<float>(term.factor), {}};
    for (const Spectrum& part : term.of) {
      const auto tables = std::make_shared<Tables>();
      SPECTILE_TRY(std::visit([&](const auto& of) { return tables->set(of); }, part.kind()));
      out.of.push_back(tables);
    }
    terms.push_back(std::move(out));
  }
  return {};
}

/// Block by block: each term's product times its factor, added up in order.
void SpectrumSampler::Tables::combined_row(const KernelTable& kernels, const float* lambda_nm, float* out,
                                           std::size_t n) const {
  alignas(64) float lambda[kLanesPerBlock];
  alignas(64) float sum[kLanesPerBlock];
  alignas(64) float product[kLanesPerBlock];
  alignas(64) float part[kLanesPerBlock];
  for (std::size_t at = 0; at < n; at += kLanesPerBlock) {
    // A copy: `out` may be the wavelengths.
    std::copy_n(lambda_nm + at, kLanesPerBlock, lambda);
    for (std::size_t i = 0; i < kLanesPerBlock; ++i) sum[i] = std::isnan(lambda[i]) ? lambda[i] : 0.0F;
    for (const Term& term : terms) {
      std::fill_n(product, kLanesPerBlock, term.factor);
      for (const auto& of : term.of) {
        of->row(kernels, lambda, part, kLanesPerBlock);
        kernels.multiply(product, product, part, kLanesPerBlock);
      }
      kernels.add(sum, sum, product, kLanesPerBlock);
    }
    std::copy_n(sum, kLanesPerBlock, out + at);
  }
}

Result<SpectrumSampler> SpectrumSampler::create(const Spectrum& spectrum) {
  auto tables = std::make_shared<Tables>();
  SPECTILE_TRY(std::visit([&](const auto& s) { return tables->set(s); }, spectrum.kind()));
  SpectrumSampler out;
  out.tables_ = std::move(tables);
  return out;
}

void SpectrumSamplerAccess::run(const SpectrumSampler& sampler, const KernelTable& kernels,
                                const float* lambda_nm, float* values, std::size_t n) {
  sampler.tables_->row(kernels, lambda_nm, values, n);
}

Result<void> SpectrumSampler::sample(SampledSpectraView lambda_nm, SampledSpectraSpan values,
                                     const Execution& execution) const {
  SPECTILE_TRY(shape::own_wavelengths(lambda_nm.axis));
  SPECTILE_TRY(shape::same(lambda_nm, values));
  SPECTILE_TRY(shape::aligned(lambda_nm.data));
  SPECTILE_TRY(shape::aligned(values.data));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const std::size_t block_floats = values.axis.count() * kLanesPerBlock;
  tiles::for_blocks(values.blocks(), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * block_floats;
    tables_->row(*table, lambda_nm.data + at, values.data + at, count * block_floats);
  });
  return {};
}

Result<void> sample(const Spectrum& spectrum, SampledSpectraView lambda_nm, SampledSpectraSpan values,
                    const Execution& execution) {
  SPECTILE_ASSIGN(const auto sampler, SpectrumSampler::create(spectrum));
  return sampler.sample(lambda_nm, values, execution);
}

}  // namespace spectile
