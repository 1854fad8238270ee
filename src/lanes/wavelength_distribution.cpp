// WavelengthDistribution: a table of shares of each nanometre, its inverse, draws and densities.
#include <algorithm>
#include <cmath>
#include <spectile/lanes/arithmetic.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"
#include "src/lanes/wavelength_bins.hpp"

namespace spectile {

namespace {

/// Integrals over every nanometre of the range.
template <class Integral>
Result<std::vector<double>> nanometres(int first_nm, int last_nm, Integral integral) {
  std::vector<double> out;
  for (int nm = first_nm; nm < last_nm; ++nm) {
    const double v = integral(nm, nm + 1);
    if (!std::isfinite(v)) {
      return make_error(ErrorCode::kBadArgument, "the spectrum is {} from {} to {} nm", v, nm, nm + 1);
    }
    out.push_back(std::max(0.0, v));
  }
  return out;
}

/// Parts of a nanometre to shares of all draws.
Result<std::vector<double>> shares_of(std::vector<double> parts, double even_share, int first_nm,
                                      int last_nm) {
  if (!(even_share >= 0 && even_share <= 1)) {
    return make_error(ErrorCode::kBadArgument, "a share is 0 to 1, not {}", even_share);
  }
  double sum = 0;
  for (const double v : parts) sum += v;
  if (!std::isfinite(sum)) {
    return make_error(ErrorCode::kBadArgument, "the spectrum's sum from {} to {} nm is beyond double",
                      first_nm, last_nm);
  }
  // A nanometre's even share is at least four steps of a float near 1, so that all are drawn.
  const double least = 0x1p-22 * static_cast<double>(parts.size());
  if (even_share > 0 && even_share < least) {
    return make_error(ErrorCode::kBadArgument,
                      "an even share of {} over {} nm is too small for float: 0, or {} and more", even_share,
                      parts.size(), least);
  }
  if (!(sum > 0) && even_share < 1) {
    return make_error(ErrorCode::kBadArgument, "the spectrum is nowhere above 0 from {} to {} nm", first_nm,
                      last_nm);
  }
  const double even = even_share / static_cast<double>(parts.size());
  for (double& v : parts) v = even + (sum > 0 ? (1 - even_share) * (v / sum) : 0);
  return parts;
}

Result<void> check_range(int first_nm, int last_nm) {
  if (first_nm >= 1 && last_nm > first_nm && last_nm <= 100000) return {};
  return make_error(ErrorCode::kBadArgument, "wavelengths cannot be drawn from {} to {} nm", first_nm,
                    last_nm);
}

}  // namespace

Result<WavelengthDistribution> WavelengthDistributionAccess::create(const std::vector<double>& shares,
                                                                    int first_nm) {
  const auto out = std::make_shared<WavelengthDistribution::Tables>();
  const std::size_t n = shares.size();
  out->first_nm = first_nm;
  std::vector<float> starts;
  double sum = 0;
  for (const double share : shares) {
    // Shares of which float has no inverse count for nothing.
    constexpr double kMinStart = 0x1p-64;
    starts.push_back(sum < kMinStart ? 0.0F : std::min(1.0F, static_cast<float>(sum)));
    sum += share;
  }
  SPECTILE_ASSIGN(out->starts, index_knots(starts));
  SPECTILE_ASSIGN(out->bins, FloatBuffer::create(2 * n));
  SPECTILE_ASSIGN(out->densities, FloatBuffer::create(2 * n));
  for (std::size_t i = 0; i < n; ++i) {
    // The share as the float starts have it: what is drawn and its density then agree.
    const double end = i + 1 < n ? static_cast<double>(starts[i + 1]) : 1;
    const double share = end - static_cast<double>(starts[i]);
    out->bins.data()[2 * i] = share > 0 ? static_cast<float>(1 / share) : 0.0F;
    out->bins.data()[2 * i + 1] = static_cast<float>(share);
    out->densities.data()[2 * i] = static_cast<float>(share);
    out->densities.data()[2 * i + 1] = 0;
  }
  out->table = {out->starts.knots.data(),
                out->bins.data(),
                static_cast<std::int32_t>(n),
                static_cast<float>(first_nm),
                out->starts.start.data(),
                out->starts.buckets_per_nm,
                static_cast<std::int32_t>(out->starts.start.size()),
                out->starts.halvings};
  WavelengthDistribution made;
  made.tables_ = out;
  return made;
}

Result<WavelengthDistribution> WavelengthDistribution::proportional_to(const Spectrum& spectrum,
                                                                       double even_share, int first_nm,
                                                                       int last_nm) {
  SPECTILE_TRY(check_range(first_nm, last_nm));
  SPECTILE_ASSIGN(auto parts,
                  nanometres(first_nm, last_nm, [&](int a, int b) { return spectrum.integral(a, b); }));
  SPECTILE_ASSIGN(const auto shares, shares_of(std::move(parts), even_share, first_nm, last_nm));
  return WavelengthDistributionAccess::create(shares, first_nm);
}

Result<WavelengthDistribution> WavelengthDistribution::of_light(const Spectrum& light, Observer observer,
                                                                double even_share) {
  const std::string name = observer == Observer::kCie1931 ? "cie1931-" : "cie1964-";
  constexpr auto kFirst = static_cast<int>(kFirstVisibleNm);
  constexpr auto kLast = static_cast<int>(kLastVisibleNm);
  std::vector<double> squares(kLast - kFirst, 0.0);
  for (const char* component : {"x", "y", "z"}) {
    SPECTILE_ASSIGN(const auto curve, named_spectrum(name + component));
    SPECTILE_ASSIGN(const auto parts, nanometres(kFirst, kLast, [&](int from, int to) {
                      return inner_product(light, curve, from, to);
                    }));
    double whole = 0;
    for (const double v : parts) whole += v;
    for (std::size_t i = 0; whole > 0 && i < parts.size(); ++i)
      squares[i] += (parts[i] / whole) * (parts[i] / whole);
  }
  for (double& v : squares) v = std::sqrt(v);
  SPECTILE_ASSIGN(const auto shares, shares_of(std::move(squares), even_share, kFirst, kLast));
  return WavelengthDistributionAccess::create(shares, kFirst);
}

int WavelengthDistribution::first_nm() const noexcept {
  return tables_->first_nm;
}

int WavelengthDistribution::last_nm() const noexcept {
  return tables_->first_nm + tables_->count();
}

double WavelengthDistribution::density(double lambda_nm) const noexcept {
  if (!(lambda_nm >= first_nm() && lambda_nm <= last_nm())) return 0;
  const auto i = std::min(static_cast<std::int32_t>(lambda_nm - first_nm()), tables_->count() - 1);
  return static_cast<double>(tables_->densities.data()[2 * static_cast<std::size_t>(i)]);
}

Result<void> sample_wavelengths(const WavelengthDistribution& distribution, LanesView u,
                                SampledWavelengthsSpan out, const Execution& execution) {
  SPECTILE_TRY(shape::own_wavelengths(out.lambda_nm.axis));
  SPECTILE_TRY(shape::same(out.lambda_nm, out.density));
  SPECTILE_TRY(shape::same_lanes(u.lanes, out.lambda_nm.lanes));
  SPECTILE_TRY(shape::aligned(u.data));
  SPECTILE_TRY(shape::aligned(out.lambda_nm.data));
  SPECTILE_TRY(shape::aligned(out.density.data));
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  const kernels::BinTable& table = WavelengthDistributionAccess::tables(distribution).table;
  const SampledSpectraSpan lambda = out.lambda_nm;
  const SampledSpectraSpan density = out.density;
  tiles::for_blocks(blocks_for(u.lanes), execution, [&](std::size_t first, std::size_t count) {
    kernels->table_wavelengths(lambda.row(first, 0), density.row(first, 0), u.data + first * kLanesPerBlock,
                               table, lambda.axis.count(), count);
  });
  return {};
}

Result<void> wavelength_density(const WavelengthDistribution& distribution, SampledSpectraView lambda_nm,
                                SampledSpectraSpan density, const Execution& execution) {
  SPECTILE_TRY(shape::own_wavelengths(lambda_nm.axis));
  SPECTILE_TRY(shape::same(lambda_nm, density));
  SPECTILE_TRY(shape::aligned(lambda_nm.data));
  SPECTILE_TRY(shape::aligned(density.data));
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  const auto& tables = WavelengthDistributionAccess::tables(distribution);
  const kernels::EvenTable table = {tables.densities.data(), tables.table.first_nm, 1.0F, tables.count()};
  const std::size_t block_floats = density.axis.count() * kLanesPerBlock;
  tiles::for_blocks(density.blocks(), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * block_floats;
    kernels->interpolate_even(density.data + at, lambda_nm.data + at, table, count * block_floats);
  });
  return {};
}

Result<void> balance_heuristic(SampledSpectraView path_density, const SampledWavelengthsView& wavelengths,
                               LanesSpan weight, const Execution& execution) {
  SPECTILE_TRY(shape::own_wavelengths(path_density.axis));
  SPECTILE_TRY(shape::same(path_density, wavelengths.density));
  SPECTILE_TRY(average(path_density, weight, execution));
  const LaneMask terminated = secondary_terminated(wavelengths);
  for (std::size_t i = 0; i < weight.lanes; ++i) {
    const bool alone = ((terminated[i / kLanesPerBlock] >> (i % kLanesPerBlock)) & 1U) != 0;
    const float mean = alone ? path_density.at(i, 0) : weight.data[i];
    weight.data[i] = mean == 0.0F ? 0.0F : path_density.at(i, 0) / mean;
  }
  return {};
}

}  // namespace spectile
