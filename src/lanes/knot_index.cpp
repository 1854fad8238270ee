// KnotIndex: buckets of even width and where to begin in each.
#include "src/lanes/knot_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

/// Buckets a knot: with four, most buckets hold one knot at most, and the search takes one step.
constexpr std::size_t kBucketsPerKnot = 4;
constexpr std::size_t kMaxBuckets = 4096;

}  // namespace

Result<KnotIndex> index_knots(std::span<const float> knots) {
  KnotIndex out;
  const std::size_t buckets = std::clamp<std::size_t>(kBucketsPerKnot * knots.size(), 1, kMaxBuckets);
  const float range = knots.back() - knots.front();
  // A bucket's limits depend on float rounding: the knots are counted with the kernel's own arithmetic. Where
  // they are too close together, all are in the first bucket.
  out.buckets_per_nm = range > 0 ? static_cast<float>(buckets) / range : 0.0F;
  if (!std::isfinite(out.buckets_per_nm)) out.buckets_per_nm = 0;
  const auto bucket_index = [&](float nm) {
    return static_cast<std::size_t>(
        std::min(static_cast<float>(buckets - 1), (nm - knots.front()) * out.buckets_per_nm));
  };
  std::vector<std::size_t> last_in(buckets, 0);  // last knot up to the bucket's end
  for (std::size_t i = 0; i < knots.size(); ++i) last_in[bucket_index(knots[i])] = i;
  for (std::size_t b = 1; b < buckets; ++b) last_in[b] = std::max(last_in[b], last_in[b - 1]);
  std::size_t most = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    const std::size_t before = b == 0 ? 0 : last_in[b - 1];
    most = std::max(most, last_in[b] - before);
    out.start.push_back(static_cast<std::int32_t>(before));
  }
  while ((std::size_t{1} << out.halvings) <= most) ++out.halvings;
  SPECTILE_ASSIGN(out.knots, FloatBuffer::create(knots.size() + (std::size_t{1} << out.halvings)));
  std::fill_n(out.knots.data(), out.knots.size(), std::numeric_limits<float>::infinity());
  std::copy(knots.begin(), knots.end(), out.knots.data());
  return out;
}

}  // namespace spectile
