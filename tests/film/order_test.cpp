// The same bits in any order: permutations, splits, threads, instruction sets, merges.
#include <algorithm>
#include <numeric>
#include <thread>

#include "src/dispatch/dispatch.hpp"
#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

/// A film with everything that a film can keep.
FilmOptions full_film(SamplePlacement placement) {
  FilmOptions o = small_film();
  o.width = o.height = 40;
  o.placement = placement;
  if (placement == SamplePlacement::kSplat) o.filter = *PixelFilter::mitchell(1.5, 1.25);
  o.sensors.push_back({"canon-eos-5d-mkii", *Sensor::named("canon-eos-5d-mkii")});
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 20);
  o.statistics = PixelStatistics::kVariance;
  o.maximum_component = 1e5F;
  return o;
}

/// Puts the fastest table back in force.
class ScopedIsa {
 public:
  explicit ScopedIsa(const char* name) { EXPECT_TRUE(dispatch::force(name)); }
  ScopedIsa(const ScopedIsa&) = delete;
  ScopedIsa& operator=(const ScopedIsa&) = delete;
  ~ScopedIsa() { EXPECT_TRUE(dispatch::force("")); }
};

/// Adds all samples in a random order, in batches of random sizes, from several threads into several films on
/// random instruction sets, and merges those in a random order.
Film shuffled(const FilmOptions& o, const FilmSamples& samples, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  const FilmSamples mixed = samples.permuted(order);
  const std::size_t shards = 1 + random() % 4;
  std::vector<Film> films;
  for (std::size_t i = 0; i < shards; ++i) films.push_back(*Film::create(o));
  const auto tables = dispatch::available();
  for (std::size_t i = 0; i < shards; ++i) {
    const ScopedIsa table(tables[random() % tables.size()]->name);
    const std::size_t first = samples.size() * i / shards;
    const std::size_t end = samples.size() * (i + 1) / shards;
    const std::size_t threads = 1 + random() % 8;
    std::vector<std::thread> workers;
    for (std::size_t t = 0; t < threads; ++t) {
      const std::size_t from = first + (end - first) * t / threads;
      const std::size_t to = first + (end - first) * (t + 1) / threads;
      workers.emplace_back([&films, &mixed, i, from, to, own = random()] {
        std::mt19937 sizes(static_cast<std::uint32_t>(own));
        for (std::size_t at = from; at < to;) {
          const std::size_t n =
              std::min<std::size_t>(to - at, 1 + sizes() % (sizes() % 3 == 0 ? 20000 : 300));
          ASSERT_TRUE(films[i].add(mixed.wavelengths(at, n), {static_cast<int>(1 + sizes() % 2)}));
          at += n;
        }
      });
    }
    for (std::thread& worker : workers) worker.join();
  }
  std::shuffle(films.begin(), films.end(), random);
  for (std::size_t i = 1; i < films.size(); ++i) EXPECT_TRUE(films[0].merge(films[i]));
  return std::move(films[0]);
}

void expect_same_bits(std::size_t samples, int runs) {
  for (const SamplePlacement placement : {SamplePlacement::kOnePixel, SamplePlacement::kSplat}) {
    const std::size_t n = placement == SamplePlacement::kSplat ? samples / 10 : samples;
    const FilmOptions o = full_film(placement);
    const FilmSamples s = random_samples(n, 11, 40);
    Film once = *Film::create(o);
    ASSERT_TRUE(once.add(s.wavelengths()));
    ASSERT_GT(once.stats().accepted, n / 2);
    for (int run = 0; run < runs; ++run) {
      const Film film = shuffled(o, s, static_cast<std::uint32_t>(run));
      ASSERT_TRUE(film.same_contents(once)) << "run " << run;
    }
  }
}

TEST(FilmOrder, TheSameBitsInAnyOrder) {
  expect_same_bits(20000, 6);
}

TEST(FilmOrder, TheSameBitsOfAMillionSamplesFiftyTimes) {
  expect_same_bits(1000000, 50);
}

TEST(FilmOrder, OneSampleMoreIsADifferentFilm) {
  const FilmOptions o = full_film(SamplePlacement::kOnePixel);
  FilmSamples s = random_samples(1000, 2, 40);
  Film a = *Film::create(o);
  Film b = *Film::create(o);
  ASSERT_TRUE(a.add(s.wavelengths()));
  ASSERT_TRUE(b.add(s.wavelengths()));
  EXPECT_TRUE(a.same_contents(b));
  FilmSamples one(1);
  one.put(0, 5, 5, 1e-9F);
  ASSERT_TRUE(b.add(one.wavelengths()));
  EXPECT_FALSE(a.same_contents(b));
}

TEST(FilmOrder, BatchesAtAnyAddressAreTheSame) {
  const FilmOptions o = full_film(SamplePlacement::kOnePixel);
  const FilmSamples s = random_samples(5000, 3, 40);
  Film once = *Film::create(o);
  ASSERT_TRUE(once.add(s.wavelengths()));
  for (const std::size_t step : {1, 3, 63, 64, 65, 1023, 1025, 4999}) {
    Film film = *Film::create(o);
    for (std::size_t i = 0; i < s.size(); i += step) {
      ASSERT_TRUE(film.add(s.wavelengths(i, std::min(step, s.size() - i))));
    }
    EXPECT_TRUE(film.same_contents(once)) << step;
  }
}

}  // namespace
}  // namespace spectile::test
