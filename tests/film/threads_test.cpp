// A film in many hands: adding, developing, merging, saving and asking at once.
#include <atomic>
#include <cstdio>
#include <spectile/image/film_file.hpp>
#include <thread>

#include "tests/film/film_support.hpp"

namespace spectile::test {
namespace {

constexpr std::size_t kThreads = 8;
constexpr std::size_t kSmallBatch = 700;

FilmOptions busy_film(SamplePlacement placement) {
  FilmOptions o;
  o.width = o.height = 50;
  o.crop = PixelWindow{3, 5, 45, 49};
  o.placement = placement;
  if (placement == SamplePlacement::kSplat) o.filter = *PixelFilter::gaussian(1.5, 1);
  o.spectral = true;
  o.bands = *Bands::uniform(400, 700, 100);
  o.statistics = PixelStatistics::kVariance;
  return o;
}

/// Eight threads that add all samples `rounds` times while `meanwhile` runs over and over.
template <class Meanwhile>
void add_while(Film& film, const FilmSamples& samples, std::size_t rounds, Meanwhile meanwhile) {
  std::atomic<std::size_t> running = kThreads;
  std::vector<std::thread> workers;
  for (std::size_t t = 0; t < kThreads; ++t) {
    workers.emplace_back([&, t] {
      for (std::size_t round = 0; round < rounds; ++round) {
        for (std::size_t i = t * kSmallBatch; i < samples.size(); i += kThreads * kSmallBatch) {
          EXPECT_TRUE(film.add(samples.wavelengths(i, std::min(kSmallBatch, samples.size() - i))));
        }
      }
      --running;
    });
  }
  do meanwhile();
  while (running > 0);
  for (std::thread& worker : workers) worker.join();
}

Film added_alone(const FilmOptions& o, const FilmSamples& samples, std::size_t rounds) {
  Film film = *Film::create(o);
  for (std::size_t i = 0; i < rounds; ++i) EXPECT_TRUE(film.add(samples.wavelengths()));
  return film;
}

TEST(FilmThreads, DevelopedMeanwhile) {
  for (const auto placement : {SamplePlacement::kOnePixel, SamplePlacement::kSplat}) {
    const FilmOptions o = busy_film(placement);
    const FilmSamples samples = random_samples(20000, 3, 50);
    Film film = *Film::create(o);
    auto xyz = *FilmDevelopment::create(film, FilmLayer::kXyz);
    auto spectrum = *FilmDevelopment::create(film, FilmLayer::kSpectrum);
    add_while(film, samples, 2, [&] {
      EXPECT_TRUE(xyz.update());
      EXPECT_TRUE(spectrum.update({2}));
      EXPECT_LE(film.stats().accepted, 2 * samples.size());
    });
    ASSERT_TRUE(xyz.update());
    EXPECT_EQ(xyz.update()->developed, 0U);
    const Film alone = added_alone(o, samples, 2);
    EXPECT_TRUE(film.same_contents(alone));
    const auto want = developed(alone, FilmLayer::kXyz);
    std::size_t i = 0;
    for (std::size_t p = 0; p < 3; ++p) {
      for (int y = 5; y < 49; ++y) {
        for (int x = 3; x < 45; ++x) ASSERT_EQ(xyz.at(p, x, y), want[i++]);
      }
    }
  }
}

TEST(FilmThreads, SavedMeanwhileFilesHoldWholeBatches) {
  const std::string path = testing::TempDir() + "film_threads_saved.exr";
  const FilmOptions o = busy_film(SamplePlacement::kOnePixel);
  FilmSamples samples(kThreads * kSmallBatch);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.put(i, 3.5F + static_cast<float>(i % 40), 6.5F + static_cast<float>(i % 37), 1);
  }
  Film film = *Film::create(o);
  int saved = 0;
  add_while(film, samples, 40, [&] {
    const auto report = save_film(film, path);
    ASSERT_TRUE(report) << report.error().message;
    const auto loaded = load_film(path);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->film.stats().accepted % kSmallBatch, 0U);
    double weights = 0;
    for (const float w : developed(loaded->film, FilmLayer::kWeight)) weights += static_cast<double>(w);
    EXPECT_EQ(weights, static_cast<double>(loaded->film.stats().accepted));
    ++saved;
  });
  EXPECT_GT(saved, 0);
  EXPECT_TRUE(film.same_contents(added_alone(o, samples, 40)));
  std::remove(path.c_str());
}

TEST(FilmThreads, SavedWhileDeveloped) {
  // Saving carries sums over: a development at that moment must not see half of it.
  const std::string path = testing::TempDir() + "film_threads_developed.exr";
  FilmOptions o = busy_film(SamplePlacement::kOnePixel);
  o.statistics = PixelStatistics::kNone;
  Film film = *Film::create(o);
  FilmSamples samples(4000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.put(i, 3.5F + static_cast<float>(i % 40), 6.5F + static_cast<float>(i % 37), 0.3F);
  }
  ASSERT_TRUE(film.add(samples.wavelengths()));
  std::atomic<bool> done = false;
  std::thread developer([&] {
    while (!done) {
      const auto seen = developed(film, FilmLayer::kWeight);
      for (const float w : seen) ASSERT_GE(w, 0);
    }
  });
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(film.add(samples.wavelengths()));
    ASSERT_TRUE(save_film(film, path));
  }
  done = true;
  developer.join();
  std::remove(path.c_str());
}

TEST(FilmThreads, MergedBothWaysAndFromManyThreads) {
  const FilmOptions o = busy_film(SamplePlacement::kOnePixel);
  const FilmSamples samples = random_samples(3000, 5, 50);
  Film total = *Film::create(o);
  std::vector<std::thread> workers;
  for (std::size_t t = 0; t < kThreads; ++t) {
    workers.emplace_back([&] {
      Film own = *Film::create(o);
      EXPECT_TRUE(own.add(samples.wavelengths()));
      EXPECT_TRUE(total.merge(own));
      EXPECT_TRUE(total.add(samples.wavelengths()));
    });
  }
  for (std::thread& worker : workers) worker.join();
  EXPECT_TRUE(total.same_contents(added_alone(o, samples, 2 * kThreads)));
  Film a = added_alone(o, samples, 1);
  Film b = added_alone(o, samples, 1);
  std::thread one([&] { EXPECT_TRUE(a.merge(b)); });
  std::thread other([&] { EXPECT_TRUE(b.merge(a)); });
  one.join();
  other.join();
}

TEST(FilmThreads, MergedWhileSavedFilesHoldWholeFilms) {
  const std::string path = testing::TempDir() + "film_threads_merged.exr";
  const FilmOptions o = busy_film(SamplePlacement::kOnePixel);
  FilmSamples samples(4000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.put(i, 3.5F + static_cast<float>(i % 40), 6.5F + static_cast<float>(i % 37), 1);
  }
  const Film part = added_alone(o, samples, 1);
  ASSERT_EQ(part.stats().rejected.total(), 0U);
  Film total = *Film::create(o);
  std::atomic<bool> done = false;
  std::thread merging([&] {
    while (!done) EXPECT_TRUE(total.merge(part));
  });
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(save_film(total, path));
    const auto loaded = load_film(path);
    ASSERT_TRUE(loaded) << loaded.error().message;
    double weights = 0;
    for (const float w : developed(loaded->film, FilmLayer::kWeight)) weights += static_cast<double>(w);
    EXPECT_EQ(weights, static_cast<double>(loaded->film.stats().accepted)) << i;
  }
  done = true;
  merging.join();
  std::remove(path.c_str());
}

}  // namespace
}  // namespace spectile::test
