// Spectra between the nodes of a grid: exact, between 0 and 1, flat where grey, continuous across cells.
#include <gmock/gmock.h>

#include <random>
#include <spectile/upsampling/relight.hpp>

#include "src/upsampling/grid/color_grid.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/sampled_rows.hpp"
#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

Upsampler tetrahedral(Quantity quantity = Quantity::kReflectance, const Bands& bands = Bands(),
                      const UpsamplerOptions& options = {}) {
  return *Upsampler::create(Method::kTetrahedral, quantity, bands, options);
}

void expect_exact(const Upsampler& upsampler, const ColorLanes& rgb, double difference = 1e-4) {
  const RoundTrip result = round_trip(upsampler, rgb);
  EXPECT_LE(result.rgb, 2e-6) << rgb.at(result.worst, 0) << " " << rgb.at(result.worst, 1) << " "
                              << rgb.at(result.worst, 2);
  EXPECT_LE(result.ciede2000, difference);
  EXPECT_GE(result.least, 0);
  EXPECT_TRUE(upsampler.quantity() != Quantity::kReflectance || result.greatest <= 1) << result.greatest;
}

TEST(Tetrahedral, TheCubesColoursReturn) {
  for (const char* bands : {"400:700:5", "380:780:5", "400:700:10"}) {
    SCOPED_TRACE(bands);
    expect_exact(tetrahedral(Quantity::kReflectance, *Bands::parse(bands)), cube_grid(17));
  }
  expect_exact(tetrahedral(), random_colors(20000, 1));
}

TEST(Tetrahedral, EveryQuantityObserverAndLightReturns) {
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
    for (const Observer observer : {Observer::kCie1931, Observer::kCie1964}) {
      UpsamplerOptions options;
      options.observer = observer;
      SCOPED_TRACE(std::string(to_string(quantity)) + std::string(to_string(observer)));
      expect_exact(tetrahedral(quantity, Bands(), options), cube_grid(9));
    }
    for (const char* light : {"A", "E", "FL11"}) {
      UpsamplerOptions options;
      options.light = *illuminant(light);
      SCOPED_TRACE(std::string(to_string(quantity)) + light);
      expect_exact(tetrahedral(quantity, *Bands::parse("380:780:5"), options), cube_grid(9));
    }
  }
}

TEST(Tetrahedral, NodesAreTheSigmoidsOfTheObserver) {
  const Upsampler upsampler = tetrahedral();
  const ColorGrid& grid = UpsamplerAccess::grid(upsampler)->grid;
  ASSERT_EQ(grid.nodes.size(), 125U * 60U);
  std::vector<Rgb> colors;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const auto rgb = node_color(i);
    colors.push_back({static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])});
  }
  const auto rgb = lanes_of(colors);
  const auto ours = spectra_of(upsampler, rgb);
  const auto sigmoids =
      spectra_of(*Upsampler::create(Method::kSigmoidObserver, Quantity::kReflectance, Bands()), rgb);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    for (std::size_t b = 0; b < 60; ++b) ASSERT_NEAR(ours.at(i, b), sigmoids.at(i, b), 3e-6) << i << " " << b;
  }
}

TEST(Tetrahedral, GreysAreFlatBlackIsZeroAndWhiteOne) {
  std::vector<Rgb> colors;
  for (int i = 0; i <= 4096; ++i) {
    const float v = static_cast<float>(i) / 4096;
    colors.push_back({v, v, v});
  }
  const auto rgb = lanes_of(colors);
  const auto spectra = spectra_of(tetrahedral(), rgb);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    for (std::size_t b = 0; b < 60; ++b) {
      ASSERT_TRUE(same_bits(spectra.at(i, b), spectra.at(i, 0))) << i;
      ASSERT_NEAR(spectra.at(i, b), rgb.at(i, 0), 2e-7F * rgb.at(i, 0)) << i;
    }
  }
  EXPECT_EQ(spectra.at(0, 0), 0);
  EXPECT_EQ(spectra.at(4096, 0), 1);
}

TEST(Tetrahedral, AboveOneTheShapeOfTheBrightestStays) {
  const auto upsampler = tetrahedral();
  const auto one = spectra_of(upsampler, lanes_of({{1, 0.5F, 0.25F}, {0.125F, 1, 0}}));
  const auto bright = spectra_of(upsampler, lanes_of({{8, 4, 2}, {1, 8, 0}}));
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t b = 0; b < 60; ++b) ASSERT_EQ(bright.at(i, b), 8 * one.at(i, b));
  }
  EXPECT_LE(round_trip(upsampler, lanes_of({{5, 0.1F, 0.3F}, {1.5F, 1.5F, 0}, {1000, 1, 3}}), false).rgb,
            1e-3);
}

TEST(Tetrahedral, WhatMayExceedOneIsHomogeneous) {
  for (const Quantity quantity : {Quantity::kUnbounded, Quantity::kIlluminant}) {
    const auto upsampler = tetrahedral(quantity);
    const auto rgb = random_colors(1000, 2);
    const auto spectra = spectra_of(upsampler, rgb);
    for (const float factor : {2.0F, 0x1p-30F, 0x1p60F}) {
      auto scaled = random_colors(1000, 2);
      for (std::size_t i = 0; i < 3 * scaled.lanes(); ++i) scaled.at(i / 3, i % 3) *= factor;
      const auto got = spectra_of(upsampler, scaled);
      for (std::size_t i = 0; i < rgb.lanes(); ++i) {
        for (std::size_t b = 0; b < 60; ++b)
          ASSERT_EQ(got.at(i, b), factor * spectra.at(i, b)) << i << " " << b;
      }
    }
  }
}

TEST(Tetrahedral, SpectraAreContinuousAcrossTheFacesOfCells) {
  const auto upsampler = tetrahedral();
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Rgb> below;
  std::vector<Rgb> above;
  const auto levels = node_levels();
  for (int i = 0; i < 3000; ++i) {
    Rgb rgb = {unit(random), unit(random), unit(random)};
    const std::size_t k = random() % 3;
    // On a face between cells, or on a diagonal between tetrahedra.
    rgb[k] = i % 2 == 0 ? levels[1 + random() % 3] : rgb[(k + 1) % 3];
    Rgb less = rgb;
    less[k] -= 1e-6F;
    Rgb more = rgb;
    more[k] += 1e-6F;
    below.push_back(less);
    above.push_back(more);
  }
  const auto a = spectra_of(upsampler, lanes_of(below));
  const auto b = spectra_of(upsampler, lanes_of(above));
  for (std::size_t i = 0; i < below.size(); ++i) {
    for (std::size_t band = 0; band < 60; ++band) ASSERT_NEAR(a.at(i, band), b.at(i, band), 3e-5) << i;
  }
}

TEST(Tetrahedral, NegativeComponentsGoOnLinearlyAndAreLimitedToZero) {
  UpsamplerOptions keep;
  keep.negative = NegativeSamples::kKeep;
  const auto kept = tetrahedral(Quantity::kReflectance, Bands(), keep);
  EXPECT_LE(round_trip(kept, lanes_of({{-0.1F, 0.4F, 0.3F}, {0.2F, -0.05F, 0.9F}}), false).rgb, 2e-6);
  const auto limited = spectra_of(tetrahedral(), lanes_of({{-0.5F, -0.2F, -0.1F}}));
  for (std::size_t b = 0; b < 60; ++b) ASSERT_EQ(limited.at(0, b), 0);
}

TEST(Tetrahedral, WhatIsNotFiniteIsNanInEveryBand) {
  const auto spectra = spectra_of(
      tetrahedral(), lanes_of({{kNan, 0.5F, 0.5F}, {0.1F, kNan, 0}, {0, 0.3F, kNan}, {kInf, 0, 0}}));
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t b = 0; b < 60; ++b) ASSERT_TRUE(std::isnan(spectra.at(i, b))) << i;
  }
}

TEST(Tetrahedral, WhatMayOverflowLiesBeyondTheLimits) {
  UpsamplerOptions keep;
  keep.negative = NegativeSamples::kKeep;
  const auto upsampler = tetrahedral(Quantity::kReflectance, Bands(), keep);
  const auto rows = *rows::SampledRows::over(upsampler, upsampler.bands());
  const float most = rows.limits()[0];
  EXPECT_EQ(rows.limits()[3], 1);
  for (int signs = 0; signs < 27; ++signs) {
    const Rgb rgb = {most * static_cast<float>(signs % 3 - 1), most * static_cast<float>(signs / 3 % 3 - 1),
                     most * static_cast<float>(signs / 9 - 1)};
    const auto spectra = spectra_of(upsampler, lanes_of({rgb}));
    for (std::size_t b = 0; b < 60; ++b) {
      ASSERT_TRUE(std::isfinite(spectra.at(0, b))) << signs;
      ASSERT_LE(std::abs(spectra.at(0, b)), rows.bound({most, most, most, 1})) << signs;
    }
  }
  // Not far within either.
  const auto beyond =
      spectra_of(upsampler, lanes_of({{2 * most, -2 * most, -2 * most}, {-2 * most, 2 * most, 2 * most}}));
  float largest = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t b = 0; b < 60; ++b) {
      const float v = std::abs(beyond.at(i, b));
      largest = std::isnan(v) ? kInf : std::max(largest, v);
    }
  }
  EXPECT_GT(largest, 0.5F * rows.bound({most, most, most, 1}));
}

TEST(Tetrahedral, PrimariesWhoseCornersNoReflectanceHasAreAnError) {
  UpsamplerOptions options;
  options.primaries = rgb_space("acescg")->chromaticities;
  const auto made = Upsampler::create(Method::kTetrahedral, Quantity::kReflectance, Bands(), options);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kBadArgument);
  EXPECT_THAT(made.error().message, testing::HasSubstr("sigmoid-observer"));
}

}  // namespace
}  // namespace spectile::test
