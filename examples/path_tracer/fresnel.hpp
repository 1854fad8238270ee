// Fresnel's formulas for unpolarised light at smooth surfaces, and the refracted direction.
#pragma once

#include <optional>

#include "geometry.hpp"

namespace tracer {

/// Reflectance of a conductor with the index eta + i k in air, at the cosine of the angle of incidence.
/// Source: Born, Wolf, Principles of Optics, 7th edition, 1999, 14.2, solved for the squares as Lazanyi,
/// Szirmay-Kalos, Fresnel Term Approximations for Metals, WSCG 2005, start from.
inline double conductor_reflectance(double cosine, double eta, double k) noexcept {
  const double cos2 = cosine * cosine;
  const double sin2 = 1 - cos2;
  const double t = eta * eta - k * k - sin2;
  const double modulus = std::sqrt(t * t + 4 * eta * eta * k * k);  // a^2 + b^2
  const double a = std::sqrt(std::fmax(0, 0.5 * (modulus + t)));
  const double across = (modulus + cos2 - 2 * a * cosine) / (modulus + cos2 + 2 * a * cosine);
  const double along = (cos2 * modulus + sin2 * sin2 - 2 * a * cosine * sin2) /
                       (cos2 * modulus + sin2 * sin2 + 2 * a * cosine * sin2);
  return 0.5 * across * (1 + along);
}

/// Refraction through a surface: `ratio` is the index before over the one behind. None where all is
/// reflected. The normal is on the side that the ray comes from.
struct Refraction {
  double reflectance = 1;
  std::optional<Vec3> direction = {};
};
inline Refraction refract(Vec3 d, Vec3 n, double ratio) noexcept {
  const double cos_in = -dot(d, n);
  const double cos2_out = 1 - ratio * ratio * (1 - cos_in * cos_in);
  if (cos2_out <= 0) return {};
  const double cos_out = std::sqrt(cos2_out);
  const double across = (ratio * cos_in - cos_out) / (ratio * cos_in + cos_out);
  const double along = (cos_in - ratio * cos_out) / (cos_in + ratio * cos_out);
  return {0.5 * (across * across + along * along), normalized(ratio * d + (ratio * cos_in - cos_out) * n)};
}

}  // namespace tracer
