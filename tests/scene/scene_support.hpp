// Shared by the tests of procedural scenes.
#pragma once

#include <spectile/scene/procedural_scene.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {

inline ProceduralScene scene(std::string_view name) {
  return *ProceduralScene::named(name);
}

inline FilmOptions film_of(int width, int height, const char* filter = "box",
                           SamplePlacement placement = SamplePlacement::kSplat) {
  FilmOptions film;
  film.width = width;
  film.height = height;
  film.filter = *PixelFilter::parse(filter);
  film.placement = placement;
  return film;
}

inline std::uint64_t pixels_of(const FilmOptions& film) {
  const PixelWindow w = film.crop.value_or(PixelWindow{0, 0, film.width, film.height});
  return static_cast<std::uint64_t>(w.width() * w.height());
}

inline SceneBatch drawn(const ProceduralScene& s, const FilmOptions& film, const SceneSampling& sampling,
                        std::uint64_t first, std::uint64_t count) {
  const bool wavelengths = film.input == FilmInput::kWavelengths;
  auto batch = *SceneBatch::create(count * sampling.samples_per_pixel,
                                   wavelengths ? sampling.wavelengths : film.bands.count(), wavelengths);
  const auto done = s.draw(film, sampling, first, count, batch);
  EXPECT_TRUE(done) << (done ? "" : done.error().message);
  return batch;
}

inline float of_row(const RowsView& rows, std::size_t k, std::size_t i) {
  return rows.data[k * rows.stride + i];
}

}  // namespace spectile::test
