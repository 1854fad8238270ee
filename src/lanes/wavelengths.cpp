// Sampled wavelengths in batches: drawing and terminating them, and projecting radiance at them.
#include <algorithm>
#include <cmath>
#include <spectile/color/sensor.hpp>
#include <spectile/lanes/wavelengths.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/rows_of.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using kernels::EvenTable;
using kernels::WavelengthDensity;

// Centre and steepness of the sensitivity. Source: Radziszewski, Boryczko, Alda 2009.
constexpr double kCentreNm = 538;
constexpr double kSteepness = 0.0072;  // 1/nm

constexpr int kFirstNm = static_cast<int>(kFirstVisibleNm);
constexpr int kLastNm = static_cast<int>(kLastVisibleNm);
constexpr std::int32_t kIntervals = kLastNm - kFirstNm;

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

Result<void> same_shape(const WavelengthView& a, const WavelengthView& b) {
  SPECTILE_TRY(shape::same_lanes(a.lanes, b.lanes));
  if (a.count == b.count) return {};
  return make_error(ErrorCode::kSizeMismatch, "one batch has {} wavelengths a lane, the other {}", a.count,
                    b.count);
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
  SPECTILE_ASSIGN(auto buffer, FloatBuffer::create(std::max<std::size_t>(1, stride * count)));
  WavelengthLanes out;
  out.buffer_ = std::move(buffer);
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
    const rows::RowsOf<float> to(lambda, at);
    const rows::RowsOf<float> densities(pdf, at);
    kernel(to.data(), densities.data(), u.data + at, density, out.count(), count * kLanesPerBlock);
  });
  return {};
}

Result<void> terminate_secondary(SampledWavelengths& wavelengths, std::span<const std::uint8_t> lanes_hit) {
  if (!lanes_hit.empty()) SPECTILE_TRY(shape::same_lanes(lanes_hit.size(), wavelengths.lanes()));
  const WavelengthSpan density = wavelengths.density.span();
  for (std::size_t i = 0; i < density.lanes; ++i) {
    if (!lanes_hit.empty() && lanes_hit[i] == 0) continue;
    bool live = false;
    for (std::size_t k = 1; k < density.count; ++k) {
      live = live || density.row(k)[i] != 0;
      density.row(k)[i] = 0;
    }
    if (live) density.row(0)[i] /= static_cast<float>(density.count);
  }
  return {};
}

Result<ResponseCurves> ResponseCurves::of_observer(Observer observer) {
  SPECTILE_ASSIGN(const auto sensor, Sensor::named(observer == Observer::kCie1931 ? "cie1931" : "cie1964"));
  return sensor.response_curves();
}

Result<ResponseCurves> ResponseCurves::create(const std::array<Spectrum, 3>& curves,
                                              const std::array<double, 3>& factors) {
  SPECTILE_ASSIGN(auto buffer, FloatBuffer::create(std::size_t{3} * 2 * kIntervals));
  for (std::size_t c = 0; c < 3; ++c) {
    float* const pairs = buffer.data() + c * 2 * kIntervals;
    for (std::int32_t i = 0; i < kIntervals; ++i) {
      const double value = factors[c] * curves[c](kFirstNm + i);
      const double next = factors[c] * curves[c](kFirstNm + i + 1);
      pairs[2 * i] = static_cast<float>(value);
      pairs[2 * i + 1] = static_cast<float>(next - value);
      if (!std::isfinite(pairs[2 * i]) || !std::isfinite(pairs[2 * i + 1])) {
        return make_error(ErrorCode::kBadArgument, "response curve {} is {} at {} nm", c + 1, value,
                          kFirstNm + i);
      }
    }
  }
  ResponseCurves out;
  out.table_ = std::make_shared<const FloatBuffer>(std::move(buffer));
  return out;
}

Result<void> project(const ResponseCurves& curves, WavelengthView radiance,
                     const SampledWavelengths& wavelengths, ColorSpan color, const Execution& execution) {
  const WavelengthView lambda = wavelengths.lambda_nm.view();
  const WavelengthView density = wavelengths.density.view();
  SPECTILE_TRY(same_shape(radiance, lambda));
  SPECTILE_TRY(same_shape(lambda, density));
  SPECTILE_TRY(shape::same_lanes(radiance.lanes, color.lanes));
  SPECTILE_TRY(shape::aligned(radiance.data));
  for (const float* plane : color.c) SPECTILE_TRY(shape::aligned(plane));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  EvenTable tables[3];
  for (std::size_t c = 0; c < 3; ++c) {
    tables[c] = {curves.table() + c * 2 * kIntervals, static_cast<float>(kFirstNm), 1.0F, kIntervals};
  }
  const float factor = 1.0F / static_cast<float>(radiance.count);
  tiles::for_blocks(blocks_for(radiance.lanes), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    const rows::RowsOf<const float> values(radiance, at);
    const rows::RowsOf<const float> places(lambda, at);
    const rows::RowsOf<const float> densities(density, at);
    float* const to[3] = {color.c[0] + at, color.c[1] + at, color.c[2] + at};
    table->project_wavelengths(to, values.data(), places.data(), densities.data(), tables, factor,
                               radiance.count, count * kLanesPerBlock);
  });
  return {};
}

}  // namespace spectile
