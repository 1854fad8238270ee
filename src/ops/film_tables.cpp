// Tables that a film looks things up in: bands by wavelength, and the profiles of its filter.
#include "src/ops/film_tables.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

/// A profile is met within this of its height, or as near as the longest table comes.
constexpr std::int32_t kLeastIntervals = 2048;
constexpr std::int32_t kMostIntervals = 65536;
constexpr double kProfileError = 5e-7;

}  // namespace

Result<void> make_film_buckets(FilmAccess::State& s) {
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
  // Buckets of even width, four an edge: most hold one edge at most.
  constexpr std::size_t kMostBuckets = 4096;
  const std::size_t buckets = std::min(kMostBuckets, 4 * edges.size());
  const float per_nm = static_cast<float>(buckets) / (edges.back() - edges.front());
  const auto bucket_of = [&](float nm) {
    return static_cast<std::size_t>(std::min(static_cast<float>(buckets - 1), (nm - edges.front()) * per_nm));
  };
  std::vector<std::size_t> last_in(buckets, 0);
  for (std::size_t i = 0; i < edges.size(); ++i) last_in[bucket_of(edges[i])] = i;
  for (std::size_t b = 1; b < buckets; ++b) last_in[b] = std::max(last_in[b], last_in[b - 1]);
  std::size_t most = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    const std::size_t before = b == 0 ? 0 : last_in[b - 1];
    most = std::max(most, last_in[b] - before);
    s.bucket_start.push_back(static_cast<std::int32_t>(before));
  }
  std::int32_t halvings = 0;
  while ((std::size_t{1} << halvings) <= most) ++halvings;
  auto memory = FloatBuffer::create(edges.size() + (std::size_t{1} << halvings));
  if (!memory) return memory.error();
  s.bucket_edges = *std::move(memory);
  std::fill_n(s.bucket_edges.data(), s.bucket_edges.size(), std::numeric_limits<float>::infinity());
  std::copy(edges.begin(), edges.end(), s.bucket_edges.data());
  s.buckets = {s.bucket_edges.data(),
               s.bucket_bands.data(),
               static_cast<std::int32_t>(edges.size()),
               s.bucket_start.data(),
               per_nm,
               static_cast<std::int32_t>(buckets),
               halvings};
  return {};
}

Result<void> make_film_profile(FilmProfile& out, double radius, const std::function<double(double)>& at) {
  // The intervals are halved until the straight lines between them are near enough.
  std::int32_t intervals = kLeastIntervals;
  double peak = 0;
  for (double worst = 1; worst > kProfileError && intervals <= kMostIntervals; intervals *= 2) {
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
  auto memory = FloatBuffer::create(2 * static_cast<std::size_t>(intervals));
  if (!memory) return memory.error();
  out.pairs = *std::move(memory);
  const double step = radius / intervals;
  for (std::int32_t i = 0; i < intervals; ++i) {
    const double here = at(i * step);
    float* const pair = out.pairs.data() + std::ptrdiff_t{2} * i;
    pair[0] = static_cast<float>(here);
    pair[1] = static_cast<float>(at(std::min(radius, (i + 1) * step)) - here);
  }
  out.radius = static_cast<float>(radius);
  out.most_pixels = static_cast<int>(std::ceil(2 * radius)) + 1;
  out.table = {out.pairs.data(), 0, static_cast<float>(intervals / radius), intervals};
  return {};
}

}  // namespace spectile
