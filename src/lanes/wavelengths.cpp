// Sampled wavelengths in batches: drawing and terminating them.
#include <algorithm>
#include <cmath>
#include <spectile/lanes/wavelengths.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/row_pointers.hpp"
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

Result<WavelengthLanes> WavelengthLanes::create(std::size_t lanes, std::size_t count) {
  if (count == 0 || count > kMaxWavelengths) {
    return make_error(ErrorCode::kBadArgument, "a lane takes 1 to {} wavelengths, not {}", kMaxWavelengths,
                      count);
  }
  const std::size_t stride = blocks_for(lanes) * kLanesPerBlock;
  if (lanes > (std::size_t{1} << 56) / count) {
    return make_error(ErrorCode::kOutOfMemory, "{} lanes of {} wavelengths do not fit in memory", lanes,
                      count);
  }
  WavelengthLanes out;
  SPECTILE_ASSIGN(out.buffer_, FloatBuffer::create(std::max<std::size_t>(1, stride * count)));
  std::fill_n(out.buffer_.data(), out.buffer_.size(), 0.0F);
  out.lanes_ = lanes;
  out.count_ = count;
  out.stride_ = stride;
  return out;
}

Result<SampledWavelengths> SampledWavelengths::create(std::size_t lanes, std::size_t count) {
  SPECTILE_ASSIGN(auto lambda, WavelengthLanes::create(lanes, count));
  SPECTILE_ASSIGN(auto density, WavelengthLanes::create(lanes, count));
  return SampledWavelengths{std::move(lambda), std::move(density)};
}

Result<void> sample_wavelengths(WavelengthSampling sampling, LanesView u, SampledWavelengths& out,
                                double first_nm, double last_nm, const Execution& execution) {
  SPECTILE_TRY(shape::same_lanes(u.lanes, out.lanes()));
  SPECTILE_TRY(shape::aligned(u.data));
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
  const WavelengthSpan lambda = out.lambda_nm.span();
  const WavelengthSpan pdf = out.density.span();
  tiles::for_blocks(blocks_for(u.lanes), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    const rows::RowPointers<float> to(lambda, at);
    const rows::RowPointers<float> densities(pdf, at);
    kernel(to.data(), densities.data(), u.data + at, density, out.count(), count * kLanesPerBlock);
  });
  return {};
}

Result<void> terminate_secondary(SampledWavelengths& wavelengths) {
  return terminate_secondary(wavelengths, LaneMask(blocks_for(wavelengths.lanes()), ~std::uint64_t{0}));
}

Result<void> terminate_secondary(SampledWavelengths& wavelengths, const LaneMask& lanes) {
  const WavelengthSpan density = wavelengths.density.span();
  if (lanes.size() != blocks_for(density.lanes)) {
    return make_error(ErrorCode::kSizeMismatch, "the mask has {} words, {} lanes have {}", lanes.size(),
                      density.lanes, blocks_for(density.lanes));
  }
  const LaneMask already = secondary_terminated(wavelengths);
  for (std::size_t i = 0; i < density.lanes; ++i) {
    const std::size_t word = i / kLanesPerBlock;
    if (((lanes[word] & ~already[word]) >> (i % kLanesPerBlock) & 1) == 0) continue;
    for (std::size_t k = 1; k < density.count; ++k) density.row(k)[i] = 0;
    if (density.count > 1) density.row(0)[i] /= static_cast<float>(density.count);
  }
  return {};
}

LaneMask secondary_terminated(const SampledWavelengths& wavelengths) {
  const WavelengthView density = wavelengths.density.view();
  LaneMask out(blocks_for(density.lanes));
  for (std::size_t i = 0; density.count > 1 && i < density.lanes; ++i) {
    bool live = false;
    for (std::size_t k = 1; k < density.count; ++k) live = live || density.row(k)[i] != 0;
    out[i / kLanesPerBlock] |= std::uint64_t{!live} << (i % kLanesPerBlock);
  }
  return out;
}

}  // namespace spectile
