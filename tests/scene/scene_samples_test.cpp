// Samples of procedural scenes: their averages are the closed forms, and the same ones in any run.
#include <map>

#include "tests/scene/scene_support.hpp"

namespace spectile::test {
namespace {

/// XYZ of each sample.
ColorLanes projected(const WavelengthSamples& samples) {
  const std::size_t n = samples.x.size();
  auto wavelengths = *SampledWavelengths::create(n, samples.radiance.count);
  auto radiance = own_batch(n, samples.radiance.count);
  for (std::size_t k = 0; k < samples.radiance.count; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      radiance.at(i, k) = of_row(samples.radiance, k, i);
      wavelengths.lambda_nm.at(i, k) = of_row(samples.lambda_nm, k, i);
      wavelengths.density.at(i, k) = of_row(samples.density, k, i);
    }
  }
  auto xyz = *ColorLanes::create(n);
  EXPECT_TRUE(project(*ResponseCurves::of_observer(), radiance.view(), wavelengths, xyz.span()));
  return xyz;
}

/// Weighted sums of a pixel's samples.
struct Sums {
  double weight = 0, squared_weight = 0;
  std::array<double, 3> color{}, squares{}, cross{};
  void add(double w, const ColorLanes& xyz, std::size_t i) {
    weight += w;
    squared_weight += w * w;
    for (std::size_t c = 0; c < 3; ++c) {
      const double v = xyz.at(i, c);
      color[c] += w * v;
      squares[c] += w * v * w * v;
      cross[c] += w * w * v;
    }
  }
  double mean(std::size_t c) const { return color[c] / weight; }
  /// Of a ratio of sums: the root of the sum of squared w (v - mean), over the sum of the weights.
  double standard_error(std::size_t c) const {
    const double m = mean(c);
    return std::sqrt(std::max(0.0, squares[c] - 2 * m * cross[c] + m * m * squared_weight)) /
           std::abs(weight);
  }
};

TEST(SceneSamples, AverageToTheExactValues) {
  // 5 standard errors: the seeds are fixed, and one of a million normal numbers is further out; rare bright
  // slivers of "edges" are why there must be many samples.
  SceneSampling sampling;
  sampling.samples_per_pixel = 8000;
  for (const std::string& name : ProceduralScene::names()) {
    const ProceduralScene s = scene(name);
    for (const char* filter : {"box", "gaussian:1.5:0.5", "mitchell:2"}) {
      for (const auto placement : {SamplePlacement::kSplat, SamplePlacement::kOnePixel}) {
        FilmOptions film = film_of(7, 5, filter, placement);
        film.crop = PixelWindow{1, 1, 7, 4};
        sampling.density = placement == SamplePlacement::kSplat ? WavelengthSampling::kVisible
                                                                : WavelengthSampling::kUniform;
        const SceneBatch batch = drawn(s, film, sampling, 0, pixels_of(film));
        const WavelengthSamples samples = batch.wavelength_samples();
        ASSERT_EQ(samples.x.size(), 18 * 8000);
        const ColorLanes xyz = projected(samples);
        std::map<std::pair<int, int>, Sums> pixels;
        for (std::size_t i = 0; i < samples.x.size(); ++i) {
          const int x = static_cast<int>(samples.x[i]);
          const int y = static_cast<int>(samples.y[i]);
          if (placement == SamplePlacement::kOnePixel) {
            pixels[{x, y}].add(samples.weight.empty() ? 1 : samples.weight[i], xyz, i);
            continue;
          }
          ASSERT_TRUE(samples.weight.empty());
          for (int py = std::max(1, y - 2); py < std::min(4, y + 3); ++py) {
            for (int px = std::max(1, x - 2); px < std::min(7, x + 3); ++px) {
              const double w = film.filter(px + 0.5 - samples.x[i], py + 0.5 - samples.y[i]);
              if (w != 0) pixels[{px, py}].add(w, xyz, i);
            }
          }
        }
        ASSERT_EQ(pixels.size(), 18);
        for (const auto& [at, sums] : pixels) {
          const auto want = s.xyz(film, at.first, at.second);
          for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(sums.mean(c), want[c], 5 * sums.standard_error(c) + 1e-6 * want[c])
                << name << " " << filter << " pixel " << at.first << ", " << at.second << " component " << c
                << (placement == SamplePlacement::kSplat ? " splatted" : " in one pixel");
          }
        }
      }
    }
  }
}

TEST(SceneSamples, OfBandsAverageToTheExactSpectrum) {
  SceneSampling sampling;
  sampling.samples_per_pixel = 3000;
  for (const std::string& name : ProceduralScene::names()) {
    FilmOptions film = film_of(4, 3);
    film.input = FilmInput::kBands;
    film.bands = *Bands::parse("380:780:10");
    const SceneBatch batch = drawn(scene(name), film, sampling, 0, 12);
    const BandSamples samples = batch.band_samples();
    ASSERT_EQ(samples.radiance.count, 40);
    EXPECT_TRUE(batch.wavelength_samples().x.empty());
    for (int pixel = 0; pixel < 12; ++pixel) {
      const auto want = scene(name).spectrum(film, pixel % 4, pixel / 4);
      for (std::size_t b = 0; b < 40; ++b) {
        double sum = 0;
        double squares = 0;
        for (std::size_t i = 0; i < 3000; ++i) {
          const double v = of_row(samples.radiance, b, static_cast<std::size_t>(pixel) * 3000 + i);
          sum += v;
          squares += v * v;
        }
        const double mean = sum / 3000;
        const double error = std::sqrt(std::max(0.0, squares / 3000 - mean * mean) / 3000);
        ASSERT_NEAR(mean, want[b], 5 * error + 1e-6 * want[b]) << name << " pixel " << pixel << " band " << b;
      }
    }
  }
}

/// Everything that is known of a sample, so that batches can be compared.
using Sample = std::vector<float>;
std::vector<Sample> list_of(const SceneBatch& batch) {
  const WavelengthSamples s = batch.wavelength_samples();
  std::vector<Sample> out(s.x.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = {s.x[i], s.y[i], s.weight.empty() ? 1 : s.weight[i]};
    for (std::size_t k = 0; k < s.radiance.count; ++k) {
      for (const RowsView* rows : {&s.radiance, &s.lambda_nm, &s.density})
        out[i].push_back(of_row(*rows, k, i));
    }
  }
  return out;
}

TEST(SceneSamples, ShardsTogetherAreTheWhole) {
  for (const auto placement : {SamplePlacement::kSplat, SamplePlacement::kOnePixel}) {
    const FilmOptions film = film_of(35, 20, "mitchell", placement);
    SceneSampling sampling;
    sampling.samples_per_pixel = 7;
    auto whole = list_of(drawn(scene("mixed"), film, sampling, 0, pixels_of(film)));
    std::vector<Sample> together;
    sampling.shards = 3;
    for (sampling.shard = 0; sampling.shard < 3; ++sampling.shard) {
      const auto part = list_of(drawn(scene("mixed"), film, sampling, 0, pixels_of(film)));
      EXPECT_EQ(part.size(), pixels_of(film) * (sampling.shard == 0 ? 3 : 2));
      together.insert(together.end(), part.begin(), part.end());
    }
    std::ranges::sort(whole);
    std::ranges::sort(together);
    EXPECT_EQ(whole, together);
    // More shards than samples: the last ones have none.
    sampling.shards = 9;
    sampling.shard = 8;
    EXPECT_EQ(drawn(scene("mixed"), film, sampling, 0, 5).size(), 0);
  }
}

TEST(SceneSamples, APixelGetsItsOwnWhateverTheRun) {
  FilmOptions film = film_of(40, 37, "gaussian", SamplePlacement::kOnePixel);
  SceneSampling sampling;
  sampling.samples_per_pixel = 5;
  const auto whole = list_of(drawn(scene("edges"), film, sampling, 0, pixels_of(film)));
  std::vector<Sample> pieces;
  for (std::uint64_t first = 0; first < pixels_of(film); first += 97) {
    const auto piece = list_of(
        drawn(scene("edges"), film, sampling, first, std::min<std::uint64_t>(97, pixels_of(film) - first)));
    pieces.insert(pieces.end(), piece.begin(), piece.end());
  }
  EXPECT_EQ(pieces, whole);
  // In a window, and with more samples, of which the first are the same.
  std::map<std::pair<float, float>, std::vector<Sample>> by_pixel;
  for (const Sample& s : whole) by_pixel[{s[0], s[1]}].push_back(s);
  film.crop = PixelWindow{13, 5, 33, 36};
  sampling.samples_per_pixel = 8;
  const auto window = list_of(drawn(scene("edges"), film, sampling, 0, pixels_of(film)));
  for (std::size_t i = 0; i < window.size(); ++i) {
    const std::size_t number = i % 8;
    if (number >= 5) continue;
    ASSERT_EQ(window[i], (by_pixel.at({window[i][0], window[i][1]})[number])) << i;
  }
  // Another seed gives others.
  sampling.seed = 2;
  EXPECT_NE(list_of(drawn(scene("edges"), film, sampling, 0, pixels_of(film))), window);
}

TEST(SceneSamples, PixelsComeTileByTile) {
  FilmOptions film = film_of(70, 50);
  film.crop = PixelWindow{5, 30, 40, 50};
  SceneSampling sampling;
  sampling.samples_per_pixel = 1;
  std::vector<std::pair<int, int>> want;
  for (const auto& [y0, y1] : {std::pair{30, 32}, {32, 48}, {48, 50}}) {
    for (const auto& [x0, x1] : {std::pair{5, 16}, {16, 32}, {32, 40}}) {
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) want.emplace_back(x, y);
      }
    }
  }
  for (const std::uint64_t first : {0, 1, 21, 22, 69, 70, 71, 500, 699}) {
    const SceneBatch batch = drawn(scene("spikes"), film, sampling, first, pixels_of(film) - first);
    const WavelengthSamples s = batch.wavelength_samples();
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      const std::pair at{static_cast<int>(s.x[i]), static_cast<int>(s.y[i])};
      ASSERT_EQ(at, want[first + i]) << first << " + " << i;
    }
  }
}

TEST(SceneSamples, StayInTheirPixelWhereFloatsAreCoarse) {
  FilmOptions film = film_of(1 << 18, 1 << 12);
  film.crop = PixelWindow{(1 << 18) - 4, 4090, 1 << 18, 4096};
  SceneSampling sampling;
  sampling.samples_per_pixel = 2000;
  const SceneBatch batch = drawn(scene("gradients"), film, sampling, 0, 24);
  const WavelengthSamples s = batch.wavelength_samples();
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const std::size_t pixel = i / 2000;
    ASSERT_EQ(std::floor(s.x[i]), film.crop->x0 + static_cast<int>(pixel % 4));
    ASSERT_EQ(std::floor(s.y[i]), 4090 + static_cast<int>(pixel / 4));
  }
}

TEST(SceneSamples, AreTheRadianceAtTheirPlaces) {
  const FilmOptions film = film_of(16, 16);
  for (const std::string& name : ProceduralScene::names()) {
    SceneSampling sampling;
    sampling.wavelengths = 3;
    const SceneBatch batch = drawn(scene(name), film, sampling, 0, 256);
    const WavelengthSamples s = batch.wavelength_samples();
    const ProceduralScene from = scene(name);
    int off = 0;
    int black = 0;
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      double any = 0;
      for (int nm = 400; nm < 700; nm += 10) any += from.radiance(s.x[i], s.y[i], nm, 16, 16);
      black += any == 0 ? 1 : 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double want = from.radiance(s.x[i], s.y[i], of_row(s.lambda_nm, k, i), 16, 16);
        const double most = from.radiance(s.x[i], s.y[i], std::floor(of_row(s.lambda_nm, k, i)), 16, 16);
        const double got = of_row(s.radiance, k, i);
        off += std::abs(got - want) > 1e-5 * std::max(want, most) + 1e-7 ? 1 : 0;
      }
    }
    // But for a place that rounding has moved over an edge.
    EXPECT_LE(off, 3) << name;
    EXPECT_EQ(black > 300, name == "edges" || name == "decades" || name == "mixed") << name;
  }
}

TEST(SceneSamples, WhatDoesNotFitIsAnError) {
  FilmOptions film = film_of(20, 10);
  SceneSampling sampling;
  auto batch = *SceneBatch::create(100, 4, true);
  const auto fails = [&](std::uint64_t first, std::uint64_t count, ErrorCode wanted, const char* part) {
    const auto result = scene("edges").draw(film, sampling, first, count, batch);
    EXPECT_EQ(code_of(result), code(wanted)) << part;
    const std::string message = result ? "" : result.error().message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  fails(0, 7, ErrorCode::kSizeMismatch, "7 pixels of 16 samples do not fit into a batch of 100");
  EXPECT_TRUE(scene("edges").draw(film, sampling, 0, 6, batch));
  EXPECT_EQ(batch.size(), 96);
  fails(198, 3, ErrorCode::kBadArgument, "3 pixels from number 198 on are beyond the window's 200");
  fails(201, 0, ErrorCode::kBadArgument, "201");
  sampling.wavelengths = 5;
  fails(0, 1, ErrorCode::kSizeMismatch, "4 wavelengths, the film is fed with 5 wavelengths");
  sampling.wavelengths = 4;
  sampling.shards = 4;
  sampling.shard = 4;
  fails(0, 1, ErrorCode::kBadArgument, "no shard 4 of 4");
  sampling = {};
  film.input = FilmInput::kBands;
  fails(0, 1, ErrorCode::kSizeMismatch, "60 bands");
  film = film_of(20, 10);
  film.crop = PixelWindow{5, 5, 21, 8};
  fails(0, 1, ErrorCode::kBadArgument, "(5, 5) to (21, 8) are no window of a film of 20 x 10");
  EXPECT_EQ(code_of(SceneBatch::create(std::size_t{1} << 60, 4, true)), code(ErrorCode::kOutOfMemory));
}

}  // namespace
}  // namespace spectile::test
