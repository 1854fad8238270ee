// Projected solid angles: the closed forms against each other, and quadrature over area and over directions
// against them, with errors that fall as they should.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <limits>
#include <numbers>
#include <spectile/radiometry/irradiance.hpp>
#include <type_traits>
#include <vector>

#include "tests/radiometry/drawn_numbers.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using std::numbers::pi;

/// A lamp above a table: facing down, the receiver at the origin facing up.
DiskEmitter disk_above(double height, double radius, double aside = 0) {
  return {{aside, 0, height}, {0, 0, -1}, radius};
}
/// A rectangle facing down.
QuadEmitter rectangle_above(double x0, double x1, double y0, double y1, double height) {
  return {{x0, y0, height}, {0, y1 - y0, 0}, {x1 - x0, 0, 0}};
}
std::vector<Vector3> corners_of(const QuadEmitter& q) {
  return {q.corner_m, q.corner_m + q.edge_u_m, q.corner_m + q.edge_u_m + q.edge_v_m, q.corner_m + q.edge_v_m};
}

const Receiver kTable = {};

TEST(Disk, OnItsAxisIsTheClosedForm) {
  for (const double r : {1e-9, 0.01, 1.0, 3.0, 1e6}) {
    for (const double h : {1e-3, 1.0, 20.0}) {
      const double want = pi * r * r / (r * r + h * h);
      EXPECT_NEAR(projected_solid_angle(disk_above(h, r), kTable)->value() / want, 1, 1e-14) << r << ' ' << h;
    }
  }
}

TEST(Disk, NearTheHorizonsWholeIsPi) {
  EXPECT_NEAR(projected_solid_angle(disk_above(1e-9, 1), kTable)->value(), pi, 1e-15);
  EXPECT_NEAR(projected_solid_angle(disk_above(1, 1e9), kTable)->value(), pi, 1e-14);
}

TEST(Disk, AsideFallsWithTheFourthPowerOfTheCosine) {
  // A small one: area * cos^4 / h^2.
  const double r = 1e-5;
  for (const double angle : {0.0, 0.5, 1.0, 1.4}) {
    const double want = pi * r * r * std::pow(std::cos(angle), 4);
    EXPECT_NEAR(projected_solid_angle(disk_above(1, r, std::tan(angle)), kTable)->value() / want, 1, 1e-9)
        << angle;
  }
}

RC_GTEST_PROP(Disk, AnywhereIsThePolygonOfManySides, ()) {
  const DiskEmitter disk = disk_above(between(0.3, 3), between(0.1, 2), between(0, 3));
  constexpr int kSides = 2000;
  std::vector<Vector3> corners;
  // Of the same area as the disk, so that the error falls with the fourth power of the sides' number.
  const double step = 2 * pi / kSides;
  const double radius = disk.radius_m * std::sqrt(step / std::sin(step));
  for (int i = 0; i < kSides; ++i) {
    corners.push_back(disk.centre_m + Vector3{radius * std::cos(-step * i), radius * std::sin(-step * i), 0});
  }
  const double polygon = projected_solid_angle(corners, kTable)->value();
  RC_ASSERT(std::abs(polygon - projected_solid_angle(disk, kTable)->value()) < 1e-5 * pi);
}

TEST(Rectangle, OverItsCornerIsTheTablesFormFactor) {
  // Square of height 1 over its corner: the tables say 0.1385. Over its middle: four of half the size.
  const double corner = projected_solid_angle_over_corner(1, 1, 1)->value() / pi;
  EXPECT_NEAR(corner, std::atan(1 / std::sqrt(2.0)) / (std::sqrt(2.0) * pi), 1e-15);
  EXPECT_NEAR(corner, 0.1385, 5e-5);
  EXPECT_NEAR(4 * projected_solid_angle_over_corner(0.5, 0.5, 1)->value() / pi,
              4 / (std::sqrt(5.0) * pi) * std::atan(1 / std::sqrt(5.0)), 1e-15);
  // Ever larger it fills a quarter of the sky.
  EXPECT_NEAR(projected_solid_angle_over_corner(1e9, 1e9, 1)->value(), pi / 4, 1e-9);
  EXPECT_EQ(projected_solid_angle_over_corner(0, 1, 1)->value(), 0);
  EXPECT_EQ(projected_solid_angle_over_corner(1, 1, 0)->value(), 0);
  EXPECT_EQ(code_of(projected_solid_angle_over_corner(-1, 1, 1)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(projected_solid_angle_over_corner(1, kNotANumber, 1)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(projected_solid_angle_over_corner(1, 1, kInfinity)), code(ErrorCode::kBadArgument));
}

RC_GTEST_PROP(Rectangle, IsItsFourCorners, ()) {
  const double x0 = between(-3, 0);
  const double x1 = between(0, 3);
  const double y0 = between(-3, 0);
  const double y1 = between(0, 3);
  const double h = between(0.1, 3);
  double parts = 0;
  for (const double x : {-x0, x1}) {
    for (const double y : {-y0, y1}) parts += projected_solid_angle_over_corner(x, y, h)->value();
  }
  const auto quad = projected_solid_angle(rectangle_above(x0, x1, y0, y1, h), kTable);
  RC_ASSERT(std::abs(quad->value() - parts) < 1e-14);
  const auto polygon = projected_solid_angle(corners_of(rectangle_above(x0, x1, y0, y1, h)), kTable);
  RC_ASSERT(std::abs(polygon->value() - parts) < 1e-14);
}

RC_GTEST_PROP(Polygon, HasTheIrradianceOfItsPartsInAnyPosition, ()) {
  const auto any = [] { return Vector3{between(-1, 1), between(-1, 1), between(-1, 1)}; };
  const QuadEmitter whole = {2.0 * any(), any(), any()};
  const Receiver receiver = {2.0 * any(), any()};
  RC_PRE(length(receiver.normal) > 0.01 && length(cross(whole.edge_u_m, whole.edge_v_m)) > 0.01);
  const double cut = between(0.1, 0.9);
  const QuadEmitter left = {whole.corner_m, cut * whole.edge_u_m, whole.edge_v_m};
  const QuadEmitter right = {whole.corner_m + cut * whole.edge_u_m, (1 - cut) * whole.edge_u_m,
                             whole.edge_v_m};
  const double sum =
      projected_solid_angle(left, receiver)->value() + projected_solid_angle(right, receiver)->value();
  const double all = projected_solid_angle(whole, receiver)->value();
  RC_ASSERT(all >= 0 && all <= pi + 1e-14);
  RC_ASSERT(std::abs(sum - all) < 1e-12);
  // From the other side it is dark.
  const QuadEmitter turned = {whole.corner_m, whole.edge_v_m, whole.edge_u_m};
  RC_ASSERT(all == 0 || projected_solid_angle(turned, receiver)->value() == 0);
}

TEST(Polygon, OfTwoHornsClippedAtTheHorizonIsTheSumOfBoth) {
  // A wall at x = 1 that faces the receiver at the origin; the horizon cuts a U upside up into two horns.
  const std::vector<Vector3> u = {{1, 2, 1},  {1, 2, -1},    {1, -2, -1},  {1, -2, 1},
                                  {1, -1, 1}, {1, -1, -0.5}, {1, 1, -0.5}, {1, 1, 1}};
  const auto rectangle = [](double y0, double y1) {
    return std::vector<Vector3>{{1, y1, 1}, {1, y1, 0}, {1, y0, 0}, {1, y0, 1}};
  };
  const double both = projected_solid_angle(rectangle(1, 2), kTable)->value() +
                      projected_solid_angle(rectangle(-2, -1), kTable)->value();
  ASSERT_GT(both, 0.05);
  EXPECT_NEAR(projected_solid_angle(u, kTable)->value(), both, 1e-14);
}

TEST(Polygon, HalfTheSkyAndAWall) {
  // A wall without end fills half of the upper hemisphere: pi / 2.
  const QuadEmitter wall = {{1, -1e9, -1e9}, {0, 0, 2e9}, {0, 2e9, 0}};
  EXPECT_NEAR(projected_solid_angle(wall, kTable)->value(), pi / 2, 1e-8);
}

TEST(Emitters, AreDarkBehindAndBelow) {
  const DiskEmitter away = {{0, 0, 1}, {0, 0, 1}, 1};
  const DiskEmitter below = {{0, 0, -1}, {0, 0, 1}, 1};
  const DiskEmitter in_plane = {{0, 0, 0}, {0, 0, 1}, 1};
  const DiskEmitter no_area = disk_above(1, 0);
  for (const auto& disk : {away, below, in_plane, no_area}) {
    EXPECT_EQ(projected_solid_angle(disk, kTable)->value(), 0);
    EXPECT_EQ(projected_solid_angle_by_area(disk, kTable, 100)->value(), 0);
    EXPECT_EQ(projected_solid_angle_by_directions(disk, kTable, 100)->value(), 0);
  }
  const QuadEmitter up = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  const QuadEmitter line = {{0, 0, 1}, {1, 0, 0}, {2, 0, 0}};
  const QuadEmitter nothing = {};
  for (const auto& quad : {up, line, nothing}) {
    EXPECT_EQ(projected_solid_angle(quad, kTable)->value(), 0);
    EXPECT_EQ(projected_solid_angle(corners_of(quad), kTable)->value(), 0);
    EXPECT_EQ(projected_solid_angle_by_area(quad, kTable, 100)->value(), 0);
    EXPECT_EQ(projected_solid_angle_by_directions(quad, kTable, 100)->value(), 0);
  }
}

TEST(Emitters, NeedFiniteNumbersNormalsAndPoints) {
  const int bad = code(ErrorCode::kBadArgument);
  for (const double number : {kNotANumber, kInfinity, -kInfinity}) {
    EXPECT_EQ(code_of(projected_solid_angle(disk_above(number, 1), kTable)), bad);
    EXPECT_EQ(code_of(projected_solid_angle(disk_above(1, number), kTable)), bad);
    EXPECT_EQ(code_of(projected_solid_angle(rectangle_above(0, number, 0, 1, 1), kTable)), bad);
    EXPECT_EQ(code_of(projected_solid_angle(rectangle_above(0, 1, 0, 1, number), kTable)), bad);
    EXPECT_EQ(code_of(projected_solid_angle(disk_above(1, 1), {{0, number, 0}, {0, 0, 1}})), bad);
    EXPECT_EQ(code_of(projected_solid_angle(rectangle_above(0, 1, 0, 1, 1), {{}, {0, 0, number}})), bad);
    EXPECT_EQ(code_of(projected_solid_angle(std::vector<Vector3>{{}, {1, 0, number}, {0, 1, 1}}, kTable)),
              bad);
  }
  EXPECT_EQ(code_of(projected_solid_angle(disk_above(1, -1), kTable)), bad);
  EXPECT_EQ(code_of(projected_solid_angle(disk_above(1, 1), {{}, {}})), bad);
  EXPECT_EQ(code_of(projected_solid_angle(DiskEmitter{{0, 0, 1}, {}, 1}, kTable)), bad);
  EXPECT_EQ(code_of(projected_solid_angle(DiskEmitter{{0, 0, 1}, {0, 0.1, -1}, 1}, kTable)), bad);
  EXPECT_EQ(code_of(projected_solid_angle(std::vector<Vector3>(2), kTable)), bad);
  EXPECT_EQ(code_of(projected_solid_angle_by_area(disk_above(1, 1), kTable, 0)), bad);
  EXPECT_EQ(code_of(projected_solid_angle_by_directions(disk_above(1, 1), kTable, 1'000'000'001)), bad);
}

TEST(Emitters, OfAnySizeAreTheSameUpToScale) {
  const double want = projected_solid_angle(disk_above(1, 0.5, 0.25), kTable)->value();
  const double quad = projected_solid_angle(rectangle_above(-1, 2, 0, 1, 1), kTable)->value();
  for (const double s : {1e-300, 1e-160, 1e160, 1e300}) {
    EXPECT_NEAR(projected_solid_angle(disk_above(s, 0.5 * s, 0.25 * s), kTable)->value(), want, 1e-14) << s;
    EXPECT_NEAR(projected_solid_angle(rectangle_above(-s, 2 * s, 0, s, s), kTable)->value(), quad, 1e-14)
        << s;
    EXPECT_NEAR(projected_solid_angle_by_area(disk_above(s, 0.5 * s, 0.25 * s), kTable, 10000)->value(), want,
                1e-4);
    EXPECT_NEAR(projected_solid_angle_by_area(rectangle_above(-s, 2 * s, 0, s, s), kTable, 10000)->value(),
                quad, 1e-3);
  }
}

/// Root mean square error of the rays over seeds.
template <class Emitter>
double error_of_rays(const Emitter& emitter, const Receiver& receiver, std::size_t points, double want) {
  constexpr int kSeeds = 40;
  double sum = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto got =
        projected_solid_angle_by_directions(emitter, receiver, points, static_cast<std::uint64_t>(seed));
    sum += (got->value() - want) * (got->value() - want);
  }
  return std::sqrt(sum / kSeeds);
}

template <class Emitter>
class Quadrature : public testing::Test {
 public:
  static Emitter emitter() {
    if constexpr (std::is_same_v<Emitter, DiskEmitter>) {
      return disk_above(1, 0.7, 0.4);
    } else {
      return rectangle_above(-0.5, 1, -0.2, 0.6, 1);
    }
  }
};
using Emitters = testing::Types<DiskEmitter, QuadEmitter>;
TYPED_TEST_SUITE(Quadrature, Emitters);

TYPED_TEST(Quadrature, OverAreaHasAnErrorThatFallsAsOneOverThePoints) {
  const auto emitter = this->emitter();
  const double want = projected_solid_angle(emitter, kTable)->value();
  double before = 0;
  for (const std::size_t points : {100U, 400U, 1600U, 6400U, 25600U}) {
    const double error = std::abs(projected_solid_angle_by_area(emitter, kTable, points)->value() - want);
    EXPECT_LT(error, 1.0 / static_cast<double>(points)) << points;
    if (before > 0) {
      EXPECT_NEAR(before / error, 4, 0.2) << points;
    }
    before = error;
  }
}

TYPED_TEST(Quadrature, OverDirectionsHasAnErrorThatFallsAsThePointsToThreeQuarters) {
  const auto emitter = this->emitter();
  const double want = projected_solid_angle(emitter, kTable)->value();
  // Both have a bounding sphere of about 0.8 round a centre about 1.1 away.
  const double cone = solid_angle_of_cone(std::asin(0.8 / 1.1));
  double before = 0;
  for (const std::size_t points : {64U, 1024U, 16384U}) {
    const double error = error_of_rays(emitter, kTable, points, want);
    EXPECT_LT(error, cone * std::pow(static_cast<double>(points), -0.75)) << points;
    if (before > 0) {
      EXPECT_NEAR(before / error, 8, 3) << points;
    }
    before = error;
  }
}

TYPED_TEST(Quadrature, AgreesForATiltedReceiverThatTheEmitterCrosses) {
  // The receiver's horizon cuts the emitter, and the planes are not parallel.
  const auto emitter = this->emitter();
  const Receiver tilted = {{0.1, 0.2, 0}, {1, 0.3, 0.2}};
  const double area = projected_solid_angle_by_area(emitter, tilted, 1'000'000)->value();
  const double rays = projected_solid_angle_by_directions(emitter, tilted, 1'000'000)->value();
  ASSERT_GT(area, 0.05);
  EXPECT_NEAR(rays, area, 3e-4);
  if constexpr (std::is_same_v<TypeParam, QuadEmitter>) {
    EXPECT_NEAR(projected_solid_angle(emitter, tilted)->value(), area, 1e-5);
  }
}

TEST(Quadrature, OverAreaFallsAsOneOverThePointsWhereTheHorizonCuts) {
  const QuadEmitter quad = rectangle_above(-0.5, 1, -0.2, 0.6, 1);
  const Receiver tilted = {{0.1, 0.2, 0}, {1, 0.3, 0.2}};
  const double want = projected_solid_angle(quad, tilted)->value();
  for (const std::size_t points : {100U, 1600U, 25600U}) {
    const double error = std::abs(projected_solid_angle_by_area(quad, tilted, points)->value() - want);
    EXPECT_LT(error, 0.1 / static_cast<double>(points)) << points;
  }
}

TEST(Quadrature, OverDirectionsFromInsideTheBoundingSphere) {
  const DiskEmitter near = disk_above(0.1, 1, 0.3);
  const double want = projected_solid_angle(near, kTable)->value();
  EXPECT_NEAR(projected_solid_angle_by_directions(near, kTable, 1'000'000)->value(), want, 1e-3);
}

TEST(Quadrature, GivesTheSameBitsForTheSameSeed) {
  const auto a = projected_solid_angle_by_directions(disk_above(1, 0.5), kTable, 1000, 5);
  EXPECT_EQ(*a, *projected_solid_angle_by_directions(disk_above(1, 0.5), kTable, 1000, 5));
  EXPECT_NE(*a, *projected_solid_angle_by_directions(disk_above(1, 0.5), kTable, 1000, 6));
}

TEST(Irradiance, IsRadianceTimesTheProjectedSolidAngleInUnitsThatFit) {
  const auto solid_angle = *projected_solid_angle(disk_above(1, 1), kTable);
  const auto irradiance = Radiance(10) * solid_angle;
  static_assert(std::is_same_v<decltype(irradiance), const Irradiance>);
  EXPECT_NEAR(irradiance.value(), 5 * pi, 1e-14);
  static_assert(std::is_same_v<decltype(SpectralRadiance(1) * solid_angle), SpectralIrradiance>);
  static_assert(std::is_same_v<decltype(Luminance(1) * solid_angle), Illuminance>);
}

TEST(ProjectedSolidAngleOverCorner, IsRightForAnyFiniteSides) {
  const double want = projected_solid_angle_over_corner(1, 1, 1)->value();
  EXPECT_NEAR(projected_solid_angle_over_corner(1.7e308, 1.7e308, 1.7e308)->value(), want, 1e-15);
}

TEST(ProjectedSolidAngle, OfADiskNearTheReceiversPlaneIsWithinTheBound) {
  for (const double e : {1.0, 1e-3, 1e-6}) {
    // The normal (3, 0, 4) / 5 is no number of doubles, the angle to a plane at 5 e is.
    const Vector3 centre = {4000 + 3 * e, 0, -3000 + 4 * e};
    const long double h = (3.0L * centre.x + 4.0L * centre.z) / 5;
    const long double aside = (4.0L * centre.x - 3.0L * centre.z) / 5;
    const long double r = 1000;
    const long double a = (aside - r) * (aside + r) + h * h;
    const long double b = hypotl(aside - r, h) * hypotl(aside + r, h);
    const long double want = std::numbers::pi_v<long double> / 2 * (4 * r * r * h * h / b / (a + b));
    const auto got = projected_solid_angle(DiskEmitter{centre, {-3, 0, -4}, 1000}, Receiver{{}, {3, 0, 4}});
    ASSERT_TRUE(got);
    EXPECT_NEAR(static_cast<double>(got->value() / want), 1, 1e-14 + 1e-12 / e)
        << e;  // 5000 m of 1e-16, twice
  }
}

}  // namespace
}  // namespace spectile::test
