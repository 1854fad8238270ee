// Vectors, spherical coordinates, frames and solid angles: identities, limits and special values.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>
#include <spectile/radiometry/directions.hpp>
#include <vector>

#include "tests/radiometry/drawn_numbers.hpp"

namespace spectile::test {
namespace {

using std::numbers::pi;
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kLeast = std::numeric_limits<double>::denorm_min();

/// Any direction, poles and axes among them.
Vector3 any_direction() {
  const int kind = *rc::gen::inRange(0, 8);
  if (kind == 0)
    return *rc::gen::element(Vector3{0, 0, 1}, Vector3{0, 0, -1}, Vector3{1, 0, 0}, Vector3{0, -1, 0});
  const double z = kind == 1 ? (between(-1, 1) < 0 ? -1 + 1e-12 : 1 - 1e-12) : between(-1, 1);
  const double phi = between(0, 2 * pi);
  return spherical_direction(std::sqrt((1 - z) * (1 + z)), z, phi);
}

/// Girard's theorem: the sum of the angles at the corners, less pi.
double girard(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto angle_at = [](const Vector3& p, const Vector3& q, const Vector3& r) {
    return angle_between(cross(p, q), cross(p, r));
  };
  return angle_at(a, b, c) + angle_at(b, c, a) + angle_at(c, a, b) - pi;
}

TEST(Vectors, NormalizeAtAnyScale) {
  for (const double s : {kLeast, 1e-300, 1e-160, 1.0, 1e160, kLargest}) {
    const Vector3 v = normalized({s, -s, s});
    EXPECT_NEAR(length(v), 1, 4e-16) << s;
    EXPECT_NEAR(v.x, 1 / std::sqrt(3.0), 4e-16) << s;
    EXPECT_EQ(v.y, -v.x);
  }
  EXPECT_EQ(normalized({}), Vector3{});
  EXPECT_TRUE(std::isnan(normalized({1, kNotANumber, 0}).x));
  EXPECT_TRUE(std::isnan(normalized({0, kInfinity, 0}).x));
}

TEST(Vectors, AnglesKeepTheirDigitsNearZeroAndPi) {
  EXPECT_NEAR(angle_between({1, 0, 0}, {1, 1e-9, 0}), 1e-9, 1e-24);
  EXPECT_NEAR(pi - angle_between({1, 0, 0}, {-1, 1e-6, 0}), 1e-6, 1e-15);
  EXPECT_NEAR(angle_between({2, 0, 0}, {0, 1e200, 0}), pi / 2, 1e-15);
  EXPECT_EQ(angle_between({}, {1, 0, 0}), 0);
}

TEST(Spherical, CoordinatesAtThePolesAndTheSeam) {
  EXPECT_EQ(spherical_theta({0, 0, 3}), 0);
  EXPECT_EQ(spherical_theta({0, 0, -3}), pi);
  EXPECT_EQ(spherical_theta({}), 0);
  EXPECT_EQ(spherical_phi({0, 0, 1}), 0);
  EXPECT_EQ(spherical_phi({-0.0, -0.0, -1}), 0);
  EXPECT_EQ(spherical_phi({}), 0);
  EXPECT_EQ(spherical_phi({1, 0, 0}), 0);
  EXPECT_EQ(spherical_phi({0, 1, 0}), pi / 2);
  EXPECT_EQ(spherical_phi({-1, 0, 0}), pi);
  EXPECT_EQ(spherical_phi({-1, -0.0, 0}), pi);
  EXPECT_NEAR(spherical_phi({0, -1, 0}), 1.5 * pi, 1e-15);
  EXPECT_EQ(spherical_phi({1, -1e-20, 0}), 0);
  EXPECT_LT(spherical_phi({1, -1e-15, 0}), 2 * pi);
  EXPECT_NEAR(spherical_theta({1e-12, 0, 1}), 1e-12, 1e-27);
  EXPECT_TRUE(std::isnan(spherical_phi({kNotANumber, 1, 0})));
  EXPECT_TRUE(std::isnan(spherical_theta({0, 0, kNotANumber})));
}

TEST(Spherical, DirectionLimitsSineAndCosine) {
  EXPECT_EQ(spherical_direction(0, 1.5, 1), (Vector3{0, 0, 1}));
  EXPECT_EQ(spherical_direction(2, 0, 0), (Vector3{1, 0, 0}));
  EXPECT_TRUE(std::isnan(spherical_direction(0, kNotANumber, 0).z));
}

TEST(Spherical, CosinesAndSinesOfTheLocalFrame) {
  const Vector3 w = spherical_direction(std::sin(0.4), std::cos(0.4), 2.5);
  EXPECT_NEAR(cos_theta(w), std::cos(0.4), 1e-15);
  EXPECT_NEAR(sin_theta(w), std::sin(0.4), 1e-15);
  EXPECT_NEAR(tan_theta(w), std::tan(0.4), 1e-15);
  EXPECT_NEAR(tan2_theta(w), std::tan(0.4) * std::tan(0.4), 1e-15);
  EXPECT_NEAR(cos2_theta(w) + sin2_theta(w), 1, 1e-15);
  EXPECT_NEAR(cos_phi(w), std::cos(2.5), 1e-15);
  EXPECT_NEAR(sin_phi(w), std::sin(2.5), 1e-15);
  EXPECT_EQ(abs_cos_theta({0, 0, -0.5}), 0.5);
  EXPECT_TRUE(same_hemisphere(w, {0, 0, 1}));
  EXPECT_FALSE(same_hemisphere(w, {1, 0, 0}));
  const Vector3 v = spherical_direction(std::sin(1.1), std::cos(1.1), 2.5 - 0.7);
  EXPECT_NEAR(cos_phi_difference(w, v), std::cos(0.7), 1e-15);
  for (const Vector3 pole : {Vector3{0, 0, 1}, Vector3{0, 0, -1}, Vector3{}}) {
    EXPECT_EQ(cos_phi(pole), 1);
    EXPECT_EQ(sin_phi(pole), 0);
    EXPECT_EQ(cos_phi_difference(pole, w), 1);
  }
  EXPECT_EQ(tan_theta({1, 0, 0}), kInfinity);
  EXPECT_TRUE(std::isnan(tan_theta({})));
}

RC_GTEST_PROP(Spherical, CoordinatesGiveTheDirectionBack, ()) {
  const Vector3 w = any_direction();
  const double scale = std::exp2(between(-500, 500));
  const double theta = spherical_theta(scale * w);
  const double phi = spherical_phi(scale * w);
  RC_ASSERT(theta >= 0 && theta <= pi && phi >= 0 && phi < 2 * pi);
  RC_ASSERT(length(spherical_direction(std::sin(theta), std::cos(theta), phi) - w) < 1e-15);
}

RC_GTEST_PROP(Frames, AreOrthonormalAndRightHanded, ()) {
  const Vector3 z = normalized(any_direction());
  const Frame f = Frame::from_z(z);
  RC_ASSERT(std::abs(length(f.x) - 1) < 1e-15 && std::abs(length(f.y) - 1) < 1e-15);
  RC_ASSERT(std::abs(dot(f.x, f.y)) < 1e-15 && std::abs(dot(f.x, z)) < 1e-15);
  RC_ASSERT(std::abs(dot(f.y, z)) < 1e-15);
  RC_ASSERT(length(cross(f.x, f.y) - z) < 2e-15);
  const Vector3 v = {between(-3, 3), between(-3, 3), between(-3, 3)};
  RC_ASSERT(length(f.from_local(f.to_local(v)) - v) < 1e-14);
  RC_ASSERT(std::abs(f.to_local(v).z - dot(v, z)) < 1e-15);
}

TEST(Frames, AtBothPoles) {
  const Frame up = Frame::from_z({0, 0, 1});
  EXPECT_EQ(up.x, (Vector3{1, 0, 0}));
  EXPECT_EQ(up.y, (Vector3{0, 1, 0}));
  const Frame down = Frame::from_z({0, 0, -1});
  EXPECT_EQ(cross(down.x, down.y), (Vector3{0, 0, -1}));
}

TEST(SolidAngle, OfCones) {
  EXPECT_EQ(solid_angle_of_cone(0), 0);
  EXPECT_NEAR(solid_angle_of_cone(pi / 2), 2 * pi, 1e-15);
  EXPECT_NEAR(solid_angle_of_cone(pi), kSphereSolidAngle, 1e-15);
  EXPECT_NEAR(solid_angle_of_cone(pi / 3), pi, 1e-15);
  // A narrow one is a plane disk, of which 1 - cos would keep nothing.
  EXPECT_NEAR(solid_angle_of_cone(1e-9) / (pi * 1e-18), 1, 1e-15);
  EXPECT_EQ(solid_angle_of_cone(-1), 0);
  EXPECT_EQ(solid_angle_of_cone(7), kSphereSolidAngle);
  EXPECT_TRUE(std::isnan(solid_angle_of_cone(kNotANumber)));
}

TEST(SolidAngle, OfRanges) {
  EXPECT_NEAR(solid_angle_of_ranges(0, pi, 0, 2 * pi), kSphereSolidAngle, 2e-15);
  EXPECT_NEAR(solid_angle_of_ranges(0.3, 0.9, 1, 2), std::cos(0.3) - std::cos(0.9), 1e-15);
  EXPECT_EQ(solid_angle_of_ranges(0.9, 0.3, 2, 1), solid_angle_of_ranges(0.3, 0.9, 1, 2));
  EXPECT_NEAR(solid_angle_of_ranges(1, 1 + 1e-9, 0, 1) / (std::sin(1.0) * 1e-9), 1, 1e-6);
}

TEST(SolidAngle, OfTriangles) {
  const Vector3 x = {1, 0, 0};
  const Vector3 y = {0, 1, 0};
  const Vector3 z = {0, 0, 1};
  EXPECT_NEAR(solid_angle_of_triangle(x, y, z), pi / 2, 1e-15);
  EXPECT_NEAR(solid_angle_of_triangle(z, 7 * y, 1e-200 * x), pi / 2, 1e-15);
  EXPECT_EQ(solid_angle_of_triangle(x, x, y), 0);
  EXPECT_EQ(solid_angle_of_triangle({}, x, y), 0);
  EXPECT_EQ(solid_angle_of_triangle(x, {}, y), 0);
  EXPECT_EQ(solid_angle_of_triangle(x, y, {}), 0);
  EXPECT_TRUE(std::isnan(solid_angle_of_triangle(x, y, {0, kNotANumber, 0})));
  // Nearly a hemisphere: corners just above the horizon.
  const double e = 1e-7;
  const Vector3 b = {-0.5, std::sqrt(0.75), e};
  const Vector3 c = {-0.5, -std::sqrt(0.75), e};
  EXPECT_NEAR(solid_angle_of_triangle({1, 0, e}, b, c), 2 * pi, 1e-5);
  // A small one is plane: half base times height.
  EXPECT_NEAR(solid_angle_of_triangle(z, {1e-6, 0, 1}, {0, 1e-6, 1}) / 0.5e-12, 1, 1e-9);
}

RC_GTEST_PROP(SolidAngle, OfTrianglesIsGirardsExcess, ()) {
  const Vector3 a = any_direction();
  const Vector3 b = any_direction();
  const Vector3 c = any_direction();
  RC_PRE(length(cross(a, b)) > 0.1 && length(cross(b, c)) > 0.1 && length(cross(c, a)) > 0.1);
  RC_PRE(std::abs(dot(a, cross(b, c))) > 0.01);
  RC_ASSERT(std::abs(solid_angle_of_triangle(a, b, c) - girard(a, b, c)) < 1e-12);
}

TEST(SolidAngle, OfPolygonsNeedNotBeConvex) {
  // An L of three unit squares at height 2, and its parts.
  const std::array<Vector3, 6> l = {Vector3{0, 0, 2}, {2, 0, 2}, {2, 1, 2}, {1, 1, 2}, {1, 2, 2}, {0, 2, 2}};
  const double parts = solid_angle_of_rectangle(0, 2, 0, 1, 2) + solid_angle_of_rectangle(0, 1, 1, 2, 2);
  for (std::size_t turn = 0; turn < l.size(); ++turn) {
    std::array<Vector3, 6> turned;
    for (std::size_t i = 0; i < l.size(); ++i) turned[i] = l[(i + turn) % l.size()];
    EXPECT_NEAR(solid_angle_of_polygon(turned), parts, 1e-15) << turn;
  }
  EXPECT_EQ(solid_angle_of_polygon(std::span(l).first(2)), 0);
}

TEST(SolidAngle, OfRectangles) {
  // A cube's face from its centre, and a quarter of it from the face's axis.
  EXPECT_NEAR(solid_angle_of_rectangle(-1, 1, -1, 1, 1), 2 * pi / 3, 1e-15);
  EXPECT_NEAR(solid_angle_of_rectangle(0, 1, 0, 1, 1), pi / 6, 1e-15);
  EXPECT_EQ(solid_angle_of_rectangle(1, 0, 1, 0, -1), solid_angle_of_rectangle(0, 1, 0, 1, 1));
  EXPECT_NEAR(solid_angle_of_rectangle(-1, 1, -1, 1, 0), 2 * pi, 1e-15);
  EXPECT_NEAR(solid_angle_of_rectangle(0, 1, -1, 1, 0), pi, 1e-15);
  EXPECT_EQ(solid_angle_of_rectangle(1, 2, 1, 2, 0), 0);
  EXPECT_EQ(solid_angle_of_rectangle(1, 1, 0, 1, 1), 0);
  EXPECT_NEAR(solid_angle_of_rectangle(-1e9, 1e9, -1e9, 1e9, 1), 2 * pi, 1e-8);
}

RC_GTEST_PROP(SolidAngle, OfRectanglesIsThatOfTheirCorners, ()) {
  const double x0 = between(-3, 3);
  const double x1 = between(-3, 3);
  const double y0 = between(-3, 3);
  const double y1 = between(-3, 3);
  const double z = between(0.1, 4);
  const double corners = solid_angle_of_quad({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z});
  RC_ASSERT(std::abs(corners - solid_angle_of_rectangle(x0, x1, y0, y1, z)) < 1e-14);
}

TEST(SolidAngle, OfAPolygonInACircleComesNearTheCone) {
  for (const int n : {100, 1000}) {
    std::vector<Vector3> corners;
    for (int i = 0; i < n; ++i) {
      const double phi = 2 * pi * i / n;
      corners.push_back({std::cos(phi), std::sin(phi), 1});
    }
    // The plane polygon's area is short by 2 pi^2 / (3 n^2), its solid angle by about as much.
    EXPECT_NEAR(solid_angle_of_polygon(corners), solid_angle_of_cone(pi / 4), 10.0 / (n * n));
  }
}

TEST(EqualArea, CornersCentreAndEdges) {
  EXPECT_EQ(equal_area_square_to_sphere(0.5, 0.5), (Vector3{0, 0, 1}));
  for (const double u : {0.0, 1.0}) {
    for (const double v : {0.0, 1.0}) {
      EXPECT_NEAR(length(equal_area_square_to_sphere(u, v) - Vector3{0, 0, -1}), 0, 1e-15);
    }
  }
  EXPECT_NEAR(length(equal_area_square_to_sphere(1, 0.5) - Vector3{1, 0, 0}), 0, 1e-15);
  EXPECT_NEAR(length(equal_area_square_to_sphere(0.5, 0) - Vector3{0, -1, 0}), 0, 1e-15);
  EXPECT_EQ(equal_area_square_to_sphere(-1, 0.5), equal_area_square_to_sphere(0, 0.5));
  EXPECT_EQ(equal_area_sphere_to_square({}), (std::array<double, 2>{0.5, 0.5}));
  EXPECT_EQ(equal_area_sphere_to_square({0, 0, 5}), (std::array<double, 2>{0.5, 0.5}));
}

RC_GTEST_PROP(EqualArea, ThereAndBack, ()) {
  const double u = between(0.001, 0.999);
  const double v = between(0.001, 0.999);
  const Vector3 w = equal_area_square_to_sphere(u, v);
  RC_ASSERT(std::abs(length(w) - 1) < 1e-15);
  const auto back = equal_area_sphere_to_square(w);
  RC_ASSERT(std::abs(back[0] - u) < 1e-13 && std::abs(back[1] - v) < 1e-13);
  const Vector3 any = any_direction();
  const auto point = equal_area_sphere_to_square(any);
  RC_ASSERT(point[0] >= 0 && point[0] <= 1 && point[1] >= 0 && point[1] <= 1);
  RC_ASSERT(length(equal_area_square_to_sphere(point[0], point[1]) - any) < 1e-14);
}

TEST(EqualArea, EveryCellHasTheSameSolidAngle) {
  constexpr int kCells = 64;
  constexpr int kFine = 8;  // each cell's outline in that many pieces a side
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      std::vector<Vector3> outline;
      for (int side = 0; side < 4; ++side) {
        for (int k = 0; k < kFine; ++k) {
          const double t = static_cast<double>(k) / kFine;
          const double du = std::array{t, 1.0, 1 - t, 0.0}[static_cast<std::size_t>(side)];
          const double dv = std::array{0.0, t, 1.0, 1 - t}[static_cast<std::size_t>(side)];
          outline.push_back(equal_area_square_to_sphere((i + du) / kCells, (j + dv) / kCells));
        }
      }
      const double cell = kSphereSolidAngle / (kCells * kCells);
      ASSERT_NEAR(solid_angle_of_polygon(outline) / cell, 1, 0.002) << i << ' ' << j;
    }
  }
}

TEST(Directions, RandomDirectionsInATriangleAreItsShareOfTheSphere) {
  const Vector3 a = {1, 0.2, 0.1};
  const Vector3 b = {-0.3, 1, 0.4};
  const Vector3 c = {0.1, -0.2, 1};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr int kTries = 400000;
  int inside = 0;
  for (int i = 0; i < kTries; ++i) {
    const double u = unit(random);
    const Vector3 w = equal_area_square_to_sphere(u, unit(random));
    inside += dot(w, cross(a, b)) > 0 && dot(w, cross(b, c)) > 0 && dot(w, cross(c, a)) > 0 ? 1 : 0;
  }
  const double share = solid_angle_of_triangle(a, b, c) / kSphereSolidAngle;
  EXPECT_NEAR(static_cast<double>(inside) / kTries, share, 4 * std::sqrt(share / kTries));
}

TEST(SphericalTheta, IsRightForAnyLength) {
  for (const double s : {5e-324, 1.0, 1e200, 1.7e308}) {
    EXPECT_NEAR(spherical_theta({s, s, s}), std::atan(std::numbers::sqrt2), 1e-15) << s;
  }
}

TEST(SolidAngleOfRectangle, IsRightInAnyUnit) {
  for (const double s : {1e-200, 1.0, 1e200}) {
    EXPECT_NEAR(solid_angle_of_rectangle(-s, s, -s, s, s), 2 * std::numbers::pi / 3, 4e-15) << s;
  }
}

}  // namespace
}  // namespace spectile::test
