// Averages over other bands: weights, and what is said where the old bands end or leave gaps.
#include "src/io/convert/stages/resample.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace spectile::io {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Quantity kBoth[] = {Quantity::kReflectance, Quantity::kIlluminant};

double sum(const BandAverage& average) {
  return std::accumulate(average.weights.begin(), average.weights.end(), 0.0);
}

/// Bands of random widths, some with gaps before them.
Bands random_bands(std::mt19937& random, double from, std::size_t count, double gap_share) {
  std::uniform_real_distribution<double> width(0.5, 20);
  std::uniform_real_distribution<double> chance(0, 1);
  std::vector<Band> list;
  double at = from;
  for (std::size_t i = 0; i < count; ++i) {
    if (chance(random) < gap_share) at += width(random);
    const double end = at + width(random);
    list.push_back({at, (at + end) / 2, end});
    at = end;
  }
  return *Bands::from_list(std::move(list));
}

TEST(BandAverages, AreSharesOfTheOverlap) {
  std::vector<std::string> notes;
  const Bands from = *Bands::parse("400:440:10");
  const Bands to = *Bands::from_list({{402, 404, 405}, {405, 415, 425}, {425, 430, 440}});
  for (const Quantity quantity : kBoth) {
    const auto averages = band_averages(from, to, quantity, notes);
    ASSERT_EQ(averages.size(), 3U);
    EXPECT_EQ(averages[0].first, 0U);
    EXPECT_THAT(averages[0].weights, ElementsAre(1.0));
    EXPECT_EQ(averages[1].first, 0U);
    EXPECT_THAT(averages[1].weights,
                ElementsAre(DoubleNear(0.25, 1e-15), DoubleNear(0.5, 1e-15), DoubleNear(0.25, 1e-15)));
    EXPECT_EQ(averages[2].first, 2U);
    EXPECT_THAT(averages[2].weights, ElementsAre(DoubleNear(1.0 / 3, 1e-15), DoubleNear(2.0 / 3, 1e-15)));
    EXPECT_THAT(notes, IsEmpty());
  }
}

TEST(BandAverages, BeyondTheEndsReflectanceIsHeldAndLightIsZero) {
  const Bands from = *Bands::parse("400:420:10");
  const Bands to = *Bands::parse("380:440:15");
  std::vector<std::string> notes;
  const auto held = band_averages(from, to, Quantity::kReflectance, notes);
  EXPECT_THAT(held[0].weights, ElementsAre(1.0));
  EXPECT_THAT(held[1].weights, ElementsAre(1.0));
  EXPECT_THAT(held[3].weights, ElementsAre(1.0));
  EXPECT_EQ(held[3].first, 1U);
  EXPECT_THAT(notes, ElementsAre("4 of 4 new bands lie, in part or whole, beyond the input's 400 to 420 nm, "
                                 "where reflectance keeps the nearest band's value"));
  notes.clear();
  const auto light = band_averages(from, to, Quantity::kIlluminant, notes);
  EXPECT_THAT(light[0].weights, ElementsAre(0.0));
  EXPECT_THAT(light[1].weights, ElementsAre(DoubleNear(2.0 / 3, 1e-15)));
  EXPECT_THAT(light[2].weights, ElementsAre(DoubleNear(2.0 / 3, 1e-15)));
  EXPECT_THAT(light[3].weights, ElementsAre(0.0));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("beyond the input's 400 to 420 nm, where light is 0")));
}

TEST(BandAverages, GapsAreSharedAtTheirMiddle) {
  const Bands from = *Bands::from_list({{400, 405, 410}, {430, 435, 440}});
  const Bands to = *Bands::from_list({{405, 410, 415}, {416, 420, 424}});
  std::vector<std::string> notes;
  const auto held = band_averages(from, to, Quantity::kReflectance, notes);
  EXPECT_THAT(held[0].weights, ElementsAre(1.0));
  EXPECT_THAT(held[1].weights, ElementsAre(DoubleNear(0.5, 1e-15), DoubleNear(0.5, 1e-15)));
  EXPECT_THAT(notes, ElementsAre("2 of 2 new bands lie, in part or whole, between the input's bands, where "
                                 "reflectance keeps the nearest band's value"));
  notes.clear();
  const auto light = band_averages(from, to, Quantity::kIlluminant, notes);
  EXPECT_THAT(light[0].weights, ElementsAre(DoubleNear(0.5, 1e-15)));
  EXPECT_THAT(light[1].weights, ElementsAre(0.0));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("between the input's bands, where light is 0")));
}

TEST(BandAverages, WeightsOfReflectanceAddUpToOne) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const Bands from = random_bands(random, 380, 1 + random() % 40, 0.2);
    const Bands to = random_bands(random, 360 + static_cast<double>(random() % 40), 1 + random() % 40, 0.2);
    std::vector<std::string> notes;
    for (const BandAverage& average : band_averages(from, to, Quantity::kReflectance, notes)) {
      EXPECT_NEAR(sum(average), 1, 1e-12);
      EXPECT_LE(average.first + average.weights.size(), from.count());
    }
  }
}

TEST(BandAverages, OfLightKeepTheEnergy) {
  // New bands without gaps, over all of the old ones: sum of width times sample is what it was.
  std::mt19937 random(2);
  std::uniform_real_distribution<double> sample(0, 10);
  for (int i = 0; i < 200; ++i) {
    const Bands from = random_bands(random, 400, 1 + random() % 40, 0.2);
    Bands to = random_bands(random, 390, 200, 0);
    ASSERT_GT(to[199].upper_nm, from[from.count() - 1].upper_nm);
    std::vector<double> samples;
    double before = 0;
    for (const Band& band : from.list()) {
      samples.push_back(sample(random));
      before += band.width_nm() * samples.back();
    }
    std::vector<std::string> notes;
    const auto averages = band_averages(from, to, Quantity::kIlluminant, notes);
    double after = 0;
    for (std::size_t b = 0; b < to.count(); ++b) {
      for (std::size_t k = 0; k < averages[b].weights.size(); ++k) {
        after += to[b].width_nm() * averages[b].weights[k] * samples[averages[b].first + k];
      }
    }
    EXPECT_NEAR(after, before, 1e-9 * before);
  }
}

TEST(BandAverages, OfTheSameBandsAreTheSamples) {
  std::mt19937 random(3);
  for (const Quantity quantity : kBoth) {
    const Bands bands = random_bands(random, 400, 30, 0.3);
    std::vector<std::string> notes;
    const auto averages = band_averages(bands, bands, quantity, notes);
    for (std::size_t b = 0; b < bands.count(); ++b) {
      EXPECT_EQ(averages[b].first, b);
      EXPECT_THAT(averages[b].weights, ElementsAre(1.0));
    }
    EXPECT_THAT(notes, IsEmpty());
  }
}

}  // namespace
}  // namespace spectile::io
