// Procedural scenes: exact values of pixels against brute force and against what can be said without it.
#include "tests/scene/scene_support.hpp"

namespace spectile::test {
namespace {

/// Within a nanometre, where spectra are linear: the average is the value at the centre.
Bands narrow_bands() {
  return *Bands::from_list({{435.25, 435.5, 435.75}, {611.25, 611.5, 611.75}});
}

/// A pixel of those bands by the definition: a fine grid over the filter's support.
struct BruteForce {
  std::array<double, 2> mean{};
  double error = 0;  // where four edges cross all of the filter: half a step of the grid along each
};
BruteForce brute_force(const ProceduralScene& s, const FilmOptions& film, int px, int py, int steps) {
  const PixelFilter& f = film.filter;
  const bool splat = film.placement == SamplePlacement::kSplat;
  const PixelWindow w = film.crop.value_or(PixelWindow{0, 0, film.width, film.height});
  BruteForce out;
  double sum = 0;
  double largest = 0;
  for (int j = 0; j < steps; ++j) {
    for (int i = 0; i < steps; ++i) {
      const double dx = f.radius_x() * (2 * (i + 0.5) / steps - 1);
      const double dy = f.radius_y() * (2 * (j + 0.5) / steps - 1);
      const double x = px + 0.5 + dx;
      const double y = py + 0.5 + dy;
      if (splat && !(x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1)) continue;
      sum += f(dx, dy);
      for (std::size_t b = 0; b < 2; ++b) {
        const double seen = s.radiance(x, y, film.bands[b].centre_nm, film.width, film.height);
        out.mean[b] += f(dx, dy) * seen;
        largest = std::max(largest, seen);
      }
    }
  }
  for (double& v : out.mean) v /= sum;
  out.error = largest * 4 * 0.5 * steps / sum;
  return out;
}

TEST(ProceduralScene, KnowsItsNames) {
  const std::vector<std::string> want = {"gradients", "edges", "spikes", "decades", "mixed"};
  EXPECT_EQ(ProceduralScene::names(), want);
  for (const std::string& name : want) EXPECT_TRUE(ProceduralScene::named(name)) << name;
  const auto none = ProceduralScene::named("teapot");
  ASSERT_EQ(code_of(none), code(ErrorCode::kUnknownName));
  EXPECT_NE(none.error().message.find("\"teapot\" is unknown; there are gradients, edges"),
            std::string::npos);
}

TEST(ProceduralScene, ValuesAreTheMeansOfItsRadiance) {
  constexpr int kSteps = 400;
  for (const std::string& name : ProceduralScene::names()) {
    const ProceduralScene s = scene(name);
    for (const char* filter : {"box", "triangle:1.2x0.8", "gaussian:1.5:0.5", "mitchell:2", "lanczos:3:3"}) {
      for (const auto placement : {SamplePlacement::kSplat, SamplePlacement::kOnePixel}) {
        FilmOptions film = film_of(7, 5, filter, placement);
        film.crop = PixelWindow{1, 0, 6, 4};
        film.bands = narrow_bands();
        for (const auto& [x, y] : {std::pair{1, 0}, {3, 2}, {5, 3}}) {
          const std::vector<double> got = s.spectrum(film, x, y);
          const BruteForce want = brute_force(s, film, x, y, kSteps);
          for (std::size_t b = 0; b < 2; ++b) {
            ASSERT_NEAR(got[b], want.mean[b], want.error)
                << name << " " << filter << " at " << x << ", " << y << " band " << b;
          }
        }
      }
    }
  }
}

TEST(ProceduralScene, BoxesOverEdgesAreSharesOfArea) {
  // The dark bar of 1/10 of "decades" between 0.45 and 0.55 in a film of one row and ten columns.
  const FilmOptions film = film_of(10, 1);
  const ProceduralScene s = scene("decades");
  for (int x = 0; x < 10; ++x) {
    const auto up = s.xyz(film_of(10, 20), x, 0);
    const auto down = s.xyz(film_of(10, 20), x, 19);
    EXPECT_NEAR(up[1] / std::pow(10.0, x - 6), 1, 1e-12);
    EXPECT_NEAR(down[1] / std::pow(10.0, 3 - x), 1, 1e-12);
    const auto all = s.xyz(film, x, 0);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(all[c], 0.45 * (up[c] + down[c]), 1e-12 * (up[c] + down[c]));
    }
  }
}

TEST(ProceduralScene, SmoothFiltersOfRampsAreTheirMiddle) {
  // An even filter of a product of linear functions is its value at the centre.
  const ProceduralScene s = scene("gradients");
  for (const char* filter : {"box", "triangle:2", "gaussian", "mitchell", "lanczos:4:3"}) {
    FilmOptions film = film_of(40, 40, filter);
    film.sensors = {{"canon", *Sensor::named("canon-eos-5d-mkii")}, {"two", *Sensor::named("cie1931")}};
    film.bands = Bands();
    for (const auto& [x, y] : {std::pair{6, 5}, {10, 10}, {33, 34}, {30, 8}}) {
      std::vector<double> seen;
      for (int nm = 360; nm <= 830; ++nm) seen.push_back(s.radiance(x + 0.5, y + 0.5, nm, 40, 40));
      const auto light = *DenselySampledSpectrum::from_values(360, seen);
      const auto near = [&](const std::array<double, 3>& got, const std::array<double, 3>& want) {
        for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(got[c], want[c], 1e-11 * want[c]) << filter;
      };
      near(s.xyz(film, x, y), Sensor::named("cie1931")->response(light));
      near(s.sensor(film, 0, x, y), film.sensors[0].sensor.response(light));
      near(s.sensor(film, 1, x, y), s.xyz(film, x, y));
      film.xyz = Observer::kCie1964;
      near(s.xyz(film, x, y), Sensor::named("cie1964")->response(light));
      film.xyz = Observer::kCie1931;
      const std::vector<double> bands = s.spectrum(film, x, y);
      const std::vector<float> want = light.average_over(film.bands);
      for (std::size_t b = 0; b < want.size(); ++b) ASSERT_NEAR(bands[b], want[b], 1e-6 * want[b] + 1e-12);
      // Fed with bands a film projects their averages.
      film.input = FilmInput::kBands;
      const auto projector = *Projector::emissive(film.bands);
      std::array<double, 3> projected{};
      for (std::size_t b = 0; b < want.size(); ++b) {
        for (std::size_t c = 0; c < 3; ++c) projected[c] += projector.weights()[b][c] * bands[b];
      }
      near(s.xyz(film, x, y), projected);
      film.input = FilmInput::kWavelengths;
    }
  }
  EXPECT_EQ(s.sensor(film_of(4, 4), 0, 1, 1), (std::array<double, 3>{}));
}

TEST(ProceduralScene, BlackIsExactlyBlack) {
  for (const char* filter : {"box", "mitchell:0.9", "lanczos:0.9:3"}) {
    const FilmOptions film = film_of(40, 40, filter);
    for (int x = 0; x < 40; ++x) {
      EXPECT_EQ(scene("decades").xyz(film, x, 19), (std::array<double, 3>{0, 0, 0}));
      EXPECT_EQ(scene("edges").xyz(film, x, 0), (std::array<double, 3>{0, 0, 0}));
    }
  }
  // A hole painted black over what is bright, and beyond the square.
  EXPECT_EQ(scene("edges").radiance(0.65, 0.75, 550, 1, 1), 0);
  EXPECT_GT(scene("edges").radiance(0.55, 0.75, 550, 1, 1), 0);
  EXPECT_EQ(scene("spikes").radiance(-1e-9, 0.5, 550, 1, 1), 0);
  EXPECT_EQ(scene("spikes").radiance(1, 0.5, 550, 1, 1), 0);
  EXPECT_GT(scene("spikes").radiance(0, 0, 550, 1, 1), 0);
}

TEST(ProceduralScene, NothingIsNegative) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const std::string& name : ProceduralScene::names()) {
    const ProceduralScene s = scene(name);
    for (int i = 0; i < 20000; ++i) {
      ASSERT_GE(s.radiance(unit(random), unit(random), 360 + 470 * unit(random), 1, 1), 0) << name;
    }
  }
}

TEST(ProceduralScene, MixedIsTheFourAtHalfTheirSize) {
  const std::array<const char*, 4> names = {"gradients", "edges", "spikes", "decades"};
  const FilmOptions whole = film_of(36, 28);
  const FilmOptions quarter = film_of(18, 14);
  for (std::size_t q = 0; q < 4; ++q) {
    for (const auto& [x, y] : {std::pair{0, 0}, {5, 3}, {9, 9}, {17, 13}}) {
      const auto got =
          scene("mixed").xyz(whole, x + 18 * static_cast<int>(q % 2), y + 14 * static_cast<int>(q / 2));
      const auto want = scene(names[q]).xyz(quarter, x, y);
      for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(got[c], want[c], 1e-11 * want[c] + 1e-13) << names[q];
    }
  }
}

TEST(ProceduralScene, WhereNoWavelengthIsDrawnABandIsWhatWasDrawnOfIt) {
  FilmOptions film = film_of(4, 4);
  film.bands = *Bands::from_list({{340, 345, 350}, {350, 360, 370}, {820, 830, 840}});
  const ProceduralScene s = scene("gradients");
  const auto drawn = s.spectrum(film, 0, 0);
  film.input = FilmInput::kBands;
  const auto whole = s.spectrum(film, 0, 0);
  EXPECT_EQ(drawn[0], 0);
  EXPECT_EQ(whole[0], 0);
  for (const std::size_t b : {1, 2}) {
    EXPECT_GT(drawn[b], 0);
    EXPECT_NEAR(drawn[b], 2 * whole[b], 1e-12 * drawn[b]);
  }
}

TEST(ProceduralScene, SplattedSamplesExistInTheWindowOnly) {
  // A pixel at the window's corner sees what a film of the window alone would.
  const ProceduralScene s = scene("edges");
  FilmOptions film = film_of(32, 32, "gaussian:3:2");
  const auto whole = s.xyz(film, 16, 8);
  film.crop = PixelWindow{16, 8, 24, 30};
  const auto cut = s.xyz(film, 16, 8);
  EXPECT_GT(std::abs(cut[1] - whole[1]), 1e-3 * whole[1]);
  EXPECT_EQ(s.xyz(film, 20, 20), s.xyz(film_of(32, 32, "gaussian:3:2"), 20, 20));
  film.placement = SamplePlacement::kOnePixel;
  const auto one = s.xyz(film, 16, 8);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(one[c], whole[c], 1e-12 * whole[c]);
}

}  // namespace
}  // namespace spectile::test
