// Vectors, rays, rectangles and spheres: all the geometry that the scenes need.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace tracer {

struct Vec3 {
  double x = 0, y = 0, z = 0;
};
constexpr Vec3 operator+(Vec3 a, Vec3 b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vec3 operator-(Vec3 a, Vec3 b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vec3 operator*(double s, Vec3 a) noexcept {
  return {s * a.x, s * a.y, s * a.z};
}
constexpr double dot(Vec3 a, Vec3 b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(Vec3 a, Vec3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) noexcept {
  return std::sqrt(dot(a, a));
}
inline Vec3 normalized(Vec3 a) noexcept {
  return (1 / length(a)) * a;
}

struct Ray {
  Vec3 origin, direction;  ///< the direction has length 1
};

/// Distance below which a hit is the surface that the ray leaves.
inline constexpr double kNear = 1e-6;
inline constexpr double kFar = std::numeric_limits<double>::infinity();

/// A distance along a ray, and where on the surface that is, from 0 to 1.
struct Distance {
  double t = kFar, u = 0, v = 0;
};

/// A rectangle corner + u * edge_u + v * edge_v; its front is the side of edge_u x edge_v. Edges must be at
/// right angles.
class Rectangle {
 public:
  Rectangle(Vec3 corner, Vec3 edge_u, Vec3 edge_v) noexcept
      : corner_(corner),
        edge_u_(edge_u),
        edge_v_(edge_v),
        area_(length(cross(edge_u, edge_v))),
        normal_((1 / area_) * cross(edge_u, edge_v)),
        to_u_((1 / dot(edge_u, edge_u)) * edge_u),
        to_v_((1 / dot(edge_v, edge_v)) * edge_v) {}
  Vec3 normal() const noexcept { return normal_; }
  double area() const noexcept { return area_; }
  Vec3 at(double u, double v) const noexcept { return corner_ + u * edge_u_ + v * edge_v_; }
  std::optional<Distance> intersect(const Ray& ray, double far) const noexcept {
    const Vec3 to_corner = corner_ - ray.origin;
    const double t = dot(to_corner, normal_) / dot(ray.direction, normal_);
    if (!(t > kNear && t < far)) return {};
    const Vec3 p = t * ray.direction - to_corner;
    const double u = dot(p, to_u_);
    const double v = dot(p, to_v_);
    if (u < 0 || u > 1 || v < 0 || v > 1) return {};
    return Distance{t, u, v};
  }

 private:
  Vec3 corner_, edge_u_, edge_v_;
  double area_;
  Vec3 normal_, to_u_, to_v_;
};

struct Sphere {
  Vec3 centre;
  double radius = 1;
  std::optional<Distance> intersect(const Ray& ray, double far) const noexcept {
    const Vec3 to_centre = centre - ray.origin;
    const double middle = dot(to_centre, ray.direction);
    const Vec3 miss = to_centre - middle * ray.direction;
    const double half_squared = radius * radius - dot(miss, miss);
    if (half_squared < 0) return {};
    const double half = std::sqrt(half_squared);
    const double t = middle - half > kNear ? middle - half : middle + half;
    if (!(t > kNear && t < far)) return {};
    return Distance{t, 0, 0};
  }
};

/// The direction with cosine-weighted density around a normal. Source of the basis: Duff et al., Building an
/// Orthonormal Basis, Revisited, JCGT 6(1), 2017.
inline Vec3 cosine_direction(Vec3 n, double u, double v) noexcept {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1 / (sign + n.z);
  const double b = n.x * n.y * a;
  const Vec3 tangent = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  const Vec3 bitangent = {b, sign + n.y * n.y * a, -n.y};
  const double r = std::sqrt(u);
  const double phi = 2 * std::numbers::pi * v;
  return normalized(r * std::cos(phi) * tangent + r * std::sin(phi) * bitangent +
                    std::sqrt(std::fmax(0, 1 - u)) * n);
}

constexpr Vec3 reflect(Vec3 d, Vec3 n) noexcept {
  return d - 2 * dot(d, n) * n;
}

}  // namespace tracer
