// ResponseCurves: tables at 1 nm, and the projection of radiance at sampled wavelengths.
#include <cmath>
#include <spectile/color/sensor.hpp>

#include "src/base/errors.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

constexpr int kFirstNm = static_cast<int>(kFirstVisibleNm);
constexpr int kLastNm = static_cast<int>(kLastVisibleNm);
constexpr std::int32_t kIntervals = kLastNm - kFirstNm;

}  // namespace

Result<ResponseCurves> ResponseCurves::of_observer(Observer observer) {
  SPECTILE_ASSIGN(const auto sensor, Sensor::named(observer == Observer::kCie1931 ? "cie1931" : "cie1964"));
  return sensor.response_curves();
}

Result<ResponseCurves> ResponseCurves::create(const std::array<Spectrum, 3>& curves,
                                              const std::array<double, 3>& factors) {
  SPECTILE_ASSIGN(auto buffer, FloatBuffer::create(std::size_t{3} * 2 * kIntervals));
  for (std::size_t c = 0; c < 3; ++c) {
    float* pair = buffer.data() + c * 2 * kIntervals;
    for (std::int32_t i = 0; i < kIntervals; ++i, pair += 2) {
      const double value = factors[c] * curves[c](kFirstNm + i);
      const double next = factors[c] * curves[c](kFirstNm + i + 1);
      pair[0] = static_cast<float>(value);
      pair[1] = static_cast<float>(next - value);
      if (!std::isfinite(pair[0]) || !std::isfinite(pair[1])) {
        return make_error(ErrorCode::kBadArgument, "response curve {} is {} at {} nm", c + 1, value,
                          kFirstNm + i);
      }
    }
  }
  ResponseCurves out;
  out.table_ = std::make_shared<const FloatBuffer>(std::move(buffer));
  return out;
}

Result<void> project(const ResponseCurves& curves, SampledSpectraView radiance,
                     const SampledWavelengthsView& wavelengths, ColorSpan color, const Execution& execution) {
  SPECTILE_TRY(shape::own_wavelengths(wavelengths.lambda_nm.axis));
  SPECTILE_TRY(shape::same(radiance, wavelengths.lambda_nm));
  SPECTILE_TRY(shape::same(radiance, wavelengths.density));
  SPECTILE_TRY(shape::same_lanes(radiance.lanes, color.lanes));
  SPECTILE_TRY(shape::aligned(radiance.data));
  SPECTILE_TRY(shape::aligned(wavelengths.lambda_nm.data));
  SPECTILE_TRY(shape::aligned(wavelengths.density.data));
  SPECTILE_TRY(shape::aligned(color));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  kernels::EvenTable tables[3];
  for (std::size_t c = 0; c < 3; ++c) {
    tables[c] = {ResponseCurvesAccess::table(curves) + c * 2 * kIntervals, static_cast<float>(kFirstNm), 1.0F,
                 kIntervals};
  }
  const std::size_t k = radiance.axis.count();
  tiles::for_blocks(radiance.blocks(), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    float* const to[3] = {color.c[0] + at, color.c[1] + at, color.c[2] + at};
    table->project_wavelengths(
        to,
        {radiance.data + k * at, wavelengths.lambda_nm.data + k * at, wavelengths.density.data + k * at, k},
        tables, 1.0F / static_cast<float>(k), count);
  });
  return {};
}

}  // namespace spectile
