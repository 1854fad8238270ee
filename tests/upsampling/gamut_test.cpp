// Limiting colours to those that a method can make: colours inside stay, those outside move along the line to
// their grey, no further than they must, and are counted.
#include <gmock/gmock.h>

#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

using Triple = std::array<double, 3>;

Upsampler upsampler_of(Method method, Quantity quantity = Quantity::kReflectance) {
  return *Upsampler::create(method, quantity, Bands());
}

constexpr Method kMixing[] = {Method::kSmits, Method::kSmits1999, Method::kSmitsExact, Method::kMallett};

ColorLanes copy_of(const ColorLanes& rgb) {
  auto out = *ColorLanes::create(rgb.lanes());
  for (std::size_t i = 0; i < 3 * rgb.lanes(); ++i) out.at(i / 3, i % 3) = rgb.at(i / 3, i % 3);
  return out;
}

GamutReport limit(const Upsampler& upsampler, ColorLanes& rgb, GamutPolicy policy = GamutPolicy::kClip,
                  const Execution& execution = {}) {
  const auto report = gamut_clip(upsampler, rgb.span(), policy, execution);
  EXPECT_TRUE(report);
  return report ? *report : GamutReport{};
}

bool has_negative(const ColorLanes& rgb, std::size_t i) {
  return rgb.at(i, 0) < 0 || rgb.at(i, 1) < 0 || rgb.at(i, 2) < 0;
}

bool same_color(const ColorLanes& a, const ColorLanes& b, std::size_t i) {
  return same_bits(a.at(i, 0), b.at(i, 0)) && same_bits(a.at(i, 1), b.at(i, 1)) &&
         same_bits(a.at(i, 2), b.at(i, 2));
}

double luminance_of(const Upsampler& upsampler, const ColorLanes& rgb, std::size_t i) {
  double y = 0;
  for (std::size_t k = 0; k < 3; ++k) y += static_cast<double>(upsampler.luminance()[k]) * rgb.at(i, k);
  return y;
}

/// How far along from the grey of luminance y to the colour it was a colour has come; that it is on that line
/// is expected.
double part_of_distance(const ColorLanes& before, const ColorLanes& after, std::size_t i, double y) {
  double along = 0;
  double length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    along += (after.at(i, k) - y) * (before.at(i, k) - y);
    length += (before.at(i, k) - y) * (before.at(i, k) - y);
  }
  const double part = along / length;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(after.at(i, k), y + part * (before.at(i, k) - y), 1e-6 * (1 + std::sqrt(length)))
        << "lane " << i;
  }
  return part;
}

TEST(Gamut, MixturesOfBasesTakeEveryColourWithoutANegativeComponent) {
  for (const Method method : kMixing) {
    const auto upsampler = upsampler_of(method);
    const auto before = lanes_of({{0, 0, 0},
                                  {1, 1, 1},
                                  {-0.0F, 0.5F, 1},
                                  {2, 0.1F, 0},
                                  {1e30F, 0, kTiny},
                                  {7, 7, 7},
                                  {0.25F, 0.5F, 0.75F},
                                  {kInf, 1, 0},
                                  {kNan, 0.5F, 2}});
    auto rgb = copy_of(before);
    const auto report = limit(upsampler, rgb);
    EXPECT_EQ(report.outside, 0U);
    EXPECT_EQ(report.first, -1);
    for (std::size_t i = 0; i < rgb.lanes(); ++i) EXPECT_TRUE(same_color(rgb, before, i)) << i;
  }
}

TEST(Gamut, ColoursOutsideKeepLuminanceAndDominantWavelength) {
  for (const Method method : kMixing) {
    const auto upsampler = upsampler_of(method);
    const auto before = random_colors(4099, 1, -0.4F, 1.6F);
    auto rgb = copy_of(before);
    const auto report = limit(upsampler, rgb);
    std::size_t outside = 0;
    for (std::size_t i = 0; i < rgb.lanes(); ++i) {
      if (!has_negative(before, i)) {
        ASSERT_TRUE(same_color(rgb, before, i)) << i;
        continue;
      }
      ASSERT_TRUE(outside > 0 || report.first == static_cast<std::int64_t>(i)) << i;
      ++outside;
      ASSERT_FALSE(has_negative(rgb, i)) << i;
      const double y = std::max(0.0, luminance_of(upsampler, before, i));
      ASSERT_NEAR(luminance_of(upsampler, rgb, i), y, 1e-6) << i;
      const double part = part_of_distance(before, rgb, i, y);
      ASSERT_TRUE(part >= -1e-6 && part <= 1) << i << " " << part;
      // A little further out is outside: the component that was lowest has just reached 0.
      double least = INFINITY;
      for (std::size_t k = 0; k < 3; ++k) {
        least = std::min(least, y + (part + 1e-5) * (before.at(i, k) - y));
      }
      ASSERT_LT(least, 0) << i;
    }
    EXPECT_EQ(report.outside, outside);
    EXPECT_GT(outside, 1000U);
    auto again = copy_of(rgb);
    EXPECT_EQ(limit(upsampler, again).outside, 0U);
  }
}

TEST(Gamut, ColoursBelowBlackBecomeBlack) {
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
    const auto upsampler = upsampler_of(Method::kSmitsExact, quantity);
    auto rgb = lanes_of({{-1, -2, -3}, {0.5F, -1, 0}, {-kTiny, -kTiny, -kTiny}, {-1e30F, 0, 0}});
    EXPECT_EQ(limit(upsampler, rgb).outside, 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(rgb.at(i, k), 0) << i;
    }
  }
}

TEST(Gamut, KeepingCountsAndChangesNothing) {
  for (const Method method : {Method::kSmits, Method::kSmitsExact, Method::kSigmoid, Method::kSigmoidObserver,
                              Method::kTetrahedral}) {
    const auto upsampler = upsampler_of(method);
    const auto before = random_colors(257, 2, -0.5F, 1.5F);
    auto kept = copy_of(before);
    auto clipped = copy_of(before);
    const auto report = limit(upsampler, kept, GamutPolicy::kKeep);
    const auto other = limit(upsampler, clipped);
    EXPECT_GT(report.outside, 50U);
    EXPECT_EQ(report.outside, other.outside);
    EXPECT_EQ(report.first, other.first);
    for (std::size_t i = 0; i < before.lanes(); ++i) ASSERT_TRUE(same_color(kept, before, i)) << i;
  }
}

TEST(Gamut, ResultsDependNeitherOnThreadsNorOnTiles) {
  for (const Method method :
       {Method::kSmitsExact, Method::kSigmoid, Method::kSigmoidObserver, Method::kTetrahedral}) {
    const auto upsampler = upsampler_of(method);
    // Few lanes outside, the first of them late.
    auto before = random_colors(4099, 3);
    for (const std::size_t i : {777U, 778U, 1500U, 4098U}) before.at(i, i % 3) = -0.7F;
    auto want = copy_of(before);
    const auto report = limit(upsampler, want, GamutPolicy::kClip, {1, 1U << 20U});
    EXPECT_EQ(report.outside, 4U);
    EXPECT_EQ(report.first, 777);
    for (const int threads : {1, 3}) {
      for (const std::size_t tile : {1, 100, 1024, 100000}) {
        auto rgb = copy_of(before);
        const auto got = limit(upsampler, rgb, GamutPolicy::kClip, {threads, tile});
        EXPECT_EQ(got.outside, report.outside);
        EXPECT_EQ(got.first, report.first);
        for (std::size_t i = 0; i < rgb.lanes(); ++i)
          ASSERT_TRUE(same_color(rgb, want, i)) << i << " " << tile;
      }
    }
  }
}

TEST(Gamut, TheCubeIsInsideForTheSigmoid) {
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
    const auto upsampler = upsampler_of(Method::kSigmoid, quantity);
    const auto before = cube_grid(9);
    auto rgb = copy_of(before);
    EXPECT_EQ(limit(upsampler, rgb).outside, 0U);
    for (std::size_t i = 0; i < rgb.lanes(); ++i) ASSERT_TRUE(same_color(rgb, before, i)) << i;
  }
}

TEST(Gamut, TheSigmoidTakesMoreThanTheCube) {
  // Colours of spectra that are sigmoids, with components below 0 or above 1.
  const auto upsampler = upsampler_of(Method::kSigmoid);
  const auto before = lanes_of({{0.0501474738F, -0.0401260369F, 0.44631061F}, {0.95F, 1.0399F, 0.5540F}});
  ASSERT_LT(round_trip(upsampler, before).rgb, 1e-6);
  auto rgb = copy_of(before);
  EXPECT_EQ(limit(upsampler, rgb).outside, 0U);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) EXPECT_TRUE(same_color(rgb, before, i)) << i;
}

TEST(Gamut, TheSigmoidsBoundaryIsReachedFromInside) {
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded}) {
    const auto upsampler = upsampler_of(Method::kSigmoid, quantity);
    const float highest = quantity == Quantity::kReflectance ? 1.5F : 1.0F;
    const auto before = random_colors(513, 4, -0.5F, highest);
    auto rgb = copy_of(before);
    auto further = copy_of(before);
    const auto report = limit(upsampler, rgb);
    EXPECT_GT(report.outside, 100U);
    std::vector<bool> moved(rgb.lanes());
    for (std::size_t i = 0; i < rgb.lanes(); ++i) {
      moved[i] = !same_color(rgb, before, i);
      if (!moved[i]) continue;
      const double y = luminance_of(upsampler, before, i);
      if (y < 0 || (y > 1 && quantity == Quantity::kReflectance)) {
        moved[i] = false;  // another test's
        continue;
      }
      ASSERT_NEAR(luminance_of(upsampler, rgb, i), y, 1e-6) << i;
      const double part = part_of_distance(before, rgb, i, y);
      ASSERT_TRUE(part >= -1e-6 && part < 1) << i << " " << part;
      for (std::size_t k = 0; k < 3; ++k) {
        further.at(i, k) = static_cast<float>(y + (part + 0x1p-7) * (before.at(i, k) - y));
      }
    }
    auto c = *CoefficientLanes::create(upsampler, rgb.lanes());
    ASSERT_TRUE(coefficients(upsampler, rgb.view(), c));
    EXPECT_EQ(c.unsolved.outside, 0U);
    EXPECT_EQ(limit(upsampler, rgb).outside, 0U);
    // Whatever was moved would be outside a little further out, but for a few on which rounding decides.
    std::vector<Rgb> beyond;
    for (std::size_t i = 0; i < rgb.lanes(); ++i) {
      if (moved[i]) beyond.push_back({further.at(i, 0), further.at(i, 1), further.at(i, 2)});
    }
    auto outside = lanes_of(beyond);
    EXPECT_GE(limit(upsampler, outside).outside, beyond.size() * 95 / 100);
  }
}

TEST(Gamut, LimitedColoursReturnFromTheirSigmoids) {
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded}) {
    const auto upsampler = upsampler_of(Method::kSigmoid, quantity);
    auto rgb = random_colors(3000, 7, -0.5F, 1.5F);
    limit(upsampler, rgb);
    // Within 1e-5 of the largest component, which a light's scale is twice.
    EXPECT_LE(round_trip(upsampler, rgb).rgb, quantity == Quantity::kReflectance ? 2e-5 : 4e-5);
  }
}

TEST(Gamut, MoreThanWhiteBecomesWhiteAndLessThanBlackBlack) {
  const auto upsampler = upsampler_of(Method::kSigmoid);
  auto rgb = lanes_of({{2, 2, 2}, {-1, -1, -1}, {1.02F, 1.02F, 1.02F}, {3, 1, 2}});
  EXPECT_EQ(limit(upsampler, rgb).outside, 4U);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(rgb.at(i, k), i == 1 ? 0 : 1, 2e-5) << i;
  }
}

TEST(Gamut, LimitedColoursOfUnboundedSigmoidsScaleWithTheLight) {
  const auto upsampler = upsampler_of(Method::kSigmoid, Quantity::kIlluminant);
  auto one = random_colors(65, 5, -0.3F, 1.0F);
  auto many = copy_of(one);
  for (std::size_t i = 0; i < 3 * many.lanes(); ++i) many.at(i / 3, i % 3) *= 0x1p20F;
  EXPECT_EQ(limit(upsampler, many).outside, limit(upsampler, one).outside);
  for (std::size_t i = 0; i < 3 * many.lanes(); ++i)
    ASSERT_EQ(many.at(i / 3, i % 3), 0x1p20F * one.at(i / 3, i % 3));
}

TEST(Gamut, WhatIsNotFiniteStays) {
  const Rgb colors[] = {{kNan, 0.5F, 0.5F}, {-1, kNan, 0.5F},    {2, 2, kNan},   {kInf, 0, 0},
                        {-kInf, -1, 0.5F},  {-1, kInf, 2},       {-1, kNan, -1}, {kNan, -1, 0.5F},
                        {-1, -kInf, -1},    {-kInf, 0.5F, 0.5F}, {kInf, -1, 0},  {kNan, kNan, kNan}};
  for (const Method method : {Method::kSmitsExact, Method::kMallett, Method::kSigmoid,
                              Method::kSigmoidObserver, Method::kTetrahedral}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded}) {
      const auto upsampler = upsampler_of(method, quantity);
      const auto before = lanes_of(colors);
      auto rgb = copy_of(before);
      EXPECT_EQ(limit(upsampler, rgb).outside, 0U);
      for (std::size_t i = 0; i < rgb.lanes(); ++i) {
        EXPECT_TRUE(same_color(rgb, before, i)) << to_string(method) << " lane " << i;
      }
    }
  }
}

TEST(Gamut, WhereTheColoursMoveDoesNotDependOnTheBands) {
  const auto before = random_colors(257, 8, -0.4F, 1.0F);
  auto rgb = copy_of(before);
  limit(upsampler_of(Method::kSmitsExact), rgb);
  for (const char* bands : {"380:780:5", "360:830:1", "400:700:10"}) {
    auto other = copy_of(before);
    limit(*Upsampler::create(Method::kMallett, Quantity::kReflectance, *Bands::parse(bands)), other);
    for (std::size_t i = 0; i < rgb.lanes(); ++i) ASSERT_TRUE(same_color(rgb, other, i)) << bands << i;
  }
}

TEST(Gamut, SamplesThatAreNotAlignedAreAnError) {
  const auto upsampler = upsampler_of(Method::kSmits);
  auto rgb = random_colors(128, 6);
  ColorSpan span = rgb.span();
  span.c[1] += 1;
  span.lanes = 64;
  EXPECT_EQ(code_of(gamut_clip(upsampler, span)), code(ErrorCode::kBadArgument));
}

TEST(Gamut, AnErrorCountsTheColoursOutsideAndLeavesTheBatch) {
  for (const Method method : {Method::kSmits, Method::kSigmoid}) {
    const auto upsampler = upsampler_of(method);
    auto rgb = lanes_of({{0.5F, 0.5F, 0.5F}, {-2, 1, 0}, {-2, 0.5F, 0}});
    const auto before = copy_of(rgb);
    const auto report = gamut_clip(upsampler, rgb.span(), GamutPolicy::kError);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().message, "2 colours of the batch are out of gamut, the first in lane 1");
    for (std::size_t i = 0; i < rgb.lanes(); ++i) EXPECT_TRUE(same_color(rgb, before, i)) << i;
    auto inside = lanes_of({{0.5F, 0.5F, 0.5F}});
    EXPECT_TRUE(gamut_clip(upsampler, inside.span(), GamutPolicy::kError));
  }
}

}  // namespace
}  // namespace spectile::test
