// Scalar twins of the kernels for spectra at single wavelengths.
#include <algorithm>
#include <cmath>

#include "src/reference/centres.hpp"
#include "src/reference/exponential.hpp"
#include "src/reference/twins.hpp"
#include "src/reference/upsampling/sigmoid.hpp"

namespace spectile::reference {
namespace {

using kernels::EvenTable;
using kernels::kLanes;
using kernels::KnotTable;
using kernels::WavelengthDensity;

float value_at(const EvenTable& table, float lambda) {
  if (std::isnan(lambda)) return lambda;
  const float t = (lambda - table.first_nm) * table.per_nm;
  if (!(t >= 0.0F && t <= static_cast<float>(table.intervals))) return 0;
  const std::int32_t i = std::min(static_cast<std::int32_t>(t), table.intervals - 1);
  const float part = t - static_cast<float>(i);
  const float* const pair = table.pairs + std::ptrdiff_t{2} * i;
  return pair[0] + part * pair[1];
}

/// Table: SigmoidSpectrum or SigmoidLanes.
template <class Table>
float sigmoid_of(const Table& s, const float c[3], float lambda) {
  const float held = std::clamp(lambda, s.lowest_nm, s.highest_nm);
  const bool tabulated = s.form == kernels::SigmoidForm::kFunctions;
  const float p = tabulated ? value_at(s.p, held) : 0.0F;
  const float q = tabulated ? value_at(s.q, held) : (held - 550.0F) / 150.0F;
  return sigmoid_sample(sigmoid_argument(s.form, c, p, q));
}

float value_at(const KnotTable& table, float lambda) {
  if (std::isnan(lambda)) return lambda;
  const float first = table.knots[0];
  const float last = table.knots[table.count - 1];
  if (!table.held && (lambda < first || lambda > last)) return 0;
  const float held = std::clamp(lambda, first, last);
  const std::int32_t knot = last_knot(table, held);
  const float* const pair = table.pairs + std::ptrdiff_t{2} * knot;
  return pair[0] + (held - table.knots[knot]) * pair[1];
}

/// The k-th of the numbers that one random number stands for.
float spread(float u, std::size_t k, std::size_t count) {
  if (std::isnan(u)) return u;
  const float first = std::clamp(u, 0.0F, 1.0F - 0x1p-24F);
  const float moved = first + static_cast<float>(k) / static_cast<float>(count);
  return moved >= 1.0F ? moved - 1.0F : moved;
}

}  // namespace

void interpolate_even(float* dst, const float* lambda_nm, const EvenTable& table, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = value_at(table, lambda_nm[i]);
}

void interpolate_knots(float* dst, const float* lambda_nm, const KnotTable& table, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = value_at(table, lambda_nm[i]);
}

void planck(float* dst, const float* lambda_nm, const kernels::PlanckTable& table, std::size_t n) noexcept {
  using namespace kernels;  // the constants' names
  for (std::size_t i = 0; i < n; ++i) {
    const float lambda = lambda_nm[i];
    if (std::isnan(lambda)) {
      dst[i] = lambda;
      continue;
    }
    dst[i] = 0;
    if (!(lambda > 0) || std::isinf(lambda)) continue;
    const float l = std::min(kPlanckLongest, lambda * (1.0F / kPlanckUnit));
    const float inverse = 1.0F / l;
    const float x = table.exponent * inverse;
    if (!(x < kPlanckLimit)) continue;
    const float rest = (std::fma(-x, l, table.exponent) + table.exponent_rest) * inverse;
    const float whole = (x + kRoundMagicFloat) - kRoundMagicFloat;
    const float t = ((x - whole) + rest) * kLn2Float;
    float p = kPlanckSeries[kPlanckTerms - 1];
    for (std::size_t k = kPlanckTerms - 1; k-- > 0;) p = std::fma(p, t, kPlanckSeries[k]);
    const float q = std::fma(p, t * t, t);
    const auto power = static_cast<int>(whole);
    const int half = power >> 1;
    const float first = std::ldexp(1.0F, -half);
    const float second = std::ldexp(1.0F, -(power - half));
    const float square = l * l;
    const float divisor = ((square * square) * l) * (q + (1.0F - first * second));
    dst[i] = ((table.factor * first) / divisor) * second;
  }
}

void gaussians(float* dst, const float* lambda_nm, const kernels::GaussianLobe* lobes, std::size_t count,
               std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double from_mean = lambda_nm[i] - lobes[k].mean_nm;
      const double z = from_mean * (from_mean < 0 ? lobes[k].per_sigma_left : lobes[k].per_sigma_right);
      sum = sum + lobes[k].amplitude * exp2_double(hold((z * z) * (-0.5 * kernels::kLog2E)));
    }
    dst[i] = static_cast<float>(sum);
  }
}

void sigmoid_at(float* dst, const float* lambda_nm, const kernels::SigmoidSpectrum& s,
                std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    dst[i] = std::isnan(lambda_nm[i]) ? lambda_nm[i] : sigmoid_of(s, s.c, lambda_nm[i]) * s.scale;
  }
}

void sigmoids_at(float* dst, const kernels::SigmoidLanes& s, const float* lambda_nm, std::size_t count,
                 std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    const float c[3] = {s.c[0][i], s.c[1][i], s.c[2][i]};
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = own_sample(i, k, count);
      const float lambda = lambda_nm[at];
      const float sample = std::isnan(lambda) ? lambda : sigmoid_of(s, c, lambda);
      dst[at] = s.scale == nullptr || std::isnan(lambda) ? sample : sample * s.scale[i];
    }
  }
}

void even_wavelengths(float* lambda_nm, float* density, const float* u, const WavelengthDensity& d,
                      std::size_t count, std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = own_sample(i, k, count);
      lambda_nm[at] = d.first_nm + spread(u[i], k, count) * d.range_nm;
      density[at] = 1.0F / d.range_nm;
    }
  }
}

void visible_wavelengths(float* lambda_nm, float* density, const float* u, const WavelengthDensity& d,
                         std::size_t count, std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      const float v = spread(u[i], k, count);
      const double y = d.from - v * d.by;
      const double lambda =
          d.centre_nm - log2_double((1.0 + y) / (1.0 - y)) * (0.5 * kernels::kLn2 * d.per_steepness_nm);
      const std::size_t at = own_sample(i, k, count);
      lambda_nm[at] = std::isnan(v) ? v : static_cast<float>(lambda);
      density[at] = static_cast<float>(d.peak * (1.0 - y * y));
    }
  }
}

void table_wavelengths(float* lambda_nm, float* density, const float* u, const kernels::BinTable& table,
                       std::size_t count, std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * kLanes; ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      const float v = spread(u[i], k, count);
      const float share = std::isnan(v) ? 0.0F : v;
      const std::int32_t bin = last_knot(table, share);
      const float* const pair = table.bins + std::ptrdiff_t{2} * bin;
      const float low = table.first_nm + static_cast<float>(bin);
      const float lambda = low + (share - table.knots[bin]) * pair[0];
      const float end = (low + 1.0F) * (1.0F - 0x1p-24F);
      const std::size_t at = own_sample(i, k, count);
      lambda_nm[at] = std::isnan(v) ? v : (end < lambda ? end : lambda);
      density[at] = pair[1];
    }
  }
}

void project_wavelengths(float* const dst[3], const kernels::WavelengthBlocks& samples,
                         const EvenTable curves[3], float factor, std::size_t blocks) noexcept {
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < blocks * kLanes; ++i) {
      float sum = 0;
      for (std::size_t k = 0; k < samples.count; ++k) {
        const std::size_t at = own_sample(i, k, samples.count);
        const float density = samples.density[at];
        if (density == 0.0F) continue;
        sum = sum + value_at(curves[c], samples.lambda_nm[at]) * (samples.values[at] / density);
      }
      dst[c][i] = factor * sum;
    }
  }
}

void centre_places(std::int32_t* interval, float* part, const float* lambda_nm,
                   const kernels::CentreTable& centres, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const bool no_number = std::isnan(lambda_nm[i]);
    const CentrePlace place = place_between(centres, no_number ? centres.first_nm : lambda_nm[i]);
    interval[i] = static_cast<std::int32_t>(place.interval);
    part[i] = no_number ? lambda_nm[i] : place.part;
  }
}

}  // namespace spectile::reference
