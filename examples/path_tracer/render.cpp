// Workers that take batches of paths from a common counter, and development to XYZ.
#include "render.hpp"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <thread>

namespace tracer {
namespace {

/// Takes batches until there are none. Which worker gets which does not matter: the film's sums are exact.
Result<Times> work(Wavefront& wavefront, std::atomic<std::uint64_t>& next, std::uint64_t paths) {
  const std::size_t batch = wavefront.batch();
  for (;;) {
    const std::uint64_t first = next.fetch_add(batch);
    if (first >= paths) return wavefront.times();
    SPECTILE_TRY(
        wavefront.run(first, static_cast<std::size_t>(std::min<std::uint64_t>(batch, paths - first))));
  }
}

}  // namespace

Result<Rendered> render(const Scene& scene, const SpectralScene& spectra, const RenderSettings& settings) {
  FilmOptions options;
  options.width = options.height = static_cast<int>(settings.size);
  options.maximum_component = settings.limit;
  options.spectral = settings.kept.has_value();
  if (settings.kept) options.bands = *settings.kept;
  if (const Bands* bands = spectra.axis().bands()) {
    options.input = FilmInput::kBands;
    options.bands = *bands;
  }
  SPECTILE_ASSIGN(Film film, Film::create(options));
  const std::clock_t start = std::clock();
  const std::uint64_t paths = std::uint64_t{settings.size} * settings.size * settings.samples;
  std::atomic<std::uint64_t> next = 0;
  std::vector<Wavefront> wavefronts;
  for (std::size_t i = 0; i < settings.threads; ++i) {
    SPECTILE_ASSIGN(auto wavefront, Wavefront::create(scene, spectra, settings, film));
    wavefronts.push_back(std::move(wavefront));
  }
  std::vector<Result<Times>> results(settings.threads, Times{});
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < settings.threads; ++i) {
    threads.emplace_back([&, i] { results[i] = work(wavefronts[i], next, paths); });
  }
  for (std::thread& thread : threads) thread.join();
  Times sum;
  for (const Result<Times>& result : results) {
    if (!result) return result.error();
    sum.engine += result->engine;
    sum.film += result->film;
    sum.all += result->all;
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return Rendered{std::move(film), sum, seconds, spectra.atlas().texture().cache_stats()};
}

Result<std::array<double, 3>> white_of(const Lamp& lamp) {
  SPECTILE_ASSIGN(const auto spectrum, named_spectrum(lamp.spectrum));
  SPECTILE_ASSIGN(const auto observer, Sensor::named("cie1931"));
  const std::array<double, 3> xyz = observer.response(spectrum);
  return std::array<double, 3>{xyz[0] / xyz[1], 1, xyz[2] / xyz[1]};
}

Result<ColorLanes> xyz_of(const Film& film) {
  SPECTILE_ASSIGN(auto layer, FilmDevelopment::create(film, FilmLayer::kXyz));
  SPECTILE_TRY(layer.update(kOneThread));
  const int width = layer.width();
  const int pixels = width * layer.height();
  SPECTILE_ASSIGN(auto xyz, ColorLanes::create(static_cast<std::size_t>(pixels)));
  for (int i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      xyz.at(static_cast<std::size_t>(i), c) = layer.at(c, i % width, i / width);
  }
  return xyz;
}

}  // namespace tracer
