// LineStats: what a run of lines was found to hold, and what was and was not spent on it.
#include "src/io/convert/frame/line_stats.hpp"

namespace spectile::io {

void SkipCosts::add(const SkipCosts& later) {
  computed_pixels += later.computed_pixels;
  computing_seconds += later.computing_seconds;
  filled_pixels += later.filled_pixels;
  filling_seconds += later.filling_seconds;
  colors_looked_up += later.colors_looked_up;
  colors_solved += later.colors_solved;
  lanes_solved += later.lanes_solved;
  lookup_seconds += later.lookup_seconds;
  solving_seconds += later.solving_seconds;
  chunks += later.chunks;
  chunks_reused += later.chunks_reused;
  reused_seconds += later.reused_seconds;
}

void PixelCount::add(std::uint64_t more, int x, int y) {
  if (more == 0) return;
  // Tiles do not come in the order of their pixels.
  if (count == 0 || y < first_y || (y == first_y && x < first_x)) {
    first_x = x;
    first_y = y;
  }
  count += more;
}

void PixelCount::add(const PixelCount& later) {
  add(later.count, later.first_x, later.first_y);
}

void LineStats::add(const LineStats& later) {
  nonfinite.add(later.nonfinite);
  negative.add(later.negative);
  outside.add(later.outside);
  over_one += later.over_one;
  clamped += later.clamped;
  divided_by_alpha += later.divided_by_alpha;
  above_alpha += later.above_alpha;
  masked += later.masked;
  black += later.black;
  constant += later.constant;
  costs.add(later.costs);
}

LineStats LineStats::moved(int right, int down) const {
  LineStats out = *this;
  for (PixelCount* const found : {&out.nonfinite, &out.negative, &out.outside}) {
    if (found->count > 0) *found = found->moved({right, down});
  }
  return out;
}

SkipStats skip_stats(const LineStats& stats) {
  const SkipCosts& costs = stats.costs;
  const auto each = [](double seconds, std::uint64_t n) {
    return n == 0 ? 0.0 : seconds / static_cast<double>(n);
  };
  SkipStats out;
  out.masked_pixels = stats.masked;
  // Masked pixels were black, too, when these were counted.
  out.black_pixels = stats.black - stats.masked;
  out.constant_pixels = stats.constant;
  out.chunks = costs.chunks;
  out.chunks_reused = costs.chunks_reused;
  out.colors_looked_up = costs.colors_looked_up;
  out.colors_solved = costs.colors_solved;
  const double filled =
      static_cast<double>(costs.filled_pixels) * each(costs.computing_seconds, costs.computed_pixels) -
      costs.filling_seconds;
  const double found = static_cast<double>(costs.colors_looked_up - costs.colors_solved) *
                           each(costs.solving_seconds, costs.lanes_solved) -
                       costs.lookup_seconds;
  out.core_seconds_saved = costs.reused_seconds + (costs.computed_pixels > 0 ? filled : 0) +
                           (costs.colors_looked_up > 0 ? found : 0);
  return out;
}

}  // namespace spectile::io
