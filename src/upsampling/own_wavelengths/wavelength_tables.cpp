// WavelengthTables: centres of bands to search, basis spectra at both ends of each interval, whites.
#include "src/upsampling/own_wavelengths/wavelength_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/base/errors.hpp"
#include "src/spectra/sigmoid_functions.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace spectile {
namespace {

using kernels::kSmitsRow;

/// True where centres are evenly spaced to within double's rounding of a list that was written so.
bool are_even(const Bands& bands) {
  const std::size_t n = bands.count();
  const double first = bands[0].centre_nm;
  const double step = (bands[n - 1].centre_nm - first) / static_cast<double>(std::max<std::size_t>(n - 1, 1));
  for (std::size_t i = 0; i < n; ++i) {
    if (std::abs(bands[i].centre_nm - (first + step * static_cast<double>(i))) > 1e-9 * step) return false;
  }
  return true;
}

Result<void> set_centres(const Bands& bands, WavelengthTables& out) {
  const std::size_t n = bands.count();
  kernels::CentreTable& centres = out.centres;
  centres.first_nm = static_cast<float>(bands[0].centre_nm);
  centres.last_nm = static_cast<float>(bands[n - 1].centre_nm);
  centres.intervals = static_cast<std::int32_t>(std::max<std::size_t>(n - 1, 1));
  const double narrowest = 1 / static_cast<double>(std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < n; ++i) {
    const double nm = bands[i].centre_nm;
    const bool too_near = i > 0 && nm - bands[i - 1].centre_nm < narrowest * static_cast<double>(n);
    if (std::isfinite(static_cast<float>(nm)) && !too_near) continue;
    return make_error(ErrorCode::kBadArgument, "bands {} are beyond the range of float", bands.description());
  }
  if (n == 1) return {};
  if (are_even(bands)) {
    const double range = bands[n - 1].centre_nm - bands[0].centre_nm;
    centres.per_nm = static_cast<float>(static_cast<double>(n - 1) / range);
    return {};
  }
  std::vector<float> knots;
  for (const Band& band : bands.list()) knots.push_back(static_cast<float>(band.centre_nm));
  SPECTILE_ASSIGN(out.knots, index_knots(knots));
  SPECTILE_ASSIGN(out.per_width, FloatBuffer::create(n - 1));
  for (std::size_t i = 0; i + 1 < n; ++i) {
    // Two centres that became one in float are a step.
    const double width = static_cast<double>(knots[i + 1]) - static_cast<double>(knots[i]);
    out.per_width.data()[i] = width > 0 ? static_cast<float>(1 / width) : 0.0F;
  }
  centres.knots = out.knots.knots.data();
  centres.per_width = out.per_width.data();
  centres.start = out.knots.start.data();
  centres.buckets_per_nm = out.knots.buckets_per_nm;
  centres.buckets = static_cast<std::int32_t>(out.knots.start.size());
  centres.halvings = out.knots.halvings;
  return {};
}

Result<void> set_ends(const Upsampler& upsampler, WavelengthTables& out) {
  const std::size_t n = upsampler.bands().count();
  const auto intervals = static_cast<std::size_t>(out.centres.intervals);
  SPECTILE_ASSIGN(out.ends, FloatBuffer::create(intervals * kSmitsRow * 2));
  const float* const rows = UpsamplerAccess::table(upsampler);
  for (std::size_t i = 0; i < intervals; ++i) {
    for (std::size_t basis = 0; basis < kSmitsRow; ++basis) {
      float* const pair = out.ends.data() + 2 * (i * kSmitsRow + basis);
      pair[0] = rows[i * kSmitsRow + basis];
      pair[1] = rows[std::min(i + 1, n - 1) * kSmitsRow + basis];
    }
  }
  return {};
}

kernels::EvenTable functions_table(const SigmoidFunctions& functions, std::size_t k) {
  const std::vector<float>& pairs = functions.pairs(k);
  return {pairs.data(), static_cast<float>(SigmoidFunctions::kFirstNm), 1.0F,
          static_cast<std::int32_t>(pairs.size() / 2)};
}

Result<void> set_sigmoid(const Upsampler& upsampler, WavelengthTables& out) {
  kernels::SigmoidLanes& s = out.sigmoid;
  s.lowest_nm = out.centres.first_nm;
  s.highest_nm = out.centres.last_nm;
  s.form = UpsamplerAccess::sigmoid(upsampler)->table.form;
  if (s.form == kernels::SigmoidForm::kFunctions) {
    const SigmoidFunctions& functions = SigmoidFunctions::of(upsampler.options().observer);
    constexpr auto kFirst = static_cast<float>(SigmoidFunctions::kFirstNm);
    constexpr auto kLast = static_cast<float>(SigmoidFunctions::kLastNm);
    s.lowest_nm = std::clamp(s.lowest_nm, kFirst, kLast);
    s.highest_nm = std::clamp(s.highest_nm, kFirst, kLast);
    s.p = functions_table(functions, 0);
    s.q = functions_table(functions, 1);
  }
  if (upsampler.quantity() != Quantity::kIlluminant) return {};
  std::vector<double> centres;
  std::vector<double> values;
  const float* const rows = UpsamplerAccess::sigmoid(upsampler)->table.rows;
  for (std::size_t b = 0; b < upsampler.bands().count(); ++b) {
    centres.push_back(upsampler.bands()[b].centre_nm);
    values.push_back(rows[b * kernels::kSigmoidRow + kernels::kSigmoidWhite]);
  }
  SPECTILE_ASSIGN(const auto white, PiecewiseLinearSpectrum::from_samples(centres, values, Ends::kHeld));
  SPECTILE_ASSIGN(out.white, SpectrumSampler::create(white));
  return {};
}

}  // namespace

Result<std::shared_ptr<const WavelengthTables>> centre_tables(const Bands& bands) {
  const auto out = std::make_shared<WavelengthTables>();
  SPECTILE_TRY(set_centres(bands, *out));
  return std::shared_ptr<const WavelengthTables>(out);
}

Result<std::shared_ptr<const WavelengthTables>> wavelength_tables(const Upsampler& upsampler) {
  const auto out = std::make_shared<WavelengthTables>();
  SPECTILE_TRY(set_centres(upsampler.bands(), *out));
  if (rows::mixes_bases(upsampler)) SPECTILE_TRY(set_ends(upsampler, *out));
  if (is_sigmoid(upsampler.method())) SPECTILE_TRY(set_sigmoid(upsampler, *out));
  return std::shared_ptr<const WavelengthTables>(out);
}

}  // namespace spectile
