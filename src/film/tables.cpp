// Tables that a film looks things up in: bands by wavelength, and the profiles of its filter.
#include "src/film/tables.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

/// A profile is met within this of its height, or as near as the longest table comes.
constexpr std::int32_t kMinIntervals = 2048;
constexpr std::int32_t kMaxIntervals = 65536;
constexpr double kProfileError = 5e-7;

}  // namespace

Result<void> make_film_buckets(FilmAccess::State& s) {
  if (s.options.bands.are_points()) {
    return make_error(
        ErrorCode::kBadArgument,
        "a film fed with wavelengths keeps averages over bands; the plan's samples are values at "
        "{} wavelengths, which a film fed with bands takes",
        s.options.bands.count());
  }
  if (s.options.bands.overlap()) {
    return make_error(
        ErrorCode::kBadArgument,
        "a film fed with wavelengths divides them among its bands, and the plan's bands overlap; "
        "make one with --sample apart");
  }
  std::vector<float> edges;
  for (const Band& band : s.options.bands.list()) {
    const auto lower = static_cast<float>(band.lower_nm);
    if (!edges.empty() && edges.back() == lower) {
      s.bucket_bands.back() = static_cast<std::int32_t>(&band - s.options.bands.list().data());
    } else {
      edges.push_back(lower);
      s.bucket_bands.push_back(static_cast<std::int32_t>(&band - s.options.bands.list().data()));
    }
    edges.push_back(static_cast<float>(band.upper_nm));
    s.bucket_bands.push_back(-1);
  }
  if (!std::is_sorted(edges.begin(), edges.end(), std::less_equal<>())) {
    return make_error(ErrorCode::kBadArgument, "bands {} have edges that float cannot tell apart",
                      s.options.bands.description());
  }
  SPECTILE_ASSIGN(s.bucket_index, index_knots(edges));
  s.buckets = {s.bucket_index.knots.data(),
               s.bucket_bands.data(),
               static_cast<std::int32_t>(edges.size()),
               s.bucket_index.start.data(),
               s.bucket_index.buckets_per_nm,
               static_cast<std::int32_t>(s.bucket_index.start.size()),
               s.bucket_index.halvings};
  return {};
}

Result<void> make_film_profile(FilmProfile& out, double radius, const std::function<double(double)>& at) {
  // The intervals are halved until the straight lines between them are near enough.
  std::int32_t intervals = kMinIntervals;
  double peak = 0;
  for (double worst = 1; worst > kProfileError && intervals <= kMaxIntervals; intervals *= 2) {
    const double step = radius / intervals;
    worst = 0;
    for (std::int32_t i = 0; i < intervals; ++i) {
      const double here = at(i * step);
      peak = std::max(peak, std::abs(here));
      worst = std::max(worst,
                       std::abs(at((i + 0.5) * step) - 0.5 * (here + at(std::min(radius, (i + 1) * step)))));
    }
  }
  intervals /= 2;
  // The film's range holds for contributions at the centre of the filter: nowhere may it be higher.
  constexpr double kRoundings = 1e-6;
  if (!(peak <= 1 + kRoundings)) {
    return make_error(
        ErrorCode::kBadArgument,
        "the filter reaches {:.3g} times its value at the centre; a film splats filters that are "
        "largest there",
        peak);
  }
  SPECTILE_ASSIGN(out.pairs, FloatBuffer::create(2 * static_cast<std::size_t>(intervals)));
  const double step = radius / intervals;
  for (std::int32_t i = 0; i < intervals; ++i) {
    const double here = at(i * step);
    float* const pair = out.pairs.data() + std::ptrdiff_t{2} * i;
    pair[0] = static_cast<float>(here);
    pair[1] = static_cast<float>(at(std::min(radius, (i + 1) * step)) - here);
  }
  out.radius = static_cast<float>(radius);
  out.max_pixels = static_cast<int>(std::ceil(2 * radius)) + 1;
  out.table = {out.pairs.data(), 0, static_cast<float>(intervals / radius), intervals};
  return {};
}

}  // namespace spectile
