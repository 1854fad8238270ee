// Lanes by index, sums with a factor a lane, ranges of views, and termination of some lanes.
#include <gmock/gmock.h>

#include <spectile/lanes/arithmetic.hpp>
#include <spectile/lanes/wavelengths.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using testing::HasSubstr;

SampledSpectra numbered(std::size_t lanes, std::size_t samples) {
  SampledSpectra out = own_batch(lanes, samples);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < samples; ++k) out.at(i, k) = static_cast<float>(100 * i + k);
  }
  return out;
}

TEST(GatherLanes, EachLaneIsTheOneOfItsIndex) {
  const SampledSpectra from = numbered(200, 3);
  for (const std::size_t n : {1, 63, 64, 65, 500}) {
    std::vector<std::uint32_t> lanes;
    for (std::size_t i = 0; i < n; ++i) lanes.push_back(static_cast<std::uint32_t>(i * 37 % 200));
    SampledSpectra out = own_batch(n, 3);
    ASSERT_TRUE(gather_lanes(from, lanes, out, {3, 64}));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(out.at(i, k), from.at(lanes[i], k)) << i;
    }
  }
}

TEST(GatherLanes, WhatIsNoLaneIsRefused) {
  SampledSpectra from = numbered(70, 2);
  SampledSpectra out = own_batch(2, 2);
  SampledSpectra three = own_batch(2, 3);
  const std::vector<std::uint32_t> good = {0, 69};
  const std::vector<std::uint32_t> bad = {0, 70};
  const auto refused = gather_lanes(from, bad, out);
  ASSERT_EQ(code_of(refused), code(ErrorCode::kBadArgument));
  EXPECT_THAT(refused.error().message, HasSubstr("lane 1 of 2 is to come from lane 70 of a batch of 70"));
  EXPECT_EQ(code_of(gather_lanes(from, good, three)), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(gather_lanes(from, std::vector<std::uint32_t>{1}, out)), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(gather_lanes(from, good, from.span().range(0, 2))), code(ErrorCode::kBadArgument));
  EXPECT_TRUE(gather_lanes(from, good, out));
}

TEST(MultiplyAdd, TakesALanesOwnFactor) {
  const SampledSpectra a = numbered(130, 2);
  SampledSpectra sum = numbered(130, 2);
  auto factor = *ScalarLanes::create(130);
  for (std::size_t i = 0; i < 130; ++i) factor[i] = static_cast<float>(i) / 64;
  ASSERT_TRUE(multiply_add(a, factor, sum, sum));
  for (std::size_t i = 0; i < 130; ++i) {
    for (std::size_t k = 0; k < 2; ++k) ASSERT_EQ(sum.at(i, k), a.at(i, k) * factor[i] + a.at(i, k));
  }
  auto few = *ScalarLanes::create(129);
  EXPECT_EQ(code_of(multiply_add(a, few, sum, sum)), code(ErrorCode::kSizeMismatch));
}

TEST(Views, ARangeIsThatPartOfTheLanes) {
  auto scalars = *ScalarLanes::create(200);
  auto colors = *ColorLanes::create(200);
  for (std::size_t i = 0; i < 200; ++i) scalars[i] = colors.at(i, 2) = static_cast<float>(i);
  EXPECT_EQ(scalars.view().range(64, 100).values()[5], 69);
  EXPECT_EQ(scalars.view().range(64, 100).lanes, 100U);
  EXPECT_EQ(scalars.span().range(128, 72).data[1], 129);
  EXPECT_EQ(colors.view().range(64, 64).c[2][3], 67);
  EXPECT_EQ(colors.span().range(64, 64).c[2][4], 68);
}

TEST(TerminateSecondary, TouchesTheLanesOfTheMaskAlone) {
  auto w = *SampledWavelengths::create(200, 4);
  for (std::size_t i = 0; i < 200; ++i) {
    for (std::size_t k = 0; k < 4; ++k) w.density.at(i, k) = 0.5F;
  }
  LaneMask mask(4);
  for (const std::size_t i : {0, 63, 64, 130, 199}) mask[i / 64] |= std::uint64_t{1} << (i % 64);
  mask[3] |= ~std::uint64_t{0} << 8;  // padding
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(terminate_secondary(w, mask));
    for (std::size_t i = 0; i < 200; ++i) {
      const bool hit = i == 0 || i == 63 || i == 64 || i == 130 || i == 199;
      ASSERT_EQ(w.density.at(i, 0), hit ? 0.125F : 0.5F) << i;
      ASSERT_EQ(w.density.at(i, 3), hit ? 0 : 0.5F) << i;
    }
  }
  // A part of the lanes.
  ASSERT_TRUE(terminate_secondary(w.span().range(64, 64)));
  EXPECT_EQ(w.density.at(65, 0), 0.125F);
  EXPECT_EQ(w.density.at(62, 0), 0.5F);
  EXPECT_EQ(w.density.at(128, 0), 0.5F);
}

TEST(SampleWavelengths, DrawsForAPartOfTheLanes) {
  auto w = *SampledWavelengths::create(200, 2);
  auto u = *ScalarLanes::create(200);
  for (std::size_t i = 0; i < 200; ++i) u[i] = 0.25F;
  ASSERT_TRUE(
      sample_wavelengths(WavelengthSampling::kUniform, u.view().range(64, 64), w.span().range(64, 64)));
  EXPECT_EQ(w.lambda_nm.at(63, 0), 0);
  EXPECT_GT(w.lambda_nm.at(64, 0), 400);
  EXPECT_GT(w.lambda_nm.at(127, 1), 400);
  EXPECT_EQ(w.lambda_nm.at(128, 0), 0);
}

}  // namespace
}  // namespace spectile::test
