// Film: what reaches a pixel, and what its layers develop to.
#include <gtest/gtest.h>

#include <random>
#include <spectile/spectile.hpp>
#include <thread>

#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

TEST(Film, ASampleReachesThePixelThatItLiesIn) {
  Film film = *Film::create(small_film());
  FilmSamples s(4);
  s.put(0, 0.0F, 0.0F, 1.0F);
  s.put(1, 16.999F, 0.5F, 1.0F);
  s.put(2, 17.0F, 19.999F, 2.0F);
  s.put(3, 20.0F, 3.0F, 1.0F);  // the film ends there
  ASSERT_TRUE(film.add(s.wavelengths()));
  auto weight = *FilmDevelopment::create(film, FilmLayer::kWeight);
  ASSERT_TRUE(weight.update());
  EXPECT_EQ(weight.at(0, 0, 0), 1);
  EXPECT_EQ(weight.at(0, 16, 0), 1);
  EXPECT_EQ(weight.at(0, 17, 19), 2);
  EXPECT_EQ(weight.at(0, 18, 19), 0);
  EXPECT_EQ(film.stats().accepted, 3U);
  EXPECT_EQ(film.stats().rejected.outside, 1U);
}

TEST(Film, ConstantRadianceUnderUniformWavelengthsIsItsColour) {
  // Equal energy at four wavelengths a quarter of the range apart: XYZ by hand.
  Film film = *Film::create(small_film());
  FilmSamples s(1);
  s.put(0, 3.5F, 4.5F, 1.0F);
  ASSERT_TRUE(film.add(s.wavelengths()));
  auto xyz = *FilmDevelopment::create(film, FilmLayer::kXyz);
  ASSERT_TRUE(xyz.update());
  const Sensor observer = *Sensor::named("cie1931");
  for (std::size_t c = 0; c < 3; ++c) {
    double want = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      want += observer.factors()[c] * observer.curves()[c](static_cast<double>(s.lambda(k, 0))) *
              static_cast<double>(s.radiance(k, 0)) / static_cast<double>(s.density(k, 0)) / 4;
    }
    EXPECT_NEAR(xyz.at(c, 3, 4), want, 12 * 0x1p-24 * want);
  }
}

TEST(Film, TerminatedWavelengthsAddNothingWhateverTheyHold) {
  Film a = *Film::create(small_film());
  Film b = *Film::create(small_film());
  FilmSamples s(1);
  s.put(0, 5, 5, 1);
  for (std::size_t k = 1; k < 4; ++k) {
    s.density(k, 0) = 0;
    s.radiance(k, 0) = 0;
  }
  ASSERT_TRUE(a.add(s.wavelengths()));
  s.radiance(1, 0) = kNan;
  s.lambda(2, 0) = kInf;
  s.radiance(3, 0) = kInf;
  ASSERT_TRUE(b.add(s.wavelengths()));
  EXPECT_EQ(b.stats().accepted, 1U);
  EXPECT_TRUE(a.same_contents(b));
}

TEST(Film, CropsKeepWhatLiesInThem) {
  FilmOptions o = small_film();
  o.crop = PixelWindow{3, 5, 18, 17};
  Film film = *Film::create(o);
  FilmSamples s(400);
  for (std::size_t i = 0; i < 400; ++i)
    s.put(i, static_cast<float>(i % 20) + 0.5F, static_cast<float>(i / 20) + 0.5F, 1);
  ASSERT_TRUE(film.add(s.wavelengths()));
  EXPECT_EQ(film.stats().accepted, 15U * 12U);
  EXPECT_EQ(film.stats().rejected.outside, 400U - 15U * 12U);
  auto weight = *FilmDevelopment::create(film, FilmLayer::kWeight);
  ASSERT_TRUE(weight.update());
  for (int y = 5; y < 17; ++y) {
    for (int x = 3; x < 18; ++x) ASSERT_EQ(weight.at(0, x, y), 1) << x << " " << y;
  }
}

TEST(Film, ColoursAboveTheMaximumAreScaledDownToIt) {
  FilmOptions o = small_film();
  o.maximum_component = 2;
  Film film = *Film::create(o);
  FilmSamples s(1);
  s.put(0, 5, 5, 0.5F);
  for (std::size_t k = 0; k < 4; ++k) s.radiance(k, 0) = 500;
  ASSERT_TRUE(film.add(s.wavelengths()));
  const auto xyz = developed(film, FilmLayer::kXyz);
  const float most = *std::max_element(xyz.begin(), xyz.end());
  EXPECT_NEAR(most, 2, 1e-6);
}

TEST(Film, BandsDevelopToTheirMeans) {
  FilmOptions o = small_film();
  o.input = FilmInput::kBands;
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 50);
  Film film = *Film::create(o);
  BandBatch b(6, 2);
  b.put(0, 5, 5, 1);
  b.put(1, 5, 5, 3);
  for (std::size_t k = 0; k < 6; ++k) {
    b.radiance(k, 0) = static_cast<float>(k);
    b.radiance(k, 1) = 10;
  }
  ASSERT_TRUE(film.add(b.samples()));
  auto spectrum = *FilmDevelopment::create(film, FilmLayer::kSpectrum);
  ASSERT_TRUE(spectrum.update());
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(spectrum.at(k, 5, 5), (static_cast<float>(k) + 30) / 4);
}

TEST(Film, BucketsHoldTheMeanOfWhatFellIntoThem) {
  FilmOptions o = small_film();
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 100);
  Film film = *Film::create(o);
  FilmSamples s(1);
  s.put(0, 5, 5, 2);
  const float lambda[] = {410, 450, 699, 700};  // the last one is beyond
  for (std::size_t k = 0; k < 4; ++k) {
    s.lambda(k, 0) = lambda[k];
    s.radiance(k, 0) = static_cast<float>(k + 1);
    s.density(k, 0) = k == 0 ? 0.001F : 0.002F;
  }
  ASSERT_TRUE(film.add(s.wavelengths()));
  auto spectrum = *FilmDevelopment::create(film, FilmLayer::kSpectrum);
  ASSERT_TRUE(spectrum.update());
  EXPECT_NEAR(spectrum.at(0, 5, 5), (2 * 1.0 + 1 * 2.0) / 3, 1e-6);
  EXPECT_EQ(spectrum.at(1, 5, 5), 0);
  EXPECT_EQ(spectrum.at(2, 5, 5), 3);
}

TEST(Film, VarianceIsThatOfTheMean) {
  FilmOptions o = small_film();
  o.input = FilmInput::kBands;
  o.bands = *Bands::uniform(360, 830, 470);
  o.statistics = PixelStatistics::kVariance;
  Film film = *Film::create(o);
  constexpr std::size_t kN = 1000;
  BandBatch b(1, kN);
  std::mt19937 random(3);
  std::normal_distribution<float> normal(5, 0.5F);
  for (std::size_t i = 0; i < kN; ++i) {
    b.put(i, 5, 5, 1);
    b.radiance(0, i) = normal(random);
  }
  double mean = 0;
  double squares = 0;
  for (std::size_t i = 0; i < kN; ++i) mean += static_cast<double>(b.radiance(0, i)) / kN;
  for (std::size_t i = 0; i < kN; ++i) squares += std::pow(static_cast<double>(b.radiance(0, i)) - mean, 2);
  ASSERT_TRUE(film.add(b.samples()));
  auto variance = *FilmDevelopment::create(film, FilmLayer::kVariance);
  ASSERT_TRUE(variance.update());
  EXPECT_NEAR(variance.at(0, 5, 5) / (squares / (kN - 1) / kN), 1, 1e-5);
  auto count = *FilmDevelopment::create(film, FilmLayer::kCount);
  ASSERT_TRUE(count.update());
  EXPECT_EQ(count.at(0, 5, 5), kN);
}

TEST(Film, DevelopingAgainTouchesOnlyWhatChanged) {
  FilmOptions o = small_film();
  o.width = 64;
  o.height = 32;
  Film film = *Film::create(o);
  FilmSamples s(2);
  s.put(0, 1, 1, 1);
  s.put(1, 40, 20, 1);
  ASSERT_TRUE(film.add(s.wavelengths()));
  EXPECT_EQ(film.stats().tiles, 8U);
  EXPECT_EQ(film.stats().touched_tiles, 2U);
  auto xyz = *FilmDevelopment::create(film, FilmLayer::kLuminance);
  DevelopStats d = *xyz.update();
  EXPECT_EQ(d.developed, 2U);
  EXPECT_EQ(d.untouched, 6U);
  d = *xyz.update();
  EXPECT_EQ(d.developed, 0U);
  EXPECT_EQ(d.unchanged, 2U);
  s.x[0] = 2;
  FilmSamples one(1);
  one.put(0, 2, 2, 1);
  ASSERT_TRUE(film.add(one.wavelengths()));
  d = *xyz.update();
  EXPECT_EQ(d.developed, 1U);
  EXPECT_EQ(d.unchanged, 1U);
  EXPECT_GT(xyz.at(0, 2, 2), 0);
}

TEST(Film, BadOptionsAndBatchesAreErrors) {
  const auto refused = [](auto change) {
    FilmOptions o = small_film();
    change(o);
    return !Film::create(o);
  };
  EXPECT_TRUE(refused([](FilmOptions& o) { o.width = 0; }));
  EXPECT_TRUE(refused([](FilmOptions& o) { o.width = 1 << 19; }));
  EXPECT_TRUE(refused([](FilmOptions& o) { o.width = o.height = 1 << 18; }));
  EXPECT_TRUE(refused([](FilmOptions& o) { o.crop = PixelWindow{5, 5, 5, 9}; }));
  EXPECT_TRUE(refused([](FilmOptions& o) { o.crop = PixelWindow{5, 5, 25, 9}; }));
  EXPECT_TRUE(refused([](FilmOptions& o) { o.xyz.reset(); }));
  EXPECT_TRUE(refused([](FilmOptions& o) { o.range = 200; }));
  EXPECT_TRUE(refused([](FilmOptions& o) { o.maximum_component = 0; }));
  EXPECT_TRUE(refused([](FilmOptions& o) { o.maximum_component = kNan; }));
  Film film = *Film::create(small_film());
  FilmSamples s(8);
  WavelengthSamples batch = s.wavelengths();
  batch.y = batch.y.first(7);
  EXPECT_EQ(film.add(batch).error().code, ErrorCode::kSizeMismatch);
  batch = s.wavelengths();
  batch.density.count = 3;
  EXPECT_EQ(film.add(batch).error().code, ErrorCode::kSizeMismatch);
  BandBatch bands(60, 3);
  EXPECT_EQ(film.add(bands.samples()).error().code, ErrorCode::kBadArgument);
  EXPECT_FALSE(FilmDevelopment::create(film, FilmLayer::kVariance));
  EXPECT_FALSE(FilmDevelopment::create(film, FilmLayer::kSpectrum));
  EXPECT_FALSE(FilmDevelopment::create(film, FilmLayer::kSensor));
}

}  // namespace
}  // namespace spectile::test
