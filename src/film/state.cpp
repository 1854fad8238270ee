// State of a film from its options, and its tiles.
#include "src/film/state.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/base/errors.hpp"
#include "src/film/scratch.hpp"
#include "src/film/tables.hpp"

namespace spectile {
namespace {

using kernels::kFilmTilePixels;

static_assert(kFilmTile == 1 << kernels::kFilmTileLog2);

constexpr int kMaxSide = 1 << 18;
constexpr std::size_t kMaxPixels = std::size_t{1} << 31;  // an address is 32 bits, with a sign
constexpr int kMinRange = -32;
constexpr int kMaxRange = 96;
constexpr int kMinWeightRange = -16;
constexpr int kMaxWeightRange = 32;

/// 1.5 * 2^52 steps of 2^log2_step.
double magic(int log2_step) {
  return std::ldexp(1.5, 52 + log2_step);
}

Result<void> check_size(const FilmOptions& o) {
  if (o.width < 1 || o.height < 1 || o.width > kMaxSide || o.height > kMaxSide) {
    return make_error(ErrorCode::kBadArgument,
                      "a film of {} x {} pixels cannot be made: a side takes 1 to {}", o.width, o.height,
                      kMaxSide);
  }
  if (!o.crop) return {};
  const PixelWindow& c = *o.crop;
  if (c.x0 < 0 || c.y0 < 0 || c.x1 > o.width || c.y1 > o.height || c.x0 >= c.x1 || c.y0 >= c.y1) {
    return make_error(ErrorCode::kBadArgument,
                      "the crop window {},{} to {},{} is empty or beyond the film of {} x {} pixels", c.x0,
                      c.y0, c.x1, c.y1, o.width, o.height);
  }
  return {};
}

Result<void> check_contents(const FilmOptions& o) {
  if (!o.xyz && o.sensors.empty() && !o.spectral) {
    return make_error(ErrorCode::kBadArgument, "the film keeps neither a colour nor the spectrum");
  }
  if (o.statistics == PixelStatistics::kVariance && !o.xyz && o.sensors.empty()) {
    return make_error(ErrorCode::kBadArgument, "variance is that of a colour, and the film keeps none");
  }
  for (const NamedSensor& sensor : o.sensors) {
    if (sensor.name.find('\0') == std::string::npos) continue;
    return make_error(ErrorCode::kBadArgument, "a sensor's name holds a zero byte, which files cannot keep");
  }
  if (!(o.maximum_component > 0)) {
    return make_error(ErrorCode::kBadArgument, "a maximum component of {} is not above 0",
                      o.maximum_component);
  }
  if (o.range < kMinRange || o.range > kMaxRange) {
    return make_error(ErrorCode::kBadArgument, "a range of 2^{} is not from 2^{} to 2^{}", o.range, kMinRange,
                      kMaxRange);
  }
  if (o.weight_range < kMinWeightRange || o.weight_range > kMaxWeightRange) {
    return make_error(ErrorCode::kBadArgument, "a weight range of 2^{} is not from 2^{} to 2^{}",
                      o.weight_range, kMinWeightRange, kMaxWeightRange);
  }
  return {};
}

FilmTileLayout tile_layout(const FilmOptions& o) {
  FilmTileLayout out;
  out.quads = std::max<std::size_t>(1, (o.xyz ? 1 : 0) + o.sensors.size());
  out.bands = o.spectral ? o.bands.count() : 0;
  out.own_weights = o.input == FilmInput::kWavelengths;
  out.moments = o.statistics == PixelStatistics::kVariance;
  out.counts = o.statistics == PixelStatistics::kCounts;
  out.spectrum_at = kernels::kFilmQuadLimbs * out.quads * kFilmTilePixels;
  out.moments_at = out.spectrum_at + out.spectrum_limbs() * kFilmTilePixels;
  out.counts_at = out.moments_at + (out.moments ? kernels::kFilmMomentLimbs * kFilmTilePixels : 0);
  out.limbs = out.counts_at + (out.counts ? kFilmTilePixels : 0);
  return out;
}

void make_grids(FilmAccess::State& s) {
  const int color = s.options.range - kFilmCoarseBits;
  const int weight = s.options.weight_range - kFilmCoarseBits;
  for (std::size_t c = 0; c < 4; ++c) {
    const int of_quad = c == kernels::kFilmQuadWeight ? weight : color;
    s.grid.coarse[c] = magic(of_quad);
    s.grid.rest[c] = magic(of_quad - kFilmLimbBits);
    const int of_band =
        s.layout.own_weights && c % kernels::kFilmHitRest == kernels::kFilmHitWeight ? weight : color;
    s.band_grid.coarse[c] = magic(of_band);
    s.band_grid.rest[c] = magic(of_band - kFilmLimbBits);
  }
  // Of w y^2, y and w each up to their range.
  const int square = 2 * s.options.range + s.options.weight_range - kFilmCoarseBits;
  for (int k = 0; k < 4; ++k) s.moment_grid.luminance[k] = magic(square - k * kFilmLimbBits);
  const int weight_square = 2 * s.options.weight_range - kFilmCoarseBits;
  for (int k = 0; k < 3; ++k) s.moment_grid.weight[k] = magic(weight_square - k * kFilmLimbBits);
}

}  // namespace

Film::State::State() = default;
Film::State::~State() = default;

PixelWindow Film::State::tile_window(std::size_t tile) const noexcept {
  const int tx = static_cast<int>(tile % static_cast<std::size_t>(tiles_x));
  const int ty = static_cast<int>(tile / static_cast<std::size_t>(tiles_x));
  const int x = kernel_window.origin_x + tx * kFilmTile;
  const int y = kernel_window.origin_y + ty * kFilmTile;
  return {std::max(x, window.x0), std::max(y, window.y0), std::min(x + kFilmTile, window.x1),
          std::min(y + kFilmTile, window.y1)};
}

std::int64_t* Film::State::touch(std::size_t tile) noexcept {
  if (tiles[tile] == nullptr) {
    tiles[tile] = static_cast<std::int64_t*>(pages.take(layout.limbs * sizeof(std::int64_t)));
  }
  return tiles[tile];
}

namespace {

// A quarter of what a limb holds: far beyond 2^31 contributions at the range's end, and far from its end.
constexpr std::int64_t kMaxCoarse = std::int64_t{1} << 62;

}  // namespace

void Film::State::normalize_carries(std::size_t tile) noexcept {
  std::int64_t* const limbs = tiles[tile];
  if (limbs == nullptr || normalized[tile] == additions[tile]) return;
  normalized[tile] = additions[tile];
  bool fits = true;
  const auto carry = [&fits](std::int64_t& coarse, std::int64_t& rest) {
    film_carry(coarse, rest);
    fits = fits && coarse <= kMaxCoarse && coarse >= -kMaxCoarse;
  };
  const auto carry_quads = [&carry](std::int64_t* quads, std::size_t count) {
    for (std::int64_t* q = quads; q < quads + kernels::kFilmQuadLimbs * count; q += kernels::kFilmQuadLimbs) {
      for (std::size_t c = 0; c < kernels::kFilmQuadRest; ++c) carry(q[c], q[c + kernels::kFilmQuadRest]);
    }
  };
  carry_quads(limbs, layout.quads * kFilmTilePixels);
  std::int64_t* const spectrum = limbs + layout.spectrum_at;
  if (layout.own_weights) {
    for (std::size_t b = 0; b < layout.bands * kFilmTilePixels; ++b) {
      std::int64_t* const band = spectrum + kernels::kFilmHitLimbs * b;
      for (std::size_t c = 0; c < kernels::kFilmHitRest; ++c) carry(band[c], band[c + kernels::kFilmHitRest]);
    }
  } else {
    carry_quads(spectrum, layout.band_quads() * kFilmTilePixels);
  }
  for (std::size_t p = 0; layout.moments && p < kFilmTilePixels; ++p) {
    std::int64_t* const m = limbs + layout.moments_at + kernels::kFilmMomentLimbs * p;
    for (std::size_t k = kernels::kFilmSquareLimbs - 1; k > 1; --k) film_carry(m[k - 1], m[k]);
    carry(m[0], m[1]);
    film_carry(m[kernels::kFilmWeightSquare[1]], m[kernels::kFilmWeightSquare[2]]);
    carry(m[kernels::kFilmWeightSquare[0]], m[kernels::kFilmWeightSquare[1]]);
  }
  if (!fits) overflown = true;
}

Error film_overflow(const FilmAccess::State& s) {
  return make_error(ErrorCode::kUnavailable,
                    "a pixel's sum is beyond 2^31 contributions of the film's range of 2^{}",
                    s.options.range);
}

Result<std::unique_ptr<FilmAccess::State>> prepare_film(const FilmOptions& options) {
  SPECTILE_TRY(check_size(options));
  SPECTILE_TRY(check_contents(options));
  auto state = std::make_unique<FilmAccess::State>();
  FilmAccess::State& s = *state;
  s.options = options;
  s.window = options.crop.value_or(PixelWindow{0, 0, options.width, options.height});
  const int tile_x0 = s.window.x0 / kFilmTile;
  const int tile_y0 = s.window.y0 / kFilmTile;
  s.tiles_x = (s.window.x1 - 1) / kFilmTile - tile_x0 + 1;
  s.tiles_y = (s.window.y1 - 1) / kFilmTile - tile_y0 + 1;
  s.kernel_window = {static_cast<float>(s.window.x0),
                     static_cast<float>(s.window.y0),
                     static_cast<float>(s.window.x1),
                     static_cast<float>(s.window.y1),
                     tile_x0 * kFilmTile,
                     tile_y0 * kFilmTile,
                     s.tiles_x,
                     options.negative_weights};
  s.layout = tile_layout(options);
  s.limits = {options.maximum_component, std::ldexp(1.0F, options.range),
              std::ldexp(1.0F, options.weight_range)};
  make_grids(s);
  if (options.spectral && options.input == FilmInput::kWavelengths) SPECTILE_TRY(make_film_buckets(s));
  if (options.placement == SamplePlacement::kSplat) {
    const PixelFilter& f = options.filter;
    SPECTILE_TRY(make_film_profile(s.along_x, f.radius_x(), [&](double d) { return f.along_x(d); }));
    SPECTILE_TRY(make_film_profile(s.along_y, f.radius_y(), [&](double d) { return f.along_y(d); }));
  }
  const std::size_t tiles = static_cast<std::size_t>(s.tiles_x) * static_cast<std::size_t>(s.tiles_y);
  if (tiles * kFilmTilePixels > kMaxPixels) {
    return make_error(ErrorCode::kBadArgument, "a window of {} x {} pixels holds more than 2^31 in its tiles",
                      s.window.width(), s.window.height());
  }
  s.stripes = std::make_unique<FilmAccess::State::Stripe[]>(FilmAccess::State::kStripes);
  s.tiles.assign(tiles, nullptr);
  s.additions.assign(tiles, 0);
  s.normalized.assign(tiles, 0);
  return state;
}

}  // namespace spectile
