// Films at their limits: the ends of ranges, the largest component, moved films, and the smallest windows.
#include <algorithm>

#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

TEST(FilmRange, ContributionsAreExactAtEveryRange) {
  for (const int range : {-32, -1, 0, 32, 96}) {
    Film film = *Film::create(plain_film(4, range));
    // The range itself, its negative and what is just beyond; the least exact one.
    const float most = std::ldexp(1.0F, range);
    BandBatch b(1, 4);
    const float values[] = {most, -most, std::nextafter(most, kInf), std::ldexp(1.9999999F, range - 51)};
    for (std::size_t i = 0; i < 4; ++i) {
      b.put(i, static_cast<float>(i), 0, 1);
      b.radiance(0, i) = values[i];
    }
    ASSERT_TRUE(film.add(b.samples()));
    const auto got = developed(film, FilmLayer::kSpectrum);
    EXPECT_EQ(got[0], most);
    EXPECT_EQ(got[1], -most);
    EXPECT_EQ(got[2], 0);
    EXPECT_EQ(got[3], values[3]);
    EXPECT_EQ(film.stats().rejected.beyond_range, 1U);
  }
}

TEST(FilmRange, WeightsAreExactAtEveryRange) {
  for (const int range : {-16, 0, 16, 32}) {
    FilmOptions o = plain_film(4, 32);
    o.weight_range = range;
    Film film = *Film::create(o);
    const float most = std::ldexp(1.0F, range);
    BandBatch b(1, 3);
    b.put(0, 0, 0, most);
    b.put(1, 1, 0, std::nextafter(most, kInf));
    b.put(2, 2, 0, std::ldexp(1.9999999F, range - 51));
    for (std::size_t i = 0; i < 3; ++i) b.radiance(0, i) = 0x1p-10F;
    ASSERT_TRUE(film.add(b.samples()));
    const auto got = developed(film, FilmLayer::kWeight);
    EXPECT_EQ(got[0], most);
    EXPECT_EQ(got[1], 0);
    EXPECT_EQ(got[2], b.weight[2]);
  }
}

TEST(FilmRange, NoComponentIsAboveTheMaximumByMoreThanRounding) {
  for (const float maximum : {1e-12F, 1e-3F, 0.1F, 1.0F, 3.3F, 1e20F}) {
    for (const float value : {1.5F, 1e3F, 7.77e10F, 3e30F, 3e38F}) {
      for (const auto input : {FilmInput::kBands, FilmInput::kWavelengths}) {
        FilmOptions o = plain_film(4, std::max(-32, std::ilogb(maximum) + 8));
        o.input = input;
        o.xyz = Observer::kCie1931;
        o.bands = *Bands::uniform(500, 600, 50);
        o.maximum_component = maximum;
        Film film = *Film::create(o);
        if (input == FilmInput::kBands) {
          BandBatch b(2, 1);
          b.radiance(0, 0) = value;
          b.radiance(1, 0) = value / 3;
          ASSERT_TRUE(film.add(b.samples()));
        } else {
          FilmSamples s(1);
          for (std::size_t k = 0; k < 4; ++k) {
            s.lambda(k, 0) = 520 + 20 * static_cast<float>(k);
            s.radiance(k, 0) = k == 0 ? value : value / 3;
            s.density(k, 0) = 0.5F;
          }
          ASSERT_TRUE(film.add(s.wavelengths()));
        }
        if (film.stats().accepted == 0) continue;
        for (const FilmLayer layer : {FilmLayer::kXyz, FilmLayer::kSpectrum}) {
          auto d = *FilmDevelopment::create(film, layer);
          ASSERT_TRUE(d.update());
          float most = 0;
          for (std::size_t p = 0; p < d.planes(); ++p) most = std::max(most, d.at(p, 0, 0));
          EXPECT_LE(most, maximum * (1 + 4 * 0x1p-23F)) << maximum << " of " << value;
          // Of wavelengths several share a band.
          const bool alone = layer == FilmLayer::kXyz || input == FilmInput::kBands;
          if (value > 10 * maximum && value > 10 && alone) {
            EXPECT_GE(most, maximum * (1 - 0x1p-20F)) << maximum << " of " << value;
          }
        }
      }
    }
  }
}

TEST(FilmRange, ClampedColoursKeepTheirProportions) {
  FilmOptions o = plain_film(4, 16);
  o.xyz = Observer::kCie1931;
  o.spectral = false;
  o.bands = *Bands::uniform(500, 600, 50);
  Film free = *Film::create(o);
  o.maximum_component = 0.01F;
  Film clamped = *Film::create(o);
  BandBatch b(2, 1);
  b.radiance(0, 0) = 20;
  ASSERT_TRUE(free.add(b.samples()));
  ASSERT_TRUE(clamped.add(b.samples()));
  const auto want = developed(free, FilmLayer::kXyz);
  const auto got = developed(clamped, FilmLayer::kXyz);
  for (const std::size_t c : {0U, 2U}) EXPECT_NEAR(got[16 * c] / got[16], want[16 * c] / want[16], 1e-6);
}

TEST(FilmRange, ADevelopmentStaysWithItsFilmWhereverThatIs) {
  FilmOptions o = small_film();
  Film film = *Film::create(o);
  FilmSamples s(1);
  s.put(0, 5, 5, 1);
  ASSERT_TRUE(film.add(s.wavelengths()));
  auto weight = *FilmDevelopment::create(film, FilmLayer::kWeight);
  ASSERT_TRUE(weight.update());
  EXPECT_EQ(weight.at(0, 5, 5), 1);
  Film other = *Film::create(o);
  s.put(0, 6, 6, 3);
  ASSERT_TRUE(other.add(s.wavelengths()));
  Film moved = std::move(film);
  ASSERT_TRUE(moved.add(s.wavelengths()));
  film = std::move(other);
  ASSERT_TRUE(weight.update());
  EXPECT_EQ(weight.at(0, 5, 5), 1);
  EXPECT_EQ(weight.at(0, 6, 6), 3);
  ASSERT_TRUE(film.add(s.wavelengths()));
  moved = *Film::create(o);
  ASSERT_TRUE(weight.update());
  EXPECT_EQ(weight.at(0, 6, 6), 3);
}

TEST(FilmRange, LongAndSmallFilms) {
  struct Size {
    int width, height;
    PixelWindow crop;
  };
  for (const Size& size :
       {Size{1, 1, {0, 0, 1, 1}}, Size{1, 1 << 18, {0, 0, 1, 1 << 18}}, Size{1 << 18, 1, {15, 0, 1 << 18, 1}},
        Size{100, 100, {15, 16, 17, 18}}, Size{100, 100, {99, 99, 100, 100}}}) {
    FilmOptions o;
    o.width = size.width;
    o.height = size.height;
    o.crop = size.crop;
    Film film = *Film::create(o);
    const PixelWindow& c = size.crop;
    FilmSamples s(8);
    const auto below = [](int v) { return std::nextafter(static_cast<float>(v), -1.0F); };
    s.put(0, static_cast<float>(c.x0), static_cast<float>(c.y0), 1);
    s.put(1, below(c.x1), below(c.y1), 2);
    s.put(2, below(c.x0), static_cast<float>(c.y0), 4);
    s.put(3, static_cast<float>(c.x0), below(c.y0), 8);
    s.put(4, static_cast<float>(c.x1), static_cast<float>(c.y0), 16);
    s.put(5, static_cast<float>(c.x0), static_cast<float>(c.y1), 32);
    s.put(6, 1e9F, static_cast<float>(c.y0), 64);
    s.put(7, static_cast<float>(c.x0), -1e30F, 128);
    ASSERT_TRUE(film.add(s.wavelengths()));
    EXPECT_EQ(film.stats().accepted, 2U);
    EXPECT_EQ(film.stats().rejected.outside, 6U);
    auto weight = *FilmDevelopment::create(film, FilmLayer::kWeight);
    ASSERT_TRUE(weight.update());
    const bool one = c.width() == 1 && c.height() == 1;
    EXPECT_EQ(weight.at(0, c.x0, c.y0), one ? 3 : 1);
    EXPECT_EQ(weight.at(0, c.x1 - 1, c.y1 - 1), one ? 3 : 2);
  }
}

TEST(FilmRange, WeightsThatCancelGiveBlack) {
  FilmOptions o = small_film();
  o.negative_weights = true;
  o.statistics = PixelStatistics::kVariance;
  Film film = *Film::create(o);
  FilmSamples s(4);
  s.put(0, 5, 5, 0.3F);
  s.put(1, 5, 5, -0.3F);
  s.put(2, 6, 5, 0.0F);
  s.put(3, 7, 5, -1.0F);
  s.radiance(0, 1) = 3;
  ASSERT_TRUE(film.add(s.wavelengths()));
  EXPECT_EQ(film.stats().accepted, 4U);
  auto y = *FilmDevelopment::create(film, FilmLayer::kLuminance);
  auto count = *FilmDevelopment::create(film, FilmLayer::kCount);
  auto variance = *FilmDevelopment::create(film, FilmLayer::kVariance);
  ASSERT_TRUE(y.update() && count.update() && variance.update());
  EXPECT_EQ(y.at(0, 5, 5), 0);
  EXPECT_EQ(y.at(0, 6, 5), 0);
  EXPECT_GT(y.at(0, 7, 5), 0);
  EXPECT_EQ(count.at(0, 5, 5), 2);
  EXPECT_EQ(count.at(0, 6, 5), 1);
  EXPECT_EQ(variance.at(0, 7, 5), kInf);
}

TEST(Film, SumsBeyondTheRangeAreAnErrorAndNotWrong) {
  FilmOptions o = small_film();
  o.input = FilmInput::kBands;
  o.spectral = true;
  o.xyz.reset();
  o.bands = *Bands::uniform(400, 700, 300);
  o.range = 0;
  Film film = *Film::create(o);
  BandBatch b(1, 1);
  b.put(0, 5, 5, 1);
  b.radiance(0, 0) = 1;
  ASSERT_TRUE(film.add(b.samples()));
  // Doubling by merging: 2^31 contributions of the range's end fit, twice as many are said to be too many.
  for (int i = 0; i < 31; ++i) {
    Film twin = *Film::create(o);
    ASSERT_TRUE(twin.merge(film));
    ASSERT_TRUE(film.merge(twin)) << i;
  }
  EXPECT_EQ(developed(film, FilmLayer::kSpectrum)[5 * 20 + 5], 1);
  Film twin = *Film::create(o);
  ASSERT_TRUE(twin.merge(film));
  const auto result = film.merge(twin);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kUnavailable);
  EXPECT_FALSE(film.add(b.samples()));
}

}  // namespace
}  // namespace spectile::test
