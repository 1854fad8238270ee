// CIELAB against its definition and published colours, at its joint, and for numbers that are none.
#include <gmock/gmock.h>

#include <numbers>
#include <spectile/color/color_difference.hpp>
#include <spectile/color/colorimetry.hpp>

#include "tests/color/white.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

void expect_lab(const Lab& got, const Lab& want, double tolerance) {
  EXPECT_NEAR(got.l, want.l, tolerance);
  EXPECT_NEAR(got.a, want.a, tolerance);
  EXPECT_NEAR(got.b, want.b, tolerance);
}

TEST(Lab, OfWhiteIsHundredAndOfBlackZero) {
  for (const std::array<double, 3>& white : {kWhite, {95.047, 100, 108.883}, {1e-3, 1e-3, 1e-3}}) {
    expect_lab(xyz_to_lab(white, white), {100, 0, 0}, 0);
    expect_lab(xyz_to_lab({0, 0, 0}, white), {0, 0, 0}, 0);
  }
}

TEST(Lab, OfCubesIsWhatTheDefinitionSays) {
  // Ratios 0.8^3, 0.7^3, 0.6^3: L* = 116 x 0.7 - 16, a* = 500 x 0.1, b* = 200 x 0.1.
  const std::array<double, 3> xyz = {0.512 * kWhite[0], 0.343 * kWhite[1], 0.216 * kWhite[2]};
  expect_lab(xyz_to_lab(xyz, kWhite), {65.2, 50, 20}, 1e-12);
}

TEST(Lab, OfTheSrgbPrimariesIsTheCommonlyQuoted) {
  const Lab want[3] = {{53.24, 80.09, 67.20}, {87.73, -86.18, 83.18}, {32.30, 79.19, -107.86}};
  const Matrix3& m = srgb_to_xyz_matrix();
  for (std::size_t k = 0; k < 3; ++k) {
    expect_lab(xyz_to_lab({m[k], m[3 + k], m[6 + k]}, kWhite), want[k], 0.02);
  }
}

TEST(Lab, IsStraightBelowTheJointAndContinuousThere) {
  constexpr double kJoint = 216.0 / 24389.0;
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<double, 3> below = {0.2, 0.2, 0.2};
    std::array<double, 3> beyond = below;
    below[k] = kJoint;
    beyond[k] = std::nextafter(kJoint, 1.0);
    // a* magnifies the roundings of a value near 1 by 500.
    expect_lab(xyz_to_lab(below, {1, 1, 1}), xyz_to_lab(beyond, {1, 1, 1}), 1e-12);
  }
  EXPECT_NEAR(xyz_to_lab({0, kJoint, 0}, {1, 1, 1}).l, 8, 1e-14);
  EXPECT_NEAR(xyz_to_lab({0, 0.00887, 0}, {1, 1, 1}).l, 116 * std::cbrt(0.00887) - 16, 1e-13);
  EXPECT_NEAR(xyz_to_lab({0.00887, 0, 0}, {1, 1, 1}).a, 500 * (std::cbrt(0.00887) - 16.0 / 116), 1e-12);
  for (const double y : {0.008, 1e-5, 1e-300, -1e-5, -0.5, -7.0}) {
    const double slope = 24389.0 / 27.0 * y;
    expect_lab(xyz_to_lab({y, y, y}, {1, 1, 1}), {slope, 0, 0}, 1e-15 * std::abs(slope));
    expect_lab(xyz_to_lab({y, 0, 0}, {1, 1, 1}), {0, 500 * slope / 116, 0}, 1e-12 * (1 + std::abs(y)));
    expect_lab(xyz_to_lab({0, 0, y}, {1, 1, 1}), {0, 0, -200 * slope / 116}, 1e-12 * (1 + std::abs(y)));
  }
}

TEST(Lab, LetsNanAndInfinitiesThrough) {
  EXPECT_TRUE(std::isnan(xyz_to_lab({0.5, kNan, 0.5}, kWhite).l));
  EXPECT_TRUE(std::isnan(xyz_to_lab({kNan, 0.5, 0.5}, kWhite).a));
  EXPECT_TRUE(std::isnan(xyz_to_lab({0.5, 0.5, kNan}, kWhite).b));
  EXPECT_EQ(xyz_to_lab({0.5, kInf, 0.5}, kWhite).l, kInf);
  EXPECT_EQ(xyz_to_lab({0.5, -kInf, 0.5}, kWhite).l, -kInf);
  EXPECT_EQ(xyz_to_lab({0.5, kInf, 0.5}, kWhite).a, -kInf);
  EXPECT_EQ(xyz_to_lab({0.5, 0.5, 0.5}, {1, 0, 1}).l, kInf);
  EXPECT_TRUE(std::isnan(xyz_to_lab({0.5, 0, 0.5}, {1, 0, 1}).l));
}

}  // namespace
}  // namespace spectile::test
