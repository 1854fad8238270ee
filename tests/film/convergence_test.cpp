// The film's error falls as one over the root of the samples, and faster from a better start where
// wavelengths are drawn as the eye sees.
#include <cmath>

#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

constexpr int kWidth = 32;
constexpr int kHeight = 24;
constexpr std::uint64_t kPixels = std::uint64_t{kWidth} * kHeight;
constexpr std::uint64_t kMaxSamples = 256;
constexpr std::size_t kWavelengths = 4;

/// Mean squares over all pixels of the luminance's error, for 1, 2, 4, ... kMaxSamples samples a pixel.
std::vector<double> square_errors(const char* name, WavelengthSampling density) {
  const auto scene = *ProceduralScene::named(name);
  FilmOptions options;
  options.width = kWidth;
  options.height = kHeight;
  auto film = *Film::create(options);
  auto batch = *SceneBatch::create(kPixels * kMaxSamples / 2, kWavelengths, true);
  SceneSampling sampling;
  sampling.wavelengths = kWavelengths;
  sampling.density = density;
  std::vector<double> out;
  std::uint64_t before = 0;
  for (std::uint64_t now = 1; now <= kMaxSamples; now *= 2) {
    // Samples of a seed of their own double what is there.
    sampling.samples_per_pixel = now - before;
    sampling.seed = now;
    before = now;
    EXPECT_TRUE(scene.draw(options, sampling, 0, kPixels, batch));
    EXPECT_TRUE(film.add(batch.wavelength_samples()));
    auto luminance = *FilmDevelopment::create(film, FilmLayer::kLuminance);
    EXPECT_TRUE(luminance.update());
    double sum = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double d = luminance.at(0, x, y) - scene.xyz(options, x, y)[1];
        sum += d * d;
      }
    }
    out.push_back(sum / kPixels);
  }
  return out;
}

/// Of the logarithm of the errors over that of the samples, by least squares.
double slope(const std::vector<double>& squares) {
  double xy = 0;
  double xx = 0;
  const double middle = static_cast<double>(squares.size() - 1) / 2;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double x = static_cast<double>(i) - middle;
    xy += x * std::log2(squares[i]) / 2;
    xx += x * x;
  }
  return xy / xx;
}

// Chance alone leaves 0.02 or so with 768 pixels; a bias, or samples that repeat, would leave far more.
constexpr double kTolerance = 0.08;

TEST(FilmConvergence, ErrorFallsAsOneOverTheRootOfTheSamples) {
  for (const char* const scene : {"gradients", "edges", "spikes"}) {
    for (const auto density : {WavelengthSampling::kUniform, WavelengthSampling::kVisible}) {
      EXPECT_NEAR(slope(square_errors(scene, density)), -0.5, kTolerance)
          << scene << (density == WavelengthSampling::kUniform ? ", uniform" : ", visible");
    }
  }
}

TEST(FilmConvergence, DrawingAsTheEyeSeesLeavesLessNoiseInLuminance) {
  const auto uniform = square_errors("gradients", WavelengthSampling::kUniform);
  const auto visible = square_errors("gradients", WavelengthSampling::kVisible);
  for (std::size_t i = 0; i < uniform.size(); ++i)
    EXPECT_LT(visible[i], uniform[i]) << (1U << i) << " samples";
}

}  // namespace
}  // namespace spectile::test
