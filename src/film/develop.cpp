// FilmDevelopment: pictures from the exact sums, tile by tile.
#include <algorithm>
#include <mutex>

#include "src/base/out_of_memory.hpp"
#include "src/film/pixel.hpp"
#include "src/film/state.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using State = FilmAccess::State;

Result<std::size_t> plane_count(const FilmOptions& o, FilmLayer layer, std::size_t sensor) {
  const auto missing = [](const char* what) {
    return make_error(ErrorCode::kBadArgument, "the film does not keep {}", what);
  };
  switch (layer) {
    case FilmLayer::kXyz:
    case FilmLayer::kSrgb:
    case FilmLayer::kLuminance:
      if (!o.xyz) return missing("XYZ");
      return layer == FilmLayer::kLuminance ? 1 : 3;
    case FilmLayer::kSensor:
      if (sensor < o.sensors.size()) return 3;
      return make_error(ErrorCode::kBadArgument, "the film keeps {} sensors, and there is no number {}",
                        o.sensors.size(), sensor);
    case FilmLayer::kSpectrum:
      if (!o.spectral) return missing("spectra");
      return o.bands.count();
    case FilmLayer::kWeight:
      return 1;
    case FilmLayer::kCount:
      if (o.statistics == PixelStatistics::kNone) return missing("counts");
      return 1;
    case FilmLayer::kVariance:
      if (o.statistics != PixelStatistics::kVariance) return missing("variance");
      return 1;
  }
  return make_error(ErrorCode::kBadArgument, "there is no such layer");
}

}  // namespace

Result<FilmDevelopment> FilmDevelopment::create(const Film& film, FilmLayer layer, std::size_t sensor) {
  SPECTILE_ASSIGN(const auto planes, plane_count(film.options(), layer, sensor));
  FilmDevelopment out;
  out.film_ = film.state_;
  out.layer_ = layer;
  out.sensor_ = sensor;
  out.window_ = film.window();
  out.planes_ = planes;
  out.stride_ = static_cast<std::size_t>(out.window_.width());
  out.plane_floats_ = out.stride_ * static_cast<std::size_t>(out.window_.height());
  SPECTILE_ASSIGN(out.pixels_, FloatBuffer::create(out.planes_ * out.plane_floats_));
  std::fill_n(out.pixels_.data(), out.pixels_.size(), 0.0F);
  const std::size_t tiles = FilmAccess::state(film).tiles.size();
  const auto make = [&]() -> Result<FilmDevelopment> {
    out.seen_.assign(tiles, 0);
    return std::move(out);
  };
  return guard_memory(make, "no memory to develop a film of {} tiles", tiles);
}

Result<DevelopStats> FilmDevelopment::update(const Execution& execution) {
  const State& s = *film_;
  std::atomic<std::size_t> developed = 0;
  std::atomic<std::size_t> unchanged = 0;
  std::atomic<std::size_t> untouched = 0;
  const FilmPixels pixels(s);
  // A tile is some microseconds of work: a task takes a few.
  constexpr std::size_t kTilesAtOnce = 16;
  const std::size_t tasks = (s.tiles.size() + kTilesAtOnce - 1) / kTilesAtOnce;
  tiles::for_blocks(tasks, {execution.threads, kLanesPerBlock}, [&](std::size_t first, std::size_t count) {
    const std::size_t end = std::min(s.tiles.size(), (first + count) * kTilesAtOnce);
    for (std::size_t t = first * kTilesAtOnce; t < end; ++t) {
      const std::scoped_lock lock(s.tile_mutex(t));
      if (s.tiles[t] == nullptr) {
        ++untouched;
        continue;
      }
      if (seen_[t] == s.additions[t]) {
        ++unchanged;
        continue;
      }
      seen_[t] = s.additions[t];
      ++developed;
      const PixelWindow w = s.tile_window(t);
      for (int y = w.y0; y < w.y1; ++y) {
        for (int x = w.x0; x < w.x1; ++x) {
          float* const to = pixels_.data() + static_cast<std::size_t>(y - window_.y0) * stride_ +
                            static_cast<std::size_t>(x - window_.x0);
          pixels.develop(layer_, sensor_, s.tiles[t], pixel_in_tile(x, y), to, plane_floats_);
        }
      }
    }
  });
  if (s.overflown) return film_overflow(s);
  return DevelopStats{developed, unchanged, untouched};
}

}  // namespace spectile
