// Procedural scenes drawn into films: they converge to their reference values, and shards are one run.
#include <algorithm>
#include <spectile/scene/procedural_scene.hpp>

#include "tests/film/film_support.hpp"
#include "tests/scene/scene_support.hpp"

namespace spectile::test {
namespace {

void draw_into(Film& film, const ProceduralScene& s, const SceneSampling& sampling) {
  const FilmOptions& o = film.options();
  const SceneBatch batch = drawn(s, o, sampling, 0, pixels_of(o));
  if (o.input == FilmInput::kWavelengths) {
    ASSERT_TRUE(film.add(batch.wavelength_samples()));
  } else {
    ASSERT_TRUE(film.add(batch.band_samples()));
  }
}

struct Placement {
  const char* filter;
  SamplePlacement placement;
};

constexpr Placement kPlacements[] = {
    {"box:0.5", SamplePlacement::kOnePixel},     {"gaussian:1.5:0.5", SamplePlacement::kOnePixel},
    {"mitchell:2", SamplePlacement::kOnePixel},  {"lanczos:2.5:2", SamplePlacement::kOnePixel},
    {"triangle:1.5x1", SamplePlacement::kSplat}, {"gaussian:2:0.8", SamplePlacement::kSplat}};

FilmOptions options_of(const Placement& placed, FilmInput input) {
  FilmOptions o = film_of(12, 9, placed.filter, placed.placement);
  o.crop = PixelWindow{2, 1, 11, 8};
  o.input = input;
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 50);
  o.negative_weights = true;
  o.statistics = PixelStatistics::kVariance;
  o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
  return o;
}

/// Sums of a value over independent runs.
struct Runs {
  double sum = 0, squares = 0;
  void add(double v) {
    sum += v;
    squares += v * v;
  }
};

void expect_reference(const std::string& name, const Placement& placed, FilmInput input, std::size_t runs,
                      std::uint64_t samples) {
  const ProceduralScene s = scene(name);
  const FilmOptions o = options_of(placed, input);
  std::vector<Runs> values;
  std::vector<double> reference;
  for (std::size_t run = 0; run < runs; ++run) {
    Film film = *Film::create(o);
    SceneSampling sampling;
    sampling.seed = 1000 + run;
    sampling.samples_per_pixel = samples;
    ASSERT_NO_FATAL_FAILURE(draw_into(film, s, sampling));
    std::size_t at = 0;
    for (const FilmLayer layer : {FilmLayer::kXyz, FilmLayer::kSensor, FilmLayer::kSpectrum}) {
      auto d = *FilmDevelopment::create(film, layer);
      ASSERT_TRUE(d.update());
      for (int y = 1; y < 8; ++y) {
        for (int x = 2; x < 11; ++x) {
          const auto xyz = s.xyz(o, x, y);
          const auto rgb = s.sensor(o, 0, x, y);
          const auto bands = s.spectrum(o, x, y);
          for (std::size_t p = 0; p < d.planes(); ++p) {
            if (run == 0) {
              values.emplace_back();
              reference.push_back(layer == FilmLayer::kXyz      ? xyz[p]
                                  : layer == FilmLayer::kSensor ? rgb[p]
                                                                : bands[p]);
            }
            values[at++].add(static_cast<double>(d.at(p, x, y)));
          }
        }
      }
    }
  }
  double sum = 0;
  double worst = 0;
  double count = 0;
  const auto n = static_cast<double>(runs);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double mean = values[i].sum / n;
    const double spread = std::max(0.0, values[i].squares / n - mean * mean) / (n - 1);
    const double rounding = 1e-5 * std::abs(reference[i]) + 1e-12;
    if (std::sqrt(spread) < rounding) {
      EXPECT_NEAR(mean, reference[i], 20 * rounding) << name << " " << placed.filter;
      continue;
    }
    const double z = (mean - reference[i]) / std::sqrt(spread);
    sum += z * z;
    worst = std::max(worst, std::abs(z));
    ++count;
  }
  // Student's t squared with 23 degrees of freedom has a mean of 1.1.
  if (count > 0) {
    EXPECT_LT(sum / count, 2.0) << name << " " << placed.filter << " worst " << worst << " of " << count;
  }
}

TEST(FilmScenes, ConvergeToTheirReference) {
  for (const Placement& placed : kPlacements) {
    for (const auto input : {FilmInput::kWavelengths, FilmInput::kBands}) {
      // Where a filter's tail reaches something bright, a few samples tell nothing of their spread.
      const bool all = placed.placement == SamplePlacement::kSplat || std::string(placed.filter) == "box:0.5";
      for (const char* name : {"gradients", "edges", "mixed"}) {
        if (!all && std::string(name) != "gradients") continue;
        ASSERT_NO_FATAL_FAILURE(expect_reference(name, placed, input, 24, 100));
      }
    }
  }
}

TEST(FilmScenes, AllOfThemConvergeToTheirReference) {
  for (const Placement& placed : kPlacements) {
    for (const auto input : {FilmInput::kWavelengths, FilmInput::kBands}) {
      for (const std::string& name : ProceduralScene::names()) {
        // Its brightest strip is 10^9 times the darkest: a tail that reaches it is not met in so few samples.
        const bool near =
            placed.placement == SamplePlacement::kSplat || std::string(placed.filter) == "box:0.5";
        if (name == "decades" && !near) continue;
        ASSERT_NO_FATAL_FAILURE(expect_reference(name, placed, input, 24, 3000));
      }
    }
  }
}

TEST(FilmScenes, ShardsMergedAreOneRun) {
  for (const Placement& placed : kPlacements) {
    for (const auto input : {FilmInput::kWavelengths, FilmInput::kBands}) {
      for (const std::string& name : ProceduralScene::names()) {
        const FilmOptions o = options_of(placed, input);
        SceneSampling sampling;
        sampling.samples_per_pixel = 11;
        Film whole = *Film::create(o);
        ASSERT_NO_FATAL_FAILURE(draw_into(whole, scene(name), sampling));
        Film merged = *Film::create(o);
        sampling.shards = 3;
        for (sampling.shard = 3; sampling.shard-- > 0;) {
          Film part = *Film::create(o);
          ASSERT_NO_FATAL_FAILURE(draw_into(part, scene(name), sampling));
          ASSERT_TRUE(merged.merge(part));
        }
        EXPECT_TRUE(whole.same_contents(merged)) << name << " " << placed.filter;
        EXPECT_EQ(whole.stats().rejected.total(), 0U) << name << " " << placed.filter;
      }
    }
  }
}

}  // namespace
}  // namespace spectile::test
