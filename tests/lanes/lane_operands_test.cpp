// Arithmetic with one number a lane or one spectrum for all lanes; ranges of lanes, copies, and masks.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <spectile/lanes/arithmetic.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

constexpr std::size_t kLaneCounts[] = {1, 64, 65, 1000};

/// Batches with all kinds of numbers, and one number a lane.
struct Operands {
  explicit Operands(std::size_t lanes) {
    const Bands bands = *Bands::uniform(400, 700, 60);
    a = *SampledSpectra::create(bands, lanes);
    b = *SampledSpectra::create(bands, lanes);
    out = *SampledSpectra::create(bands, lanes);
    numbers = *ScalarLanes::create(lanes);
    const Floats drawn = arbitrary_floats(kLanesPerBlock * (2 * bands.count() + 1) * blocks_for(lanes), 5);
    std::size_t next = 0;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      numbers[lane] = drawn[next++];
      for (std::size_t band = 0; band < bands.count(); ++band) {
        a.at(lane, band) = drawn[next++];
        b.at(lane, band) = drawn[next++];
      }
    }
  }
  /// Every sample of the result is what f makes of those of a and b and of the lane's number.
  template <class F>
  void expect_result(F f) const {
    for (std::size_t lane = 0; lane < a.lanes(); ++lane) {
      for (std::size_t band = 0; band < a.axis().count(); ++band) {
        const float want = f(a.at(lane, band), b.at(lane, band), numbers[lane], band);
        const float got = out.at(lane, band);
        ASSERT_TRUE(got == want || (std::isnan(got) && std::isnan(want)))
            << "lane " << lane << ", band " << band << ": " << got << ", not " << want;
      }
    }
  }
  SampledSpectra a, b, out;
  ScalarLanes numbers;
};

TEST(LaneOperands, AreWhatOneLaneAfterTheOtherGives) {
  for (const std::size_t lanes : kLaneCounts) {
    for (const Execution& execution : {Execution{1, 64}, Execution{2, 128}, Execution{}}) {
      Operands o(lanes);
      ASSERT_TRUE(scale(o.a.view(), o.numbers.view(), o.out.span(), execution));
      o.expect_result([](float a, float, float f, std::size_t) { return a * f; });
      ASSERT_TRUE(lerp(o.a.view(), o.b.view(), o.numbers.view(), o.out.span(), execution));
      o.expect_result([](float a, float b, float t, std::size_t) {
        const float rest = 1 - t;
        const float first = rest * a;
        return first + t * b;
      });
      ASSERT_TRUE(complement(o.a.view(), o.out.span(), execution));
      o.expect_result([](float a, float, float, std::size_t) { return 1 - a; });
      const std::vector<float> spectrum = {0.5F, 3, -0.0F, kInf, 1e-30F};
      ASSERT_TRUE(multiply(o.a.view(), spectrum, o.out.span(), execution));
      o.expect_result([&](float a, float, float, std::size_t band) { return a * spectrum[band]; });
    }
  }
}

TEST(LaneOperands, OfOtherLanesOrBandsAreRefused) {
  Operands o(100);
  const auto few = *ScalarLanes::create(99);
  EXPECT_EQ(scale(o.a.view(), few.view(), o.out.span()).error().code, ErrorCode::kSizeMismatch);
  EXPECT_EQ(lerp(o.a.view(), o.b.view(), few.view(), o.out.span()).error().code, ErrorCode::kSizeMismatch);
  EXPECT_EQ(transmittance(o.a.view(), few.view(), o.out.span()).error().code, ErrorCode::kSizeMismatch);
  const std::vector<float> short_one(4, 1.0F);
  EXPECT_EQ(multiply(o.a.view(), short_one, o.out.span()).error().code, ErrorCode::kBandsMismatch);
  EXPECT_EQ(complement(o.a.view(), SampledSpectra::create(Bands(), 100)->span()).error().code,
            ErrorCode::kBandsMismatch);
  EXPECT_EQ(scale(o.a.view(), LanesView{o.numbers.view().data + 1, 100}, o.out.span()).error().code,
            ErrorCode::kBadArgument);
}

TEST(Transmittance, IsExpWithinElevenTenthsOfAnUlp) {
  constexpr std::size_t kMany = 1 << 16;
  auto sigma = *SampledSpectra::create(*Bands::uniform(400, 700, 300), kMany);
  auto distance = *ScalarLanes::create(kMany);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(0, 1);
  double worst = 0;
  for (int round = 0; round < 8; ++round) {
    for (std::size_t i = 0; i < kMany; ++i) {
      // Products from -89 to 104, of factors of all sizes.
      const float size = std::exp2(60 * uniform(random) - 30);
      sigma.at(i, 0) = size;
      distance[i] = (193 * uniform(random) - 89) / size;
    }
    auto out = *SampledSpectra::create(sigma.axis(), kMany);
    ASSERT_TRUE(transmittance(sigma.view(), distance.view(), out.span()));
    for (std::size_t i = 0; i < kMany; ++i) {
      const double want = std::exp(-(static_cast<double>(sigma.at(i, 0)) * static_cast<double>(distance[i])));
      if (want > static_cast<double>(kMost)) continue;
      const double ulp = std::max(std::exp2(std::floor(std::log2(want)) - 23), 0x1p-149);
      worst = std::max(worst, std::abs(static_cast<double>(out.at(i, 0)) - want) / ulp);
    }
  }
  EXPECT_LT(worst, 1.1);
  EXPECT_GT(worst, 0.9);  // the bound is no guess
}

TEST(Transmittance, EndsAreZeroOneInfinityAndNan) {
  const float cases[][3] = {{2, 0, 1},           {2, -0.0F, 1},     {2, 1e30F, 0},
                            {2, kInf, 0},        {kInf, 1, 0},      {kInf, -1, kInf},
                            {kInf, 0, kNan},     {0, kInf, kNan},   {kNan, 0, kNan},
                            {0, kNan, kNan},     {-1e30F, 1, kInf}, {kMost, kMost, 0},
                            {1e-45F, 1e-45F, 1}, {150, 1, 0},       {kMost, 1e-45F, std::exp(-0.47683713F)},
                            {-kInf, -kInf, 0}};
  constexpr std::size_t kCases = std::size(cases);
  auto sigma = *SampledSpectra::create(*Bands::uniform(400, 700, 300), kCases);
  auto distance = *ScalarLanes::create(kCases);
  for (std::size_t i = 0; i < kCases; ++i) {
    sigma.at(i, 0) = cases[i][0];
    distance[i] = cases[i][1];
  }
  ASSERT_TRUE(transmittance(sigma.view(), distance.view(), sigma.span()));
  for (std::size_t i = 0; i < kCases; ++i) {
    if (std::isnan(cases[i][2])) {
      EXPECT_TRUE(std::isnan(sigma.at(i, 0))) << i;
    } else if (i == 14) {
      EXPECT_NEAR(sigma.at(i, 0), std::exp(-static_cast<double>(kMost) * 0x1p-149), 1e-7);
    } else {
      EXPECT_EQ(sigma.at(i, 0), cases[i][2]) << i;
    }
  }
}

TEST(SampledSpectraRange, IsAPartOfTheBatchAndWritesThere) {
  Operands o(200);
  const SampledSpectra before = *o.a.clone();
  // The second and third block: 64 to 191.
  ASSERT_TRUE(complement(o.a.view().range(64, 128), o.out.span().range(64, 128)));
  for (std::size_t lane = 0; lane < 200; ++lane) {
    for (std::size_t band = 0; band < 5; ++band) {
      const float want = lane >= 64 && lane < 192 ? 1 - o.a.at(lane, band) : 0.0F;
      const float got = o.out.at(lane, band);
      ASSERT_TRUE(got == want || (std::isnan(got) && std::isnan(want))) << lane;
      EXPECT_EQ(std::bit_cast<std::uint32_t>(before.at(lane, band)),
                std::bit_cast<std::uint32_t>(o.a.at(lane, band)));
    }
  }
  // The rest, whose last block is padded.
  EXPECT_TRUE(complement(o.a.view().range(128, 72), o.out.span().range(128, 72)));
  EXPECT_EQ(o.a.view().range(64, 128).at(3, 2), o.a.at(67, 2));
}

TEST(SampledSpectraClone, IsAnotherBatchWithTheSameSamples) {
  auto a = *SampledSpectra::constant(*Bands::uniform(400, 700, 100), 70, 0.25F);
  const auto copy = *a.clone();
  EXPECT_EQ(copy.lanes(), 70U);
  EXPECT_EQ(copy.axis(), a.axis());
  EXPECT_TRUE(*equal(a.view(), copy.view()));
  a.at(69, 2) = 1;
  EXPECT_EQ(copy.at(69, 2), 0.25F);
}

}  // namespace
}  // namespace spectile::test
