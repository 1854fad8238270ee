// Sampled wavelengths in batches: drawing and terminating them.
#include <algorithm>
#include <bit>
#include <cmath>
#include <spectile/lanes/wavelengths.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using kernels::WavelengthDensity;

// Centre and steepness of the sensitivity. Source: Radziszewski, Boryczko, Alda 2009.
constexpr double kCentreNm = 538;
constexpr double kSteepness = 0.0072;  // 1/nm

WavelengthDensity density_over(double first_nm, double last_nm) {
  WavelengthDensity d{};
  d.first_nm = static_cast<float>(first_nm);
  d.range_nm = static_cast<float>(last_nm - first_nm);
  d.centre_nm = kCentreNm;
  d.per_steepness_nm = 1 / kSteepness;
  d.from = std::tanh(kSteepness * (kCentreNm - first_nm));
  d.by = std::tanh(kSteepness * (last_nm - kCentreNm)) + d.from;
  d.peak = kSteepness / d.by;
  return d;
}

}  // namespace

Result<SampledWavelengths> SampledWavelengths::create(std::size_t lanes, std::size_t count) {
  SPECTILE_ASSIGN(const auto axis, SpectralAxis::own_wavelengths(count));
  SPECTILE_ASSIGN(auto lambda, SampledSpectra::create(axis, lanes));
  SPECTILE_ASSIGN(auto density, SampledSpectra::create(axis, lanes));
  return SampledWavelengths{std::move(lambda), std::move(density)};
}

Result<void> sample_wavelengths(WavelengthSampling sampling, LanesView u, SampledWavelengthsSpan out,
                                double first_nm, double last_nm, const Execution& execution) {
  SPECTILE_TRY(shape::own_wavelengths(out.lambda_nm.axis));
  SPECTILE_TRY(shape::same(out.lambda_nm, out.density));
  SPECTILE_TRY(shape::same_lanes(u.lanes, out.lambda_nm.lanes));
  SPECTILE_TRY(shape::aligned(u.data));
  SPECTILE_TRY(shape::aligned(out.lambda_nm.data));
  SPECTILE_TRY(shape::aligned(out.density.data));
  if (!(first_nm >= 1e-6 && last_nm - first_nm >= 1e-6 && last_nm <= 1e9)) {
    return make_error(ErrorCode::kBadArgument, "wavelengths cannot be drawn from {} to {} nm", first_nm,
                      last_nm);
  }
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const WavelengthDensity density = density_over(first_nm, last_nm);
  constexpr double kMinShare = 1e-6;  // less would be lost in the differences of the inverse
  if (sampling == WavelengthSampling::kVisible && !(density.by > 2 * kMinShare)) {
    return make_error(ErrorCode::kBadArgument, "{} to {} nm hold next to nothing of the eye's sensitivity",
                      first_nm, last_nm);
  }
  const auto kernel =
      sampling == WavelengthSampling::kUniform ? table->even_wavelengths : table->visible_wavelengths;
  const SampledSpectraSpan lambda = out.lambda_nm;
  const SampledSpectraSpan pdf = out.density;
  tiles::for_blocks(blocks_for(u.lanes), execution, [&](std::size_t first, std::size_t count) {
    kernel(lambda.row(first, 0), pdf.row(first, 0), u.data + first * kLanesPerBlock, density,
           lambda.axis.count(), count);
  });
  return {};
}

Result<void> terminate_secondary(SampledWavelengthsSpan wavelengths) {
  return terminate_secondary(wavelengths, LaneMask(wavelengths.density.blocks(), ~std::uint64_t{0}));
}

Result<void> terminate_secondary(SampledWavelengthsSpan wavelengths, const LaneMask& lanes) {
  SPECTILE_TRY(shape::same(wavelengths.lambda_nm, wavelengths.density));
  const SampledSpectraSpan& density = wavelengths.density;
  const std::size_t count = density.axis.count();
  if (lanes.size() != density.blocks()) {
    return make_error(ErrorCode::kSizeMismatch, "the mask has {} words, {} lanes have {}", lanes.size(),
                      density.lanes, density.blocks());
  }
  for (std::size_t block = 0; block < lanes.size(); ++block) {
    // Lane by lane where there are any: few surfaces are dispersive.
    for (std::uint64_t left = lanes[block]; left != 0; left &= left - 1) {
      const std::size_t i = block * kLanesPerBlock + static_cast<std::size_t>(std::countr_zero(left));
      bool live = false;
      for (std::size_t k = 1; k < count && i < density.lanes; ++k) live = live || density.at(i, k) != 0;
      if (!live) continue;
      for (std::size_t k = 1; k < count; ++k) density.at(i, k) = 0;
      density.at(i, 0) /= static_cast<float>(count);
    }
  }
  return {};
}

LaneMask secondary_terminated(const SampledWavelengthsView& wavelengths) {
  const SampledSpectraView& density = wavelengths.density;
  const std::size_t count = density.axis.count();
  LaneMask out(density.blocks());
  for (std::size_t i = 0; count > 1 && i < density.lanes; ++i) {
    bool live = false;
    for (std::size_t k = 1; k < count; ++k) live = live || density.at(i, k) != 0;
    out[i / kLanesPerBlock] |= std::uint64_t{!live} << (i % kLanesPerBlock);
  }
  return out;
}

}  // namespace spectile
