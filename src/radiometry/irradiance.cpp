// Projected solid angles of disks and polygons: closed forms, quadrature over area, rays over directions.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <spectile/radiometry/irradiance.hpp>
#include <vector>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

using std::numbers::pi;

constexpr double kMaxPoints = 1e9;

bool finite(const Vector3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double largest_magnitude(const Vector3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

Error not_finite(const char* what, const Vector3& v) {
  return make_error(ErrorCode::kBadArgument, "{} is ({}, {}, {}), which is not finite", what, v.x, v.y, v.z);
}

Result<Vector3> unit_normal(const char* whose, const Vector3& normal) {
  if (!finite(normal)) return not_finite(whose, normal);
  if (normal == Vector3{}) return make_error(ErrorCode::kBadArgument, "{} is the zero vector", whose);
  return normalized(normal);
}

Result<void> check_points(std::size_t points) {
  if (points >= 1 && static_cast<double>(points) <= kMaxPoints) return {};
  return make_error(ErrorCode::kBadArgument, "{} points asked for; 1 to {:.0f} are possible", points,
                    kMaxPoints);
}

/// Cells a side of a square grid of at least that many cells.
std::size_t rows_for(std::size_t points) {
  auto rows = static_cast<std::size_t>(std::sqrt(static_cast<double>(points)));
  while (rows * rows < points) ++rows;
  return rows;
}

/// A disk as the receiver sees it: the receiver is the origin, and lengths are of order 1.
struct SeenDisk {
  Vector3 receiver_normal, centre, normal;
  double radius = 0;
  /// How far the receiver is in front of the emitter's plane.
  double distance() const { return -dot(normal, centre); }
  Vector3 middle() const { return centre; }
  double bounding_radius() const { return radius; }
  bool contains(const Vector3& in_plane) const { return length(in_plane - centre) <= radius; }
};

/// The same of a parallelogram.
struct SeenQuad {
  Vector3 receiver_normal, corner, u, v, normal;
  double distance() const { return -dot(normal, corner); }
  Vector3 middle() const { return corner + 0.5 * (u + v); }
  double bounding_radius() const { return 0.5 * std::max(length(u + v), length(u - v)); }
  bool contains(const Vector3& in_plane) const {
    const Vector3 q = in_plane - corner;
    const double area = dot(cross(u, v), normal);
    const double along_u = dot(cross(q, v), normal);
    const double along_v = dot(cross(u, q), normal);
    return along_u >= 0 && along_u <= area && along_v >= 0 && along_v <= area;
  }
};

Result<SeenDisk> seen(const DiskEmitter& emitter, const Receiver& receiver) {
  SPECTILE_ASSIGN(const auto receiver_normal, unit_normal("the receiver's normal", receiver.normal));
  SPECTILE_ASSIGN(const auto normal, unit_normal("the disk's normal", emitter.normal));
  const Vector3 centre = emitter.centre_m - receiver.position_m;
  if (!finite(centre)) return not_finite("the disk's centre, from the receiver,", centre);
  if (!(emitter.radius_m >= 0) || !std::isfinite(emitter.radius_m)) {
    return make_error(ErrorCode::kBadArgument, "the disk's radius is {} m; it must be finite and not below 0",
                      emitter.radius_m);
  }
  const double scale = std::max(largest_magnitude(centre), emitter.radius_m);
  if (scale == 0) return SeenDisk{receiver_normal, {}, normal, 0};
  return SeenDisk{receiver_normal, centre / scale, normal, emitter.radius_m / scale};
}

Result<SeenQuad> seen(const QuadEmitter& emitter, const Receiver& receiver) {
  SPECTILE_ASSIGN(const auto receiver_normal, unit_normal("the receiver's normal", receiver.normal));
  const Vector3 corner = emitter.corner_m - receiver.position_m;
  if (!finite(corner)) return not_finite("the parallelogram's corner, from the receiver,", corner);
  if (!finite(emitter.edge_u_m)) return not_finite("the parallelogram's first edge", emitter.edge_u_m);
  if (!finite(emitter.edge_v_m)) return not_finite("the parallelogram's second edge", emitter.edge_v_m);
  const double scale = std::max(
      {largest_magnitude(corner), largest_magnitude(emitter.edge_u_m), largest_magnitude(emitter.edge_v_m)});
  if (scale == 0) return SeenQuad{receiver_normal, {}, {}, {}, {}};
  const Vector3 u = emitter.edge_u_m / scale;
  const Vector3 v = emitter.edge_v_m / scale;
  // A product of unit vectors does not underflow for a small parallelogram far away.
  return SeenQuad{receiver_normal, corner / scale, u, v, normalized(cross(normalized(u), normalized(v)))};
}

/// Contribution of a small area at `point` per unit of its area; the emitter's cosine is distance / d.
double contribution(const Vector3& point, const Vector3& receiver_normal, double distance) {
  const double square = dot(point, point);
  return std::max(0.0, dot(point, receiver_normal)) * distance / (square * square);
}

/// Mean over the cells' midpoints of an emitter, `at(s, t)` being its points for 0 < s, t < 1.
template <class At>
double mean_contribution(std::size_t points, const Vector3& receiver_normal, double distance, At at) {
  const std::size_t rows = rows_for(points);
  const double step = 1 / static_cast<double>(rows);
  double sum = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    double row = 0;
    for (std::size_t j = 0; j < rows; ++j) {
      row += contribution(at((static_cast<double>(i) + 0.5) * step, (static_cast<double>(j) + 0.5) * step),
                          receiver_normal, distance);
    }
    sum += row;
  }
  return sum * step * step;
}

/// Uniform from 0 to below 1; the same on every machine, unlike std::uniform_real_distribution.
double unit_random(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

template <class Emitter>
Result<SolidAngle> by_directions(const Emitter& from, const Receiver& receiver, std::size_t points,
                                 std::uint64_t seed) {
  SPECTILE_TRY(check_points(points));
  SPECTILE_ASSIGN(const auto emitter, seen(from, receiver));
  const double distance = emitter.distance();
  if (!(distance > 0)) return SolidAngle(0);
  // The cone about the bounding sphere; inside that sphere, the hemisphere above the receiver.
  const double away = length(emitter.middle());
  const bool outside = away > emitter.bounding_radius();
  const Frame frame = Frame::from_z(outside ? emitter.middle() / away : emitter.receiver_normal);
  const double half_angle = outside ? std::asin(emitter.bounding_radius() / away) : pi / 2;
  const double cap = 2 * std::sin(half_angle / 2) * std::sin(half_angle / 2);  // 1 - cos, all digits kept
  const std::size_t rows = rows_for(points);
  const double step = 1 / static_cast<double>(rows);
  std::mt19937_64 random(seed);
  double sum = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    double row = 0;
    for (std::size_t j = 0; j < rows; ++j) {
      const double below_axis = cap * (static_cast<double>(i) + unit_random(random)) * step;
      const double phi = 2 * pi * (static_cast<double>(j) + unit_random(random)) * step;
      const double sine = std::sqrt(below_axis * (2 - below_axis));
      const Vector3 w = frame.from_local(spherical_direction(sine, 1 - below_axis, phi));
      const double cosine = dot(w, emitter.receiver_normal);
      const double towards = -dot(w, emitter.normal);
      if (cosine > 0 && towards > 0 && emitter.contains((distance / towards) * w)) row += cosine;
    }
    sum += row;
  }
  return SolidAngle(2 * pi * cap * sum * step * step);
}

/// The part of a polygon that is not below the horizon. Where it is not convex its parts hang together by
/// edges along the horizon, which go both ways and cancel.
std::vector<Vector3> above_horizon(std::span<const Vector3> polygon, const Vector3& normal) {
  std::vector<Vector3> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3& a = polygon[i];
    const Vector3& b = polygon[(i + 1) % polygon.size()];
    const double height_a = dot(a, normal);
    const double height_b = dot(b, normal);
    if (height_a >= 0) out.push_back(a);
    if ((height_a >= 0) != (height_b >= 0)) {
      out.push_back(a + (height_a / (height_a - height_b)) * (b - a));
    }
  }
  return out;
}

/// Half the sum over the edges of the angle that each is seen under times the cosine of its plane's normal.
/// The polygon runs counter-clockwise as seen from the origin, so that the sum is positive.
double lambert(std::span<const Vector3> polygon, const Vector3& normal) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3 a = normalized(polygon[i]);
    const Vector3 b = normalized(polygon[(i + 1) % polygon.size()]);
    const Vector3 across = cross(b - a, a);  // b x a, with the digits of short edges
    const double sine = length(across);
    if (sine > 0) sum += std::atan2(sine, dot(a, b)) * (dot(across, normal) / sine);
  }
  return std::max(0.0, sum / 2);
}

/// Of a polygon seen from the origin.
double of_polygon(std::span<const Vector3> polygon, const Vector3& receiver_normal) {
  Vector3 area;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    area = area + cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  if (!(dot(area, polygon[0]) < 0)) return 0;
  return lambert(above_horizon(polygon, receiver_normal), receiver_normal);
}

}  // namespace

Result<SolidAngle> projected_solid_angle(const DiskEmitter& emitter, const Receiver& receiver) {
  SPECTILE_ASSIGN(const auto disk, seen(emitter, receiver));
  if (length(cross(disk.normal, disk.receiver_normal)) > 1e-9) {
    return make_error(
        ErrorCode::kBadArgument,
        "the disk's plane is {:.6g} rad from parallel to the receiver's; there is a closed form "
        "for parallel ones only",
        std::asin(std::min(1.0, length(cross(disk.normal, disk.receiver_normal)))));
  }
  const double h = disk.distance();
  const double r = disk.radius;
  if (!(h > 0) || !(dot(disk.receiver_normal, disk.centre) > 0) || r == 0) return SolidAngle(0);
  const double aside = length(cross(disk.normal, disk.centre));
  // pi / 2 (1 - a / b), where b^2 - a^2 = 4 r^2 h^2; b from the distances to the edge's nearest and farthest
  // points, which loses nothing near the edge.
  const double a = (aside - r) * (aside + r) + h * h;
  const double b = std::hypot(aside - r, h) * std::hypot(aside + r, h);
  if (a <= 0) return SolidAngle(pi / 2 * (1 - a / b));
  return SolidAngle(pi / 2 * ((2 * r * h / b) * (2 * r * h / (a + b))));
}

Result<SolidAngle> projected_solid_angle(const QuadEmitter& emitter, const Receiver& receiver) {
  SPECTILE_ASSIGN(const auto quad, seen(emitter, receiver));
  const Vector3& c = quad.corner;
  const std::array<Vector3, 4> polygon = {c, c + quad.u, c + quad.u + quad.v, c + quad.v};
  return SolidAngle(
      quad.distance() > 0 ? lambert(above_horizon(polygon, quad.receiver_normal), quad.receiver_normal) : 0);
}

Result<SolidAngle> projected_solid_angle(std::span<const Vector3> polygon_m, const Receiver& receiver) {
  SPECTILE_ASSIGN(const auto normal, unit_normal("the receiver's normal", receiver.normal));
  if (polygon_m.size() < 3) {
    return make_error(ErrorCode::kBadArgument, "a polygon of {} corners; at least 3 are needed",
                      polygon_m.size());
  }
  std::vector<Vector3> polygon;
  double scale = 0;
  for (const Vector3& corner : polygon_m) {
    polygon.push_back(corner - receiver.position_m);
    if (!finite(polygon.back())) return not_finite("a corner, from the receiver,", polygon.back());
    scale = std::max(scale, largest_magnitude(polygon.back()));
  }
  if (scale == 0) return SolidAngle(0);
  for (Vector3& corner : polygon) corner = corner / scale;
  return SolidAngle(of_polygon(polygon, normal));
}

Result<SolidAngle> projected_solid_angle_over_corner(double side_a_m, double side_b_m, double height_m) {
  for (const double number : {side_a_m, side_b_m, height_m}) {
    if (number >= 0 && std::isfinite(number)) continue;
    return make_error(ErrorCode::kBadArgument,
                      "a rectangle of {} by {} m at {} m; each must be finite and not below 0", side_a_m,
                      side_b_m, height_m);
  }
  if (side_a_m == 0 || side_b_m == 0 || height_m == 0) return SolidAngle(0);
  // In units of the largest, so that no length overflows.
  const double unit = std::max({side_a_m, side_b_m, height_m});
  const double a = side_a_m / unit;
  const double b = side_b_m / unit;
  const double h = height_m / unit;
  const double to_a = std::hypot(a, h);
  const double to_b = std::hypot(b, h);
  return SolidAngle((a / to_a * std::atan2(b, to_a) + b / to_b * std::atan2(a, to_b)) / 2);
}

Result<SolidAngle> projected_solid_angle_by_area(const DiskEmitter& emitter, const Receiver& receiver,
                                                 std::size_t points) {
  SPECTILE_TRY(check_points(points));
  SPECTILE_ASSIGN(const auto disk, seen(emitter, receiver));
  const double distance = disk.distance();
  if (!(distance > 0)) return SolidAngle(0);
  const Frame frame = Frame::from_z(disk.normal);
  const double mean = mean_contribution(points, disk.receiver_normal, distance, [&](double s, double t) {
    const double r = disk.radius * std::sqrt(s);  // rings of equal area
    return disk.centre + r * (std::cos(2 * pi * t) * frame.x + std::sin(2 * pi * t) * frame.y);
  });
  return SolidAngle(pi * disk.radius * disk.radius * mean);
}

Result<SolidAngle> projected_solid_angle_by_area(const QuadEmitter& emitter, const Receiver& receiver,
                                                 std::size_t points) {
  SPECTILE_TRY(check_points(points));
  SPECTILE_ASSIGN(const auto quad, seen(emitter, receiver));
  const double distance = quad.distance();
  if (!(distance > 0)) return SolidAngle(0);
  const double mean = mean_contribution(points, quad.receiver_normal, distance, [&](double s, double t) {
    return quad.corner + s * quad.u + t * quad.v;
  });
  return SolidAngle(length(cross(quad.u, quad.v)) * mean);
}

Result<SolidAngle> projected_solid_angle_by_directions(const DiskEmitter& emitter, const Receiver& receiver,
                                                       std::size_t points, std::uint64_t seed) {
  return by_directions(emitter, receiver, points, seed);
}

Result<SolidAngle> projected_solid_angle_by_directions(const QuadEmitter& emitter, const Receiver& receiver,
                                                       std::size_t points, std::uint64_t seed) {
  return by_directions(emitter, receiver, points, seed);
}

}  // namespace spectile
