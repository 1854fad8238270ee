// Exact sums: a billion samples in one pixel, and nine decades, against exact arithmetic.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

/// Integers wide enough for any sum of floats here: exact arithmetic for the reference.
__extension__ using Wide = __int128;

constexpr std::size_t kBatch = 65536;

/// A film of bands of 1 nm with one band: contributions are the samples themselves.
FilmOptions one_band(int side) {
  FilmOptions o;
  o.width = o.height = side;
  o.input = FilmInput::kBands;
  o.spectral = true;
  o.xyz.reset();
  o.bands = *Bands::uniform(555, 556, 1);
  return o;
}

struct Errors {
  double film = 0, floats = 0, doubles = 0;
};

/// Largest relative errors over the pixels of a film fed with draw(i) at pixel i % pixels.
template <class Draw>
Errors errors_of(std::size_t samples, int side, int exact_below, Draw draw) {
  const std::size_t pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  Film film = *Film::create(one_band(side));
  std::vector<float> float_sums(pixels, 0.0F);
  std::vector<double> double_sums(pixels, 0.0);
  std::vector<Wide> exact(pixels, 0);
  std::vector<std::size_t> counts(pixels, 0);
  BandBatch batch(1, kBatch);
  for (std::size_t first = 0; first < samples; first += kBatch) {
    const std::size_t n = std::min(kBatch, samples - first);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t p = (first + i) % pixels;
      batch.x[i] = static_cast<float>(p % static_cast<std::size_t>(side));
      batch.y[i] = static_cast<float>(p / static_cast<std::size_t>(side));
      const float v = draw();
      batch.radiance(0, i) = v;
      float_sums[p] += v;
      double_sums[p] += static_cast<double>(v);
      exact[p] += static_cast<Wide>(std::ldexp(static_cast<double>(v), exact_below));
      ++counts[p];
    }
    BandSamples part = batch.samples();
    part.x = part.x.first(n);
    part.y = part.y.first(n);
    part.weight = part.weight.first(n);
    EXPECT_TRUE(film.add(part));
  }
  auto developed = *FilmDevelopment::create(film, FilmLayer::kSpectrum);
  EXPECT_TRUE(developed.update());
  Errors out;
  for (std::size_t p = 0; p < pixels; ++p) {
    const long double reference =
        std::ldexp(static_cast<long double>(exact[p]), -exact_below) / static_cast<long double>(counts[p]);
    const auto error = [&](long double got) { return static_cast<double>(std::abs(got / reference - 1)); };
    const auto n = static_cast<long double>(counts[p]);
    const float got = developed.at(0, static_cast<int>(p) % side, static_cast<int>(p) / side);
    out.film = std::max(out.film, error(static_cast<long double>(got)));
    out.floats = std::max(out.floats, error(static_cast<long double>(float_sums[p]) / n));
    out.doubles = std::max(out.doubles, error(static_cast<long double>(double_sums[p]) / n));
  }
  return out;
}

/// A fast generator of 32 bits. Source: Marsaglia, Xorshift RNGs, Journal of Statistical Software 8(14),
/// 2003.
class Random {
 public:
  float unit() {
    state_ ^= state_ << 13U;
    state_ ^= state_ >> 7U;
    state_ ^= state_ << 17U;
    return static_cast<float>(state_ >> 40U) * 0x1p-24F;
  }

 private:
  std::uint64_t state_ = 88172645463325252U;
};

void report(const char* what, const Errors& e) {
  testing::Test::RecordProperty(
      what, fmt::format("film {:.2g}, float {:.2g}, double {:.2g}", e.film, e.floats, e.doubles));
  std::printf("%s: relative error film %.2g, sum of floats %.2g, sum of doubles %.2g\n", what, e.film,
              e.floats, e.doubles);
}

Errors noise(std::size_t samples) {
  Random random;
  return errors_of(samples, 1, 30, [&] { return 1.0F + 1e-4F * (random.unit() - 0.5F); });
}

Errors decades(std::size_t samples) {
  Random random;
  // A pixel's samples cover nine decades each: the sum is that of the large ones, and the small ones count.
  return errors_of(samples, 16, 60, [&] { return std::pow(10.0F, 9 * random.unit() - 6); });
}

TEST(FilmAccuracy, TwentyMillionSamplesOfNoiseInOnePixel) {
  const Errors e = noise(20000000);
  report("20 000 000 samples of 1 + 1e-4 noise in one pixel", e);
  EXPECT_LT(e.film, 1e-7);
  EXPECT_GT(e.floats, 1e-6);  // beyond 2^24 a float takes steps of 2
}

TEST(FilmAccuracy, AMillionSamplesOverNineDecades) {
  const Errors e = decades(1000000);
  report("1 000 000 samples over nine decades", e);
  EXPECT_LT(e.film, 1e-7);
}

TEST(FilmAccuracy, ABillionSamplesOfNoiseInOnePixel) {
  const Errors e = noise(1000000000);
  report("10^9 samples of 1 + 1e-4 noise in one pixel", e);
  EXPECT_LT(e.film, 1e-7);
  EXPECT_GT(e.floats, 0.9);
}

TEST(FilmAccuracy, AHundredMillionSamplesOverNineDecades) {
  const Errors e = decades(100000000);
  report("10^8 samples over nine decades in 256 pixels", e);
  EXPECT_LT(e.film, 1e-7);
}

TEST(FilmAccuracy, ContributionsAreExactDownToTheStatedSize) {
  // 2^(range - 51) and anything above it with 24 bits; below, within half a step of 2^(range - 75).
  FilmOptions o = one_band(1);
  o.range = 10;
  for (const float small : {std::ldexp(1.0F, 10 - 51), std::ldexp(16777215.0F, 10 - 75)}) {
    Film film = *Film::create(o);
    BandBatch b(1, 3);
    b.radiance(0, 0) = 1000;
    b.radiance(0, 1) = small;
    b.radiance(0, 2) = -1000;
    ASSERT_TRUE(film.add(b.samples()));
    EXPECT_EQ(developed(film, FilmLayer::kSpectrum)[0], static_cast<float>(static_cast<double>(small) / 3));
  }
  for (const float below : {std::ldexp(1.25F, 10 - 75), std::ldexp(1.0F, 10 - 77)}) {
    Film film = *Film::create(o);
    BandBatch b(1, 1);
    b.radiance(0, 0) = below;
    ASSERT_TRUE(film.add(b.samples()));
    EXPECT_NEAR(developed(film, FilmLayer::kSpectrum)[0], below, std::ldexp(1.0, 10 - 76));
  }
}

TEST(FilmAccuracy, ColoursOfHalfAMillionSamplesAreWithinTheirBound) {
  // The mean of many colours, each within (K + 8) roundings, against the same sums in double.
  FilmOptions o = small_film();
  Film film = *Film::create(o);
  const std::size_t n = 500000;
  const FilmSamples s = random_samples(n, 77);
  FilmSamples copy = s;
  ASSERT_TRUE(film.add(s.wavelengths()));
  const Sensor observer = *Sensor::named("cie1931");
  std::vector<std::array<double, 3>> sums(400);
  std::vector<double> weights(400, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const bool bad = i % 100 == 3 || i % 1000 == 4 || i % 1000 == 5;
    if (bad || !(s.x[i] >= 0 && s.x[i] < 20 && s.y[i] >= 0 && s.y[i] < 20)) continue;
    const std::size_t p = static_cast<std::size_t>(s.y[i]) * 20 + static_cast<std::size_t>(s.x[i]);
    const auto w = static_cast<double>(s.weight[i]);
    weights[p] += w;
    for (std::size_t k = 0; k < 4; ++k) {
      if (copy.density(k, i) == 0) continue;
      const double ratio =
          static_cast<double>(copy.radiance(k, i)) / static_cast<double>(copy.density(k, i)) / 4;
      for (std::size_t c = 0; c < 3; ++c) {
        sums[p][c] +=
            w * ratio * observer.factors()[c] * observer.curves()[c](static_cast<double>(copy.lambda(k, i)));
      }
    }
  }
  auto xyz = *FilmDevelopment::create(film, FilmLayer::kXyz);
  ASSERT_TRUE(xyz.update());
  double worst = 0;
  for (std::size_t p = 0; p < 400; ++p) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double want = sums[p][c] / weights[p];
      worst =
          std::max(worst, std::abs(xyz.at(c, static_cast<int>(p % 20), static_cast<int>(p / 20)) / want - 1));
    }
  }
  EXPECT_LT(worst, 12 * 0x1p-24);
}

}  // namespace
}  // namespace spectile::test
