// Exact averages: every bit against long double where that is exact, and laws where it is not.
#include "src/io/average/exact_average.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace spectile {
namespace {

using exact::Depth;

constexpr double kDoubleInfinity = std::numeric_limits<double>::infinity();

/// The average of some samples, as it is before its last rounding.
double average(Depth depth, const std::vector<float>& samples, const exact::Weights& weights) {
  std::vector<std::uint64_t> sum(exact::words(depth));
  std::uint8_t flags = 0;
  exact::Wide missing = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (exact::add_row(depth, sum.data(), &flags, &samples[i], 1, weights.units[i])) continue;
    exact::add_missing(&missing, &samples[i], 1, weights.units[i]);
  }
  double out = 0;
  exact::finish_row(depth, &out, sum.data(), &flags, &missing, 1, weights.total);
  return out;
}

exact::Weights whole(const std::vector<double>& weights) {
  auto out = exact::whole_weights(weights);
  EXPECT_TRUE(out);
  return *out;
}

float average(const std::vector<float>& samples, std::vector<double> weights = {}) {
  if (weights.empty()) weights.assign(samples.size(), 1);
  const exact::Weights w = whole(weights);
  return static_cast<float>(average(exact::depth_for(false, w), samples, w));
}

std::uint32_t bits(float v) {
  return std::bit_cast<std::uint32_t>(v);
}

TEST(ExactWeights, AreWholeMultiplesOfOneNumber) {
  const exact::Weights w = whole({0.125, 0, 3, 0.75});
  EXPECT_EQ(w.units, (std::vector<exact::Wide>{1, 0, 24, 6}));
  EXPECT_EQ(w.total, exact::Wide{31});
  EXPECT_EQ(w.sum, 3.875);
  // A number that is no short binary fraction is one unit all the same when it is the only one.
  EXPECT_EQ(whole({0.1, 0.2, 0.1}).units, (std::vector<exact::Wide>{1, 2, 1}));
  const exact::Weights tenths = whole({0.1, 0.3});
  EXPECT_EQ(static_cast<double>(tenths.units[1]) / static_cast<double>(tenths.units[0]), 0.3 / 0.1);
  EXPECT_EQ(tenths.sum, 0.1 + 0.3);
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(whole({least, 2 * least}).units, (std::vector<exact::Wide>{1, 2}));
  EXPECT_EQ(whole({1e308, 0.5e308}).units, (std::vector<exact::Wide>{2, 1}));
}

TEST(ExactWeights, ThatCannotBeMeantAreErrors) {
  const std::vector<std::vector<double>> bad = {{},
                                                {0, 0},
                                                {1, -1},
                                                {1, std::numeric_limits<double>::quiet_NaN()},
                                                {1, kDoubleInfinity},
                                                {1e300, 1e-300},
                                                {1, std::numeric_limits<double>::denorm_min()},
                                                {1.7e308, 1.7e308}};
  for (const auto& weights : bad) {
    const auto out = exact::whole_weights(weights);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().code, ErrorCode::kBadArgument);
  }
}

TEST(ExactAverage, OfOneSampleIsThatSample) {
  for (const double weight : {1.0, 0.1, 3e20, 1e-30}) {
    for (const float v : {0.0F, -0.0F, 1.0F, -0.1F, 3.4028235e38F, 1e-45F, -1.1754942e-38F, 65504.0F}) {
      EXPECT_EQ(bits(average({v}, {weight})), bits(v)) << v << " with weight " << weight;
    }
  }
}

/// Random signs, magnitudes over 24 binary orders: sums with these weights take less than long double's 64
/// bits.
TEST(ExactAverage, IsTheExactOneRoundedOnce) {
  std::mt19937 random(7);
  for (const bool wide : {false, true}) {
    for (int trial = 0; trial < 20000; ++trial) {
      const std::size_t n = 1 + random() % 9;
      std::vector<float> samples;
      std::vector<double> weights;
      long double sum = 0;
      long double total = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const auto significand = static_cast<float>(static_cast<int>(random() % (1U << 24)) - (1 << 23));
        samples.push_back(std::ldexp(significand, static_cast<int>(random() % 24) - 140));
        weights.push_back(1 + random() % 255);
        sum += static_cast<long double>(samples.back()) * weights.back();
        total += weights.back();
      }
      const exact::Weights w = whole(weights);
      const double odd = average(wide ? Depth::kWide : Depth::kNarrow, samples, w);
      const auto out = static_cast<float>(odd);
      // The least float's neighbourhood too: half of these are denormal.
      const long double exact = sum / total;
      const long double error = std::fabs(out - exact);
      for (const float other : {std::nextafter(out, kInfinity), std::nextafter(out, -kInfinity)}) {
        ASSERT_LE(error, std::fabs(other - exact)) << "trial " << trial << ", wide " << wide;
      }
      ASSERT_LE(std::fabs(odd - exact), std::ldexp(std::fabs(exact), -26)) << "trial " << trial;
    }
  }
}

/// The ratio has the fewest bits then, and what remains of the division decides many roundings.
TEST(ExactAverage, IsRoundedOnceUnderTheLargestWeightsToo) {
  std::mt19937_64 random(17);
  for (int trial = 0; trial < 20000; ++trial) {
    const auto heavy = static_cast<double>((1ULL << 36) + random() % (1ULL << 35));
    const auto light = static_cast<double>(1 + random() % 100000);
    const auto a = static_cast<float>((1U << 23) + random() % (1U << 23));
    const auto b = static_cast<float>((1U << 23) + random() % (1U << 23));
    const float out = average({a, b}, {heavy, light});
    const long double exact = (static_cast<long double>(a) * heavy + static_cast<long double>(b) * light) /
                              (static_cast<long double>(heavy) + light);
    const long double error = std::fabs(out - exact);
    ASSERT_LE(error, std::fabs(std::nextafter(out, kInfinity) - exact)) << trial;
    ASSERT_LE(error, std::fabs(std::nextafter(out, -kInfinity) - exact)) << trial;
  }
}

TEST(ExactAverage, HasRoomForEveryTotal) {
  for (int bits_of_total = 2; bits_of_total <= 53; ++bits_of_total) {
    const exact::Weights w = whole({std::ldexp(1.0, bits_of_total) - 2, 1});
    for (const bool halves : {false, true}) {
      for (const float v : {65504.0F, -65504.0F, 0x1p-24F}) {
        EXPECT_EQ(average(exact::depth_for(halves, w), {v, v}, w), static_cast<double>(v)) << bits_of_total;
      }
    }
    for (const float v : {3.4028235e38F, -3.4028235e38F, 1e-45F}) {
      EXPECT_EQ(average(exact::depth_for(false, w), {v, v}, w), static_cast<double>(v)) << bits_of_total;
    }
  }
  const exact::Weights w = whole({0x1p99, 1});
  EXPECT_EQ(average(exact::depth_for(false, w), {-3.4028235e38F, -3.4028235e38F}, w),
            static_cast<double>(-3.4028235e38F));
  EXPECT_FALSE(exact::whole_weights(std::vector<double>{0x1p100, 1}));
}

TEST(ExactAverage, GoesHalfwayToTheEvenNeighbour) {
  const float ulp = 0x1p-23F;
  EXPECT_EQ(average({1, 1 + ulp}), 1);
  EXPECT_EQ(average({1 + ulp, 1 + 2 * ulp}), 1 + 2 * ulp);
  // A least float beside them decides.
  EXPECT_EQ(average({2, 2 + 2 * ulp, 1e-45F, 1e-45F}), 1 + ulp);
  EXPECT_EQ(average({2, 2 + 2 * ulp, -1e-45F, -1e-45F}), 1);
}

TEST(ExactAverage, LosesNothingToHugeNeighbours) {
  constexpr float kHuge = 3.4028235e38F;
  EXPECT_EQ(average({kHuge, kHuge, kHuge}), kHuge);
  EXPECT_EQ(average({kHuge, -kHuge, 3e-45F, 3e-45F}), 1e-45F);
  EXPECT_EQ(average({-kHuge, 3e-45F, kHuge, -3e-45F}), 0);
  EXPECT_EQ(average({kHuge, -kHuge, 1}, {0.1, 0.1, 0.3}), static_cast<float>(0.3 / (0.1 + 0.1 + 0.3)));
  EXPECT_EQ(average({-kHuge, kHuge, -2, 0}), -0.5F);
}

/// The same samples, all of them moved by a power of two, pass through every word of the sums.
TEST(ExactAverage, ScalesWithItsSamples) {
  std::mt19937 random(3);
  for (const auto& weights : {std::vector<double>{1, 2, 3}, std::vector<double>{0.1, 0.7, 12.3},
                              std::vector<double>{1e9, 1e20, 3}}) {
    const exact::Weights w = whole(weights);
    for (int trial = 0; trial < 300; ++trial) {
      std::vector<float> samples;
      for (int i = 0; i < 3; ++i) {
        samples.push_back(
            std::ldexp(static_cast<float>(static_cast<int>(random() % (1U << 24)) - (1 << 23)), -23));
      }
      const double base = average(exact::depth_for(false, w), samples, w);
      for (int k = -126; k <= 127; ++k) {
        std::vector<float> moved;
        for (const float v : samples) moved.push_back(std::ldexp(v, k));
        if (std::any_of(moved.begin(), moved.end(), [](float v) { return std::fabs(v) < 0x1p-126F; }))
          continue;
        ASSERT_EQ(average(exact::depth_for(false, w), moved, w), std::ldexp(base, k)) << k;
      }
    }
  }
}

TEST(ExactAverage, DependsNeitherOnOrderNorOnACommonFactor) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<std::pair<float, double>> terms;
    for (int i = 0; i < 12; ++i) {
      std::uint32_t pattern = static_cast<std::uint32_t>(random());
      if (!std::isfinite(std::bit_cast<float>(pattern))) pattern &= 0x7FFFFFU;
      terms.emplace_back(std::bit_cast<float>(pattern),
                         std::ldexp(1.0 + random() % 1000, static_cast<int>(random() % 30)));
    }
    const auto of = [&](double factor) {
      std::vector<float> samples;
      std::vector<double> weights;
      for (const auto& [v, weight] : terms) {
        samples.push_back(v);
        weights.push_back(weight * factor);
      }
      return bits(average(samples, weights));
    };
    const std::uint32_t first = of(1);
    ASSERT_EQ(of(2), first);
    ASSERT_EQ(of(3), first);
    std::shuffle(terms.begin(), terms.end(), random);
    ASSERT_EQ(of(1), first);
  }
}

TEST(ExactAverage, KnowsItsZeros) {
  EXPECT_EQ(bits(average({-0.0F, -0.0F})), bits(-0.0F));
  EXPECT_EQ(bits(average({-0.0F, 0.0F})), bits(0.0F));
  EXPECT_EQ(bits(average({1.0F, -1.0F})), bits(0.0F));
  EXPECT_EQ(bits(average({-0.0F, kNan})), bits(-0.0F));
  EXPECT_EQ(bits(average({kNan, kInfinity})), bits(0.0F));
  EXPECT_EQ(bits(average({-1e-45F, 0, 0})), bits(-0.0F));  // rounded to zero, from below
}

TEST(ExactAverage, LeavesOutWhatIsNotFinite) {
  EXPECT_EQ(average({1, kNan, 4}, {1, 5, 2}), 3);
  EXPECT_EQ(average({1, kInfinity, -kInfinity, 4}, {0.1, 0.7, 12.3, 0.1}), 2.5F);
}

TEST(ExactAverage, OfHalvesIsTheSameInOneWord) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<float> samples;
    std::vector<double> weights;
    for (int i = 0; i < 5; ++i) {
      // Any half: 11 bits, the least one 2^-24, the largest 65504.
      const int significand = static_cast<int>(random() % 4095) - 2047;
      samples.push_back(std::ldexp(static_cast<float>(significand), static_cast<int>(random() % 30) - 24));
      weights.push_back(1 + random() % 800000);
    }
    if (trial % 7 == 0) samples[2] = kInfinity;
    const exact::Weights w = whole(weights);
    ASSERT_EQ(exact::depth_for(true, w), Depth::kHalf);
    const float half = exact::to_odd_float(average(Depth::kHalf, samples, w));
    ASSERT_EQ(half, exact::to_odd_float(average(Depth::kNarrow, samples, w)));
    ASSERT_EQ(half, exact::to_odd_float(average(Depth::kWide, samples, w)));
  }
  const exact::Weights largest = whole({4194303});
  EXPECT_EQ(average(Depth::kHalf, {-65504}, largest), -65504);
}

TEST(OddFloat, KeepsWhatItIsNot) {
  EXPECT_EQ(exact::to_odd_float(1.5), 1.5F);
  EXPECT_EQ(exact::to_odd_float(1 + 0x1p-40), 1 + 0x1p-23F);
  EXPECT_EQ(exact::to_odd_float(1 - 0x1p-40), 1 - 0x1p-24F);
  EXPECT_EQ(exact::to_odd_float(-1 - 0x1p-40), -1 - 0x1p-23F);
  EXPECT_EQ(exact::to_odd_float(1 + 0x1.8p-23), 1 + 0x1p-23F);
  EXPECT_EQ(exact::to_odd_float(1e-60), 1e-45F);
}

}  // namespace
}  // namespace spectile
