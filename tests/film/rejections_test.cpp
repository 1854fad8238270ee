// Refusals: each sample once, by the first of the documented reasons, and without a trace in the sums.
#include <optional>

#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

constexpr std::array kSpecial = {kNan,    kInf, -kInf, 0.0F, -0.0F, kTiny,  -kTiny, 1e-38F, 1e-20F,
                                 -1e-20F, 1.0F, -1.0F, 5.5F, 1e20F, -1e20F, 1e38F,  -1e38F};

enum Reason { kAccepted, kNanReason, kInfinite, kNegative, kOutside, kBeyond };

constexpr const char* kReasons[] = {"accepted", "NaN", "infinite", "negative", "outside", "beyond the range"};

/// Counts of a film, in the order above.
std::array<std::uint64_t, 6> counts_of(const Film& film) {
  const FilmStats s = film.stats();
  return {s.accepted,          s.rejected.nan,     s.rejected.infinite,
          s.rejected.negative, s.rejected.outside, s.rejected.beyond_range};
}

/// Reasons from the documentation, in double; the last one is left to `beyond`, nothing where it is too near.
Reason first_reason(const FilmOptions& o, float x, float y, float w, const std::vector<float>& numbers,
                    bool negative_density, const std::optional<bool>& beyond) {
  bool nan = std::isnan(x) || std::isnan(y) || std::isnan(w);
  bool infinite = std::isinf(x) || std::isinf(y) || std::isinf(w);
  for (const float v : numbers) {
    nan = nan || std::isnan(v);
    infinite = infinite || std::isinf(v);
  }
  if (nan) return kNanReason;
  if (infinite) return kInfinite;
  if (negative_density || (w < 0 && !o.negative_weights)) return kNegative;
  if (x < 0 || y < 0 || x >= 20 || y >= 20) return kOutside;
  return beyond && *beyond ? kBeyond : kAccepted;
}

struct Drawn {
  std::mt19937 random{12};
  float special() { return kSpecial[random() % kSpecial.size()]; }
  float mostly(float usual) { return random() % 3 == 0 ? special() : usual; }
};

/// True if a position lies so little outside that half a pixel on is the first one's centre.
bool is_rounded(const FilmOptions& o, float x, float y) {
  const auto little = [](float v) { return v < 0 && v > -0x1p-24F; };
  return o.placement == SamplePlacement::kSplat && (little(x) || little(y));
}

/// True if |v| is beyond 2^range; nothing where it is near to that.
std::optional<bool> is_beyond(double v, int range) {
  const double most = std::ldexp(1.0, range);
  if (std::abs(v) > 1.001 * most) return true;
  if (std::abs(v) < 0.999 * most) return false;
  return {};
}

FilmOptions options_of(int bits) {
  FilmOptions o = small_film();
  if (bits % 2 == 1) o.placement = SamplePlacement::kSplat;
  if (bits / 2 % 2 == 1) o.spectral = true;
  if (bits / 4 % 2 == 1) o.statistics = PixelStatistics::kVariance;
  if (bits / 8 % 2 == 1) o.negative_weights = true;
  o.bands = *Bands::uniform(360, 830, 470);
  return o;
}

TEST(FilmRejections, OfBandsAreCountedOnceByTheFirstReason) {
  for (int bits = 0; bits < 16; ++bits) {
    FilmOptions o = options_of(bits);
    o.input = FilmInput::kBands;
    Film film = *Film::create(o);
    const double y_of_one = 1;
    Drawn d;
    std::uint64_t given = 0;
    for (int i = 0; i < 4000; ++i) {
      BandBatch b(1, 1);
      b.put(0, d.mostly(3.5F), d.mostly(4.5F), d.mostly(0.5F));
      b.radiance(0, 0) = d.mostly(2);
      const float r = b.radiance(0, 0);
      const float w = b.weight[0];
      std::optional<bool> beyond = is_beyond(w, o.weight_range);
      for (const double v : {static_cast<double>(w) * r * y_of_one,
                             o.statistics == PixelStatistics::kVariance ? static_cast<double>(r) : 0.0}) {
        const auto is = is_beyond(v, o.range);
        beyond = beyond && is ? std::optional<bool>(*beyond || *is) : std::nullopt;
      }
      if (!beyond || is_rounded(o, b.x[0], b.y[0])) continue;
      const auto before = counts_of(film);
      ASSERT_TRUE(film.add(b.samples()));
      const auto after = counts_of(film);
      ++given;
      const Reason want = first_reason(o, b.x[0], b.y[0], w, {r}, false, beyond);
      for (std::size_t k = 0; k < 6; ++k) {
        ASSERT_EQ(after[k] - before[k], k == static_cast<std::size_t>(want) ? 1U : 0U)
            << kReasons[k] << ", not " << kReasons[want] << ": options " << bits << ", x " << b.x[0] << ", y "
            << b.y[0] << ", weight " << w << ", radiance " << r;
      }
    }
    EXPECT_EQ(film.stats().accepted + film.stats().rejected.total(), given);
  }
}

TEST(FilmRejections, OfWavelengthsAreCountedOnceByTheFirstReason) {
  for (int bits = 0; bits < 16; ++bits) {
    const FilmOptions o = options_of(bits);
    Film film = *Film::create(o);
    Drawn d;
    for (int i = 0; i < 6000; ++i) {
      FilmSamples s(1);
      s.put(0, d.mostly(3.5F), d.mostly(4.5F), d.mostly(0.5F));
      const std::size_t k = d.random() % 4;
      s.radiance(k, 0) = d.mostly(2);
      s.lambda(k, 0) = d.mostly(555);
      s.density(k, 0) = d.mostly(0.0025F);
      const float w = s.weight[0];
      const float pdf = s.density(k, 0);
      std::vector<float> numbers;
      // The range depends on curves: only samples far on one side of it are drawn.
      std::optional<bool> beyond = is_beyond(w, o.weight_range);
      if (pdf != 0) {
        const float ratio = s.radiance(k, 0) / pdf;
        numbers = {pdf, s.lambda(k, 0), ratio};
        const double lambda = static_cast<double>(s.lambda(k, 0));
        const bool seen = lambda >= 360 && lambda <= 830;
        const double color = seen ? static_cast<double>(ratio) / 400 : 0;
        for (const double v : {color * w, o.statistics == PixelStatistics::kVariance ? color : 0.0}) {
          if (std::abs(v) > 1e7 && std::abs(v) < 1e13) beyond.reset();
          if (beyond) beyond = *beyond || std::abs(v) >= 1e13;
        }
        // Samples in no band: see the test below.
        if (o.spectral && lambda < 360) continue;
        if (o.spectral && lambda >= 830) continue;
        const bool in_band = lambda >= 360 && lambda < 830;
        if (o.spectral && in_band) {
          const double u = std::abs(static_cast<double>(w)) / 512 / static_cast<double>(pdf);
          if (u > 1e3 && u < 1e7) beyond.reset();
          if (beyond)
            beyond = *beyond || u >= 1e7 || u * std::abs(static_cast<double>(s.radiance(k, 0))) > 1e13;
        }
      }
      if (!beyond || is_rounded(o, s.x[0], s.y[0])) continue;
      const auto before = counts_of(film);
      ASSERT_TRUE(film.add(s.wavelengths()));
      const auto after = counts_of(film);
      const Reason want = first_reason(o, s.x[0], s.y[0], w, numbers, pdf < 0, beyond);
      for (std::size_t c = 0; c < 6; ++c) {
        ASSERT_EQ(after[c] - before[c], c == static_cast<std::size_t>(want) ? 1U : 0U)
            << kReasons[c] << ", not " << kReasons[want] << ": options " << bits << ", x " << s.x[0] << ", y "
            << s.y[0] << ", weight " << w << ", radiance " << s.radiance(k, 0) << ", lambda "
            << s.lambda(k, 0) << ", density " << pdf;
      }
    }
  }
}

TEST(FilmRejections, LeaveNoTraceWhateverStandsBesideThem) {
  // Good and bad samples in one batch, at every place of a vector: the sums are those of the good ones alone.
  for (int bits = 0; bits < 16; ++bits) {
    const FilmOptions o = options_of(bits);
    Film mixed = *Film::create(o);
    Film good = *Film::create(o);
    Drawn d;
    constexpr std::size_t kN = 1100;
    FilmSamples s(kN);
    std::vector<std::size_t> fine;
    for (std::size_t i = 0; i < kN; ++i) {
      s.put(i, d.random() % 7 == 0 ? d.special() : 0.02F * static_cast<float>(i % 1000), 9.5F, 0.75F);
      if (d.random() % 9 == 0) s.weight[i] = d.special();
      if (d.random() % 5 == 0) s.density(d.random() % 4, i) = d.special();
      if (d.random() % 5 == 0) s.radiance(d.random() % 4, i) = d.special();
      if (d.random() % 5 == 0) s.lambda(d.random() % 4, i) = d.special();
      Film alone = *Film::create(o);
      ASSERT_TRUE(alone.add(s.wavelengths(i, 1)));
      ASSERT_TRUE(good.add(s.wavelengths(i, 1)));
      if (alone.stats().accepted == 0) continue;
      fine.push_back(i);
    }
    ASSERT_GT(fine.size(), 200U);
    ASSERT_TRUE(mixed.add(s.wavelengths()));
    EXPECT_TRUE(mixed.same_contents(good)) << bits;
    Film only = *Film::create(o);
    for (const std::size_t i : fine) ASSERT_TRUE(only.add(s.wavelengths(i, 1)));
    EXPECT_EQ(only.stats().rejected.total(), 0U);
    for (const FilmLayer layer : {FilmLayer::kXyz, FilmLayer::kWeight}) {
      EXPECT_EQ(developed(mixed, layer), developed(only, layer)) << bits;
    }
  }
}

TEST(FilmRejections, AWavelengthOutsideEveryBandContributesNothing) {
  // However small its density: what is in no band has no contribution that could be beyond the range.
  FilmOptions o = small_film();
  o.spectral = true;
  o.bands = *Bands::uniform(400, 500, 100);
  Film film = *Film::create(o);
  FilmSamples s(1);
  s.put(0, 5, 5, 1);
  s.lambda(0, 0) = 845;
  s.density(0, 0) = 1e-12F;
  ASSERT_TRUE(film.add(s.wavelengths()));
  EXPECT_EQ(film.stats().accepted, 1U);
}

TEST(Film, RefusedSamplesAreCountedByTheFirstReasonAndReachNoPixel) {
  FilmOptions o = small_film();
  o.range = 4;
  o.weight_range = 1;
  o.spectral = true;
  o.statistics = PixelStatistics::kVariance;
  Film film = *Film::create(o);
  FilmSamples s(12);
  for (std::size_t i = 0; i < 12; ++i) s.put(i, 5, 5, 1);
  s.x[0] = kNan;
  s.weight[1] = kNan;
  s.radiance(2, 2) = kNan;
  s.y[3] = -kInf;
  s.density(0, 4) = 1e-45F;  // radiance over density is infinite
  s.weight[5] = -0.5F;
  s.density(3, 6) = -0.001F;
  s.x[7] = 1e30F;
  s.radiance(1, 8) = 1e9F;
  s.weight[9] = 3;
  s.weight[10] = -1;  // and NaN, which comes first
  s.lambda(0, 10) = kNan;
  ASSERT_TRUE(film.add(s.wavelengths()));
  const FilmRejections r = film.stats().rejected;
  EXPECT_EQ(r.nan, 4U);
  EXPECT_EQ(r.infinite, 2U);
  EXPECT_EQ(r.negative, 2U);
  EXPECT_EQ(r.outside, 1U);
  EXPECT_EQ(r.beyond_range, 2U);
  EXPECT_EQ(film.stats().accepted, 1U);
  Film one = *Film::create(o);
  FilmSamples only(1);
  only.put(0, 5, 5, 1);
  for (std::size_t k = 0; k < 4; ++k) {
    only.radiance(k, 0) = s.radiance(k, 11);
    only.lambda(k, 0) = s.lambda(k, 11);
  }
  ASSERT_TRUE(one.add(only.wavelengths()));
  for (const FilmLayer layer :
       {FilmLayer::kXyz, FilmLayer::kWeight, FilmLayer::kCount, FilmLayer::kSpectrum}) {
    EXPECT_EQ(developed(film, layer), developed(one, layer));
  }
}

}  // namespace
}  // namespace spectile::test
