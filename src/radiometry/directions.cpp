// Directions on the sphere, frames and solid angles.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <spectile/radiometry/directions.hpp>

namespace spectile {

using std::numbers::pi;

Vector3 normalized(const Vector3& v) noexcept {
  if (v == Vector3{}) return v;
  if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    return {kNan, kNan, kNan};
  }
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  // By a power of two near the largest component: exact, and neither the square nor the division overflows.
  const int power = std::ilogb(largest);
  const Vector3 scaled = {std::scalbn(v.x, -power), std::scalbn(v.y, -power), std::scalbn(v.z, -power)};
  return scaled / std::sqrt(dot(scaled, scaled));
}

double angle_between(const Vector3& a, const Vector3& b) noexcept {
  const Vector3 p = normalized(a);
  const Vector3 q = normalized(b);
  if (p == Vector3{} || q == Vector3{}) return 0;
  return 2 * std::atan2(length(p - q), length(p + q));
}

Vector3 spherical_direction(double sin_theta, double cos_theta, double phi) noexcept {
  const double s = std::clamp(sin_theta, -1.0, 1.0);
  return {s * std::cos(phi), s * std::sin(phi), std::clamp(cos_theta, -1.0, 1.0)};
}

double spherical_theta(const Vector3& v) noexcept {
  if (v == Vector3{}) return 0;
  // Scaled by a power of two, so that the length of neither part overflows.
  const double most = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  // A NaN beside zeros, or an infinity.
  if (!(most > 0) || !std::isfinite(most)) return std::atan2(std::hypot(v.x, v.y), v.z);
  const int exponent = -std::ilogb(most);
  const auto scaled = [exponent](double x) { return std::scalbn(x, exponent); };
  return std::atan2(std::hypot(scaled(v.x), scaled(v.y)), scaled(v.z));
}

double spherical_phi(const Vector3& v) noexcept {
  if (v.x == 0 && v.y == 0) return 0;
  const double phi = std::atan2(v.y, v.x);
  if (phi >= 0 || std::isnan(phi)) return phi;
  const double turned = phi + 2 * pi;
  return turned < 2 * pi ? turned : 0;  // an angle just below zero rounds to a full turn
}

double cos_phi(const Vector3& w) noexcept {
  const double s = sin_theta(w);
  return s == 0 ? 1 : std::clamp(w.x / s, -1.0, 1.0);
}

double sin_phi(const Vector3& w) noexcept {
  const double s = sin_theta(w);
  return s == 0 ? 0 : std::clamp(w.y / s, -1.0, 1.0);
}

double cos_phi_difference(const Vector3& a, const Vector3& b) noexcept {
  const double product = std::hypot(a.x, a.y) * std::hypot(b.x, b.y);
  return product == 0 ? 1 : std::clamp((a.x * b.x + a.y * b.y) / product, -1.0, 1.0);
}

Frame Frame::from_z(const Vector3& z) noexcept {
  const double sign = std::copysign(1.0, z.z);
  const double a = -1 / (sign + z.z);
  const double b = z.x * z.y * a;
  return {{1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
}

double solid_angle_of_cone(double half_angle) noexcept {
  const double s = std::sin(std::clamp(half_angle, 0.0, pi) / 2);
  return kSphereSolidAngle * s * s;
}

double solid_angle_of_ranges(double theta_0, double theta_1, double phi_0, double phi_1) noexcept {
  // cos a - cos b as a product, which loses nothing for angles that are close.
  const double cosines = 2 * std::sin((theta_0 + theta_1) / 2) * std::sin((theta_1 - theta_0) / 2);
  return std::abs(cosines * (phi_1 - phi_0));
}

namespace {

/// Of the triangle of three vectors of length 1, positive where they turn counter-clockwise as seen from the
/// origin's far side.
double signed_triangle(const Vector3& a, const Vector3& b, const Vector3& c) noexcept {
  // The triple product, of differences: these lose nothing for small triangles.
  const double volume = dot(a, cross(b - a, c - a));
  return 2 * std::atan2(volume, 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

}  // namespace

double solid_angle_of_triangle(const Vector3& a, const Vector3& b, const Vector3& c) noexcept {
  const std::array<Vector3, 3> corners = {a, b, c};
  return solid_angle_of_polygon(corners);
}

double solid_angle_of_polygon(std::span<const Vector3> corners) noexcept {
  if (corners.size() < 3) return 0;
  const Vector3 hub = normalized(corners[0]);
  if (hub == Vector3{}) return 0;
  double sum = 0;
  Vector3 previous = normalized(corners[1]);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Vector3 next = normalized(corners[i]);
    if (previous == Vector3{} || next == Vector3{}) return 0;
    sum += signed_triangle(hub, previous, next);
    previous = next;
  }
  return std::abs(sum);
}

double solid_angle_of_quad(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) noexcept {
  const std::array<Vector3, 4> corners = {a, b, c, d};
  return solid_angle_of_polygon(corners);
}

double solid_angle_of_rectangle(double x0, double x1, double y0, double y1, double z) noexcept {
  // In units of the largest number, so that no product of two leaves the range.
  const double most = std::max({std::abs(x0), std::abs(x1), std::abs(y0), std::abs(y1), std::abs(z)});
  if (most > 0 && std::isfinite(most)) {
    for (double* number : {&x0, &x1, &y0, &y1, &z}) *number /= most;
  }
  const double depth = std::abs(z);
  const auto to_corner = [depth](double x, double y) {
    // Of the rectangle between the foot of the perpendicular and this corner, with the sign of its area.
    return std::atan2(x * y, depth * std::hypot(x, y, depth));
  };
  return std::abs(to_corner(x1, y1) - to_corner(x0, y1) - to_corner(x1, y0) + to_corner(x0, y0));
}

Vector3 equal_area_square_to_sphere(double u, double v) noexcept {
  const double a = 2 * std::clamp(u, 0.0, 1.0) - 1;
  const double b = 2 * std::clamp(v, 0.0, 1.0) - 1;
  const double from_seam = 1 - (std::abs(a) + std::abs(b));  // above 0 in the upper hemisphere
  const double r = 1 - std::abs(from_seam);                  // 0 at the pole, 1 at the horizon
  const double phi = r == 0 ? 0 : ((std::abs(b) - std::abs(a)) / r + 1) * (pi / 4);
  const double sine = r * std::sqrt(2 - r * r);
  return {std::copysign(sine * std::cos(phi), a), std::copysign(sine * std::sin(phi), b),
          std::copysign(1 - r * r, from_seam)};
}

std::array<double, 2> equal_area_sphere_to_square(const Vector3& direction) noexcept {
  const Vector3 w = normalized(direction);
  if (w == Vector3{}) return {0.5, 0.5};
  // 1 - |z| without the loss near the poles.
  const double r = std::sqrt(sin2_theta(w) / (1 + std::abs(w.z)));
  const double turn = r == 0 ? 0.5 : std::atan2(std::abs(w.y), std::abs(w.x)) * (2 / pi);
  double b = turn * r;
  double a = r - b;
  if (w.z < 0) {
    const double folded = 1 - b;
    b = 1 - a;
    a = folded;
  }
  return {(std::copysign(a, w.x) + 1) / 2, (std::copysign(b, w.y) + 1) / 2};
}

}  // namespace spectile
