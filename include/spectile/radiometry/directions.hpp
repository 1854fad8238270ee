// Vectors, directions on the sphere, frames and solid angles, in double.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace spectile {

/// A vector or a point in space.
struct Vector3 {
  double x = 0, y = 0, z = 0;
  friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

constexpr Vector3 operator+(const Vector3& a, const Vector3& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Vector3 operator-(const Vector3& a, const Vector3& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Vector3 operator-(const Vector3& v) noexcept {
  return {-v.x, -v.y, -v.z};
}
constexpr Vector3 operator*(double s, const Vector3& v) noexcept {
  return {s * v.x, s * v.y, s * v.z};
}
constexpr Vector3 operator*(const Vector3& v, double s) noexcept {
  return s * v;
}
constexpr Vector3 operator/(const Vector3& v, double s) noexcept {
  return {v.x / s, v.y / s, v.z / s};
}
constexpr double dot(const Vector3& a, const Vector3& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vector3 cross(const Vector3& a, const Vector3& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Length, without overflow on the way.
inline double length(const Vector3& v) noexcept {
  return std::hypot(v.x, v.y, v.z);
}
/// The vector of length 1 in the same direction, for any finite length from the least to the greatest double.
/// The zero vector stays as it is; NaN or an infinity gives NaN.
Vector3 normalized(const Vector3& v) noexcept;
/// Angle between two vectors of any length. Units: rad, 0 to pi. Zero where one is the zero vector. Absolute
/// error below 1e-15 everywhere, also near 0 and pi, where an arc cosine has only half the digits. Source:
/// Kahan, How Futile are Mindless Assessments of Roundoff in Floating-Point Computation?, 2006, section 12.
double angle_between(const Vector3& a, const Vector3& b) noexcept;

// --- spherical coordinates: theta from the z axis, phi from the x axis towards y -------------------------

/// The direction with these coordinates. Sine and cosine beyond -1 to 1 are limited to it; that their squares
/// sum to 1 is the caller's matter. NaN goes through.
Vector3 spherical_direction(double sin_theta, double cos_theta, double phi) noexcept;
/// Angle from the z axis of a vector of any length. Units: rad, 0 to pi. 0 and pi at the poles, 0 for the
/// zero vector. Relative error below 1e-15, also near the z axis.
double spherical_theta(const Vector3& v) noexcept;
/// Angle about the z axis of a vector of any length. Units: rad, from 0 to below 2 pi. 0 at the poles and for
/// the zero vector.
double spherical_phi(const Vector3& v) noexcept;

// Cosines and sines of a direction of length 1 in a local frame whose z axis is the normal. At the poles phi
// is taken to be 0: cos_phi is 1, sin_phi is 0. The zero vector counts as a pole with cosine 0.

constexpr double cos_theta(const Vector3& w) noexcept {
  return w.z;
}
constexpr double cos2_theta(const Vector3& w) noexcept {
  return w.z * w.z;
}
constexpr double abs_cos_theta(const Vector3& w) noexcept {
  return w.z < 0 ? -w.z : w.z;
}
/// From x and y, so that no digits are lost near the poles.
constexpr double sin2_theta(const Vector3& w) noexcept {
  return w.x * w.x + w.y * w.y;
}
inline double sin_theta(const Vector3& w) noexcept {
  return std::hypot(w.x, w.y);
}
/// Infinite at the horizon (NaN for the zero vector).
inline double tan_theta(const Vector3& w) noexcept {
  return sin_theta(w) / w.z;
}
inline double tan2_theta(const Vector3& w) noexcept {
  return sin2_theta(w) / cos2_theta(w);
}
double cos_phi(const Vector3& w) noexcept;
double sin_phi(const Vector3& w) noexcept;
/// Cosine of the difference of two directions' phi; 1 where one of them is a pole.
double cos_phi_difference(const Vector3& a, const Vector3& b) noexcept;
/// True if both are strictly on one side of the horizon.
constexpr bool same_hemisphere(const Vector3& a, const Vector3& b) noexcept {
  return a.z * b.z > 0;
}

// --- frames ----------------------------------------------------------------------------------------------

/// Three orthonormal, right-handed axes.
struct Frame {
  Vector3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};

  /// The frame with this z axis, which must be of length 1; continuous but for a seam at z.z = 0. Axes are
  /// orthonormal to 1e-15, also for z = (0, 0, -1). Source: Duff et al., Building an Orthonormal Basis,
  /// Revisited, JCGT 6(1), 2017.
  static Frame from_z(const Vector3& z) noexcept;

  constexpr Vector3 to_local(const Vector3& v) const noexcept { return {dot(v, x), dot(v, y), dot(v, z)}; }
  constexpr Vector3 from_local(const Vector3& v) const noexcept { return v.x * x + v.y * y + v.z * z; }
};

// --- solid angles ----------------------------------------------------------------------------------------

/// Solid angle of the whole sphere.
inline constexpr double kSphereSolidAngle = 4 * std::numbers::pi;

/// Solid angle of a cone of directions about an axis. Units: half angle in rad, limited to 0 to pi; sr.
/// Relative error below 1e-15, also for narrow cones. NaN goes through.
double solid_angle_of_cone(double half_angle) noexcept;

/// Solid angle of the directions between two theta and two phi, in either order. Units: rad; sr. Relative
/// error that of the differences of the angles.
double solid_angle_of_ranges(double theta_0, double theta_1, double phi_0, double phi_1) noexcept;

/// Solid angle of the spherical triangle of the directions of three vectors of any length, the side of it
/// that is smaller than a hemisphere: 0 to 2 pi. 0 where a vector is zero or two are equal. Relative error
/// about 1e-15 divided by the triangle's least height in rad. Units: sr. Source: Van Oosterom and Strackee,
/// The Solid Angle of a Plane Triangle, IEEE Trans. Biomed. Eng. 30, 1983.
double solid_angle_of_triangle(const Vector3& a, const Vector3& b, const Vector3& c) noexcept;

/// Solid angle of the spherical polygon of the directions of its corners, in either sense of turning: a fan
/// of triangles that count with their sign, so that the polygon need not be convex. It must lie within a
/// hemisphere. 0 for fewer than three corners. Errors and source as for a triangle.
double solid_angle_of_polygon(std::span<const Vector3> corners) noexcept;

/// The same for four corners.
double solid_angle_of_quad(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) noexcept;

/// Solid angle of the rectangle from (x0, y0, z) to (x1, y1, z), in either order, seen from the origin. In
/// its own plane (z = 0) 2 pi inside it, 0 outside, and the mean of the neighbours on its edge. Units: any
/// length; sr. Absolute error below 4e-15.
double solid_angle_of_rectangle(double x0, double x1, double y0, double y1, double z) noexcept;

// --- the sphere as a square ------------------------------------------------------------------------------

/// A direction for a point of the unit square, such that equal areas become equal solid angles. Continuous;
/// the centre is +z, the four corners are -z. Coordinates beyond 0 to 1 are limited to it. Source: Clarberg,
/// Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD, J. Graphics Tools 13(3), 2008.
Vector3 equal_area_square_to_sphere(double u, double v) noexcept;
/// The inverse, for a vector of any length; the centre for the zero vector. Within 1e-15 of the point, and
/// within 1e-7 at the corners, where all of an edge's end is one direction.
std::array<double, 2> equal_area_sphere_to_square(const Vector3& direction) noexcept;

}  // namespace spectile
