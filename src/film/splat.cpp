// Splatting: a sample becomes an entry for every pixel within the filter's radius.
#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"
#include "src/film/entries.hpp"

namespace spectile {
namespace {

using kernels::kFilmTilePixels;
using State = FilmAccess::State;

/// Most samples that become entries at once, and how many entries that should be about: they stay in the
/// second-level cache.
constexpr std::size_t kPart = 256;
constexpr std::size_t kEntries = 16384;
static_assert(kPart % kernels::kLanes == 0);

/// A chunk's footprints along one axis: the first pixel of each sample, and the filter's profile from there.
struct Axis {
  const FilmProfile& profile;
  const float* position;
  int low, high;  ///< pixels of the window, the last exclusive
  int* first;
  float* weights;  ///< [max_pixels][kPart]

  /// Pixels whose centres lie in (position - radius, position + radius]; 0 beyond.
  void measure(const kernels::KernelTable& table, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      // In double: next to a far position a float loses the radius's last digits, and so the first pixel.
      const double start = static_cast<double>(position[i]) - (0.5 + static_cast<double>(profile.radius));
      // A position that is far away, or no number, is refused before its footprint is used.
      first[i] = std::abs(start) < 0x1p24 ? static_cast<int>(std::floor(start)) + 1 : 0;
    }
    for (int j = 0; j < profile.max_pixels; ++j) {
      float* const row = weights + static_cast<std::size_t>(j) * kPart;
      for (std::size_t i = 0; i < n; ++i) {
        const double distance = (static_cast<double>(first[i] + j) + 0.5) - static_cast<double>(position[i]);
        const auto radius = static_cast<double>(profile.radius);
        // Beyond the table, and so 0, at and before the near end and beyond the far one.
        const bool inside = distance > -radius && distance <= radius;
        row[i] = inside ? static_cast<float>(std::abs(distance)) : 2 * profile.radius;
      }
      table.interpolate_even(row, row, profile.table, kPart);
    }
  }
  /// The sample's pixels within the window, counted from its first one.
  int from(std::size_t i) const { return std::max(0, low - first[i]); }
  int to(std::size_t i) const { return std::min(profile.max_pixels, high - first[i]); }
};

std::int32_t rejection_reason(const State& s, float x, float y, float w, std::int32_t known, bool reached) {
  std::int32_t out = kernels::kFilmAccepted;
  const auto found = [&](std::int32_t reason) {
    if (out == kernels::kFilmAccepted || reason < out) out = reason;
  };
  if (known != kernels::kFilmAccepted) found(known);
  if (std::isnan(x) || std::isnan(y) || std::isnan(w)) {
    found(kernels::kFilmNan);
  } else if (std::isinf(x) || std::isinf(y) || std::isinf(w)) {
    found(kernels::kFilmInfinite);
  } else {
    if (w < 0 && !s.options.negative_weights) found(kernels::kFilmNegative);
    if (!reached) found(kernels::kFilmOutside);
  }
  return out;
}

}  // namespace

Result<void> splat(State& s, const kernels::KernelTable& table, const FilmContributions& contributions,
                   const float* x, const float* y, const float* weight, std::size_t n,
                   std::array<std::uint64_t, kernels::kFilmReasons>& counts, FilmScratch& scratch) {
  const auto columns = static_cast<std::size_t>(s.along_x.max_pixels);
  const auto rows = static_cast<std::size_t>(s.along_y.max_pixels);
  if (scratch.profiles.size() < (columns + rows) * kPart) {
    SPECTILE_ASSIGN(scratch.profiles, FloatBuffer::create((columns + rows) * kPart));
    std::fill_n(scratch.profiles.data(), scratch.profiles.size(), 0.0F);
  }
  std::array<int, kPart> first_x{};
  std::array<int, kPart> first_y{};
  const std::size_t at_once = std::clamp<std::size_t>(kEntries / (columns * rows), 1, kPart);
  const std::size_t most = at_once * columns * rows;
  scratch.sample.resize(std::max(scratch.sample.size(), most));
  scratch.address.resize(std::max(scratch.address.size(), most));
  scratch.factor.resize(std::max(scratch.factor.size(), most));
  // A column's part of an address.
  std::vector<std::int32_t> column_part(columns);
  for (std::size_t start = 0; start < n; start += at_once) {
    const std::size_t part = std::min(at_once, n - start);
    Axis across{s.along_x, x + start, s.window.x0, s.window.x1, first_x.data(), scratch.profiles.data()};
    Axis down{s.along_y,   y + start,      s.window.y0,
              s.window.y1, first_y.data(), scratch.profiles.data() + columns * kPart};
    across.measure(table, part);
    down.measure(table, part);
    std::size_t count = 0;
    for (std::size_t i = 0; i < part; ++i) {
      const std::size_t before = count;
      const bool near = std::abs(x[start + i]) < 0x1p22F && std::abs(y[start + i]) < 0x1p22F;
      const int from = across.from(i);
      const int to = near ? across.to(i) : from;
      for (int c = from; c < to; ++c) {
        const int px = first_x[i] + c - s.kernel_window.origin_x;
        column_part[static_cast<std::size_t>(c)] =
            px / kFilmTile * static_cast<int>(kFilmTilePixels) + px % kFilmTile;
      }
      for (int r = down.from(i); from < to && r < down.to(i); ++r) {
        const float by_row = down.weights[static_cast<std::size_t>(r) * kPart + i];
        const int py = first_y[i] + r - s.kernel_window.origin_y;
        const std::int32_t row_part =
            py / kFilmTile * s.tiles_x * static_cast<int>(kFilmTilePixels) + py % kFilmTile * kFilmTile;
        for (int c = from; c < to; ++c) {
          const float f = across.weights[static_cast<std::size_t>(c) * kPart + i] * by_row;
          scratch.sample[count] = static_cast<std::uint32_t>(start + i);
          scratch.address[count] = row_part + column_part[static_cast<std::size_t>(c)];
          scratch.factor[count] = f;
          count += f != 0.0F ? 1 : 0;
        }
      }
      const std::int32_t reason =
          rejection_reason(s, x[start + i], y[start + i], weight == nullptr ? 1.0F : weight[start + i],
                           scratch.reasons[start + i], count > before);
      ++counts[static_cast<std::size_t>(reason)];
      if (reason != kernels::kFilmAccepted) count = before;
    }
    SPECTILE_TRY(add_entries(s, table, contributions,
                             {scratch.sample.data(), scratch.address.data(), scratch.factor.data(), count},
                             scratch));
  }
  return {};
}

}  // namespace spectile
