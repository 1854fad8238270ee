// Equal sums are equal films: whatever was carried over when, and however films were put together.
#include <algorithm>
#include <numeric>

#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

/// n samples at one pixel whose rests are as large as can be.
BandBatch with_large_rests(std::size_t n) {
  BandBatch b(1, n);
  std::mt19937 random(17);
  std::uniform_real_distribution<float> unit(0.3F, 0.49F);
  for (std::size_t i = 0; i < n; ++i) {
    b.put(i, 3, 3, 1);
    b.radiance(0, i) = (1 + unit(random)) * 0x1p-31F;
  }
  return b;
}

void add_in_batches(Film& film, const BandBatch& b, std::size_t batch) {
  const BandSamples all = b.samples();
  for (std::size_t at = 0; at < all.x.size(); at += batch) {
    const std::size_t n = std::min(batch, all.x.size() - at);
    ASSERT_TRUE(film.add(BandSamples{all.x.subspan(at, n),
                                     all.y.subspan(at, n),
                                     all.weight.subspan(at, n),
                                     {all.radiance.data + at, all.radiance.count, all.radiance.stride}}));
  }
}

TEST(FilmMerge, BatchesThatEndWhereRestsAreCarriedOver) {
  constexpr std::size_t kCarriedAfter = std::size_t{1} << 18;
  for (const std::size_t more : {1U, 64U, 1000U, 1024U, 5000U}) {
    const BandBatch b = with_large_rests(kCarriedAfter + more);
    Film one = *Film::create(plain_film(8, 0));
    Film other = *Film::create(plain_film(8, 0));
    add_in_batches(one, b, kCarriedAfter + more);
    add_in_batches(other, b, 100000);
    EXPECT_TRUE(one.same_contents(other)) << more;
  }
}

TEST(FilmMerge, AFilmIsWhatItsMergedPartsAreAtTheCarry) {
  constexpr std::size_t kN = (std::size_t{1} << 18) + 1024;
  const BandBatch b = with_large_rests(kN);
  Film one = *Film::create(plain_film(8, 0));
  add_in_batches(one, b, kN);
  Film empty = *Film::create(plain_film(8, 0));
  ASSERT_TRUE(empty.merge(one));
  EXPECT_TRUE(one.same_contents(empty));
}

/// Sums that cancel in the coarse limbs, and are all rest.
Film cancelling() {
  constexpr std::size_t kTriples = 3000;
  constexpr std::size_t kN = 3 * kTriples + 1;
  BandBatch b(1, kN);
  for (std::size_t i = 0; i < kN; ++i) {
    b.put(i, 3, 3, 1);
    b.radiance(0, i) = i % 3 == 0 ? 1.4F * 0x1p-31F : -0.7F * 0x1p-31F;
  }
  b.radiance(0, kN - 1) = 3 * 0x1p-75F;
  Film film = *Film::create(plain_film(8, 0));
  EXPECT_TRUE(film.add(b.samples()));
  return film;
}

TEST(FilmMerge, DevelopedBitsDoNotDependOnWhatWasCarriedOver) {
  const Film film = cancelling();
  const auto before = developed(film, FilmLayer::kSpectrum);
  Film copy = *Film::create(plain_film(8, 0));
  ASSERT_TRUE(copy.merge(film));  // carries over on the way
  const auto after = developed(copy, FilmLayer::kSpectrum);
  EXPECT_EQ(after[3 * 8 + 3], static_cast<float>(3 * 0x1p-75 / 9001));
  EXPECT_EQ(before, after);
}

FilmOptions full_film() {
  FilmOptions o = small_film();
  o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 50);
  o.statistics = PixelStatistics::kVariance;
  o.placement = SamplePlacement::kSplat;
  o.filter = *PixelFilter::triangle(1.5, 0.75);
  return o;
}

TEST(FilmMerge, MergingIsAssociativeCommutativeAndEmptyIsItsZero) {
  const FilmOptions o = full_film();
  const auto part = [&](std::uint32_t seed) {
    Film film = *Film::create(o);
    EXPECT_TRUE(film.add(random_samples(300, seed).wavelengths()));
    return film;
  };
  const Film a = part(1);
  const Film b = part(2);
  const Film c = part(3);
  const Film empty = *Film::create(o);
  const auto sum = [&](std::initializer_list<const Film*> films) {
    Film out = *Film::create(o);
    for (const Film* f : films) EXPECT_TRUE(out.merge(*f));
    return out;
  };
  const Film bc = sum({&b, &c});
  const Film ab = sum({&a, &b});
  EXPECT_TRUE(sum({&ab, &c}).same_contents(sum({&a, &bc})));
  EXPECT_TRUE(sum({&a, &b, &c}).same_contents(sum({&c, &a, &b})));
  EXPECT_TRUE(sum({&a, &empty}).same_contents(a));
  EXPECT_TRUE(a.same_contents(sum({&empty, &a, &empty})));
  EXPECT_TRUE(a.same_contents(a));
  EXPECT_FALSE(a.same_contents(b));
  EXPECT_FALSE(b.same_contents(a));
  EXPECT_FALSE(a.same_contents(empty));
  EXPECT_EQ(sum({&a, &b, &c}).stats().accepted, a.stats().accepted + b.stats().accepted + c.stats().accepted);
}

TEST(FilmMerge, ManyMergesAreOneFilm) {
  const FilmOptions o = full_film();
  const FilmSamples all = random_samples(2000, 11);
  Film whole = *Film::create(o);
  ASSERT_TRUE(whole.add(all.wavelengths()));
  Film merged = *Film::create(o);
  for (std::size_t i = 0; i < 2000; i += 40) {
    Film part = *Film::create(o);
    ASSERT_TRUE(part.add(all.wavelengths(i, 40)));
    ASSERT_TRUE(merged.merge(part));
  }
  EXPECT_TRUE(whole.same_contents(merged));
  EXPECT_EQ(whole.stats().rejected, merged.stats().rejected);
}

TEST(FilmMerge, RestsOfEitherSignAddUpAcrossManyCarries) {
  // Steps of plus and minus nearly one half of a coarse step, past several carries: the sum is known.
  constexpr std::size_t kN = 700000;
  BandBatch b(1, kN);
  const float up = 0.49999997F * 0x1p-31F;
  const float down = -0.4999999F * 0x1p-31F;
  double sum = 0;  // exact: both are whole multiples of 2^-60, and there are few enough
  for (std::size_t i = 0; i < kN; ++i) {
    b.put(i, 3, 3, 1);
    b.radiance(0, i) = (i / 1000) % 3 == 0 ? down : up;
    sum += static_cast<double>(b.radiance(0, i));
  }
  Film film = *Film::create(plain_film(8, 0));
  ASSERT_TRUE(film.add(b.samples()));
  EXPECT_EQ(developed(film, FilmLayer::kSpectrum)[3 * 8 + 3], static_cast<float>(sum / kN));
  Film other = *Film::create(plain_film(8, 0));
  add_in_batches(other, b, 77777);
  EXPECT_TRUE(film.same_contents(other));
}

TEST(Film, FilmsThatDifferRefuseToMergeAndSayInWhat) {
  const FilmOptions o = small_film();
  Film film = *Film::create(o);
  const auto refusal = [&](auto change) {
    FilmOptions other = small_film();
    change(other);
    const Film second = *Film::create(other);
    const auto result = film.merge(second);
    EXPECT_FALSE(result);
    return result ? "" : result.error().message;
  };
  using testing::HasSubstr;
  EXPECT_THAT(refusal([](FilmOptions& p) { p.width = 21; }), HasSubstr("size: 20 x 20 and 21 x 20"));
  EXPECT_THAT(refusal([](FilmOptions& p) { p.range = 31; }), HasSubstr("range: 2^32 and 2^31"));
  EXPECT_THAT(refusal([](FilmOptions& p) { p.xyz = Observer::kCie1964; }), HasSubstr("cie1931 and cie1964"));
  EXPECT_THAT(refusal([](FilmOptions& p) { p.spectral = true; }), HasSubstr("spectrum"));
  EXPECT_THAT(refusal([](FilmOptions& p) { p.filter = *PixelFilter::triangle(); }), HasSubstr("filter"));
  EXPECT_THAT(refusal([](FilmOptions& p) { p.statistics = PixelStatistics::kCounts; }),
              HasSubstr("statistics"));
  EXPECT_THAT(refusal([](FilmOptions& p) { p.crop = PixelWindow{0, 0, 5, 5}; }), HasSubstr("crop window"));
  EXPECT_THAT(refusal([](FilmOptions& p) { p.maximum_component = 3; }), HasSubstr("maximum component"));
  EXPECT_FALSE(film.merge(film));
}

}  // namespace
}  // namespace spectile::test
