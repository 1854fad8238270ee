// PixelFilter: how a sample's distance from a pixel's centre weighs it there.
#pragma once

#include <memory>
#include <spectile/result.hpp>
#include <string>
#include <string_view>

namespace spectile {

/// Shapes of filters, all separable: a profile along x times one along y.
enum class FilterKind { kBox, kTriangle, kGaussian, kMitchell, kLanczos };

/// Where a filter was sampled, and the weight that goes with it.
struct FilterSample {
  double dx = 0;
  double dy = 0;
  double weight = 1;  ///< filter over density, relative to the mean: 1 without lobes below 0, else plus or
                      ///< minus the integral of the magnitude over the integral
};

struct FilterAccess;

/// An even, separable pixel filter of any radius, 1 at its centre. Units: pixels.
class PixelFilter {
 public:
  /// A box of radius half a pixel: a sample counts in the pixel that it lies in.
  PixelFilter() = default;
  /// 1 for -radius < d <= radius along each axis.
  static Result<PixelFilter> box(double radius_x = 0.5, double radius_y = 0.5);
  /// 1 - |d| / radius.
  static Result<PixelFilter> triangle(double radius_x = 2, double radius_y = 2);
  /// exp(-d^2 / (2 sigma^2)) less its value at the radius, over its value at 0.
  static Result<PixelFilter> gaussian(double radius_x = 1.5, double radius_y = 1.5, double sigma = 0.5);
  /// Piecewise cubic with parameters b and c, stretched to the radius (2 is as published), over its value at
  /// 0. Source: Mitchell, Netravali, Reconstruction Filters in Computer Graphics, SIGGRAPH 1988.
  static Result<PixelFilter> mitchell(double radius_x = 2, double radius_y = 2, double b = 1.0 / 3,
                                      double c = 1.0 / 3);
  /// sinc(d) * sinc(d / tau) with sinc(x) = sin(pi x) / (pi x): tau is how many cycles its window holds.
  static Result<PixelFilter> lanczos(double radius_x = 4, double radius_y = 4, double tau = 3);
  // Errors of all: kBadArgument for a radius that is not from kMinRadius to kMaxRadius, a sigma that is not
  // above 0 and finite, a tau that is not from kMinTau on and finite, a Mitchell filter whose parameters are
  // not finite or that is not above 0 at its centre, a filter whose integral is not.

  /// Reads "NAME", "NAME:RADIUS" or "NAME:RADIUS_XxRADIUS_Y", then the other parameters, colons between:
  /// "gaussian:1.5:0.5", "mitchell:2x2:0.333:0.333". Errors: kUnknownName, listing the names; kBadArgument.
  static Result<PixelFilter> parse(std::string_view text);

  static constexpr double kMinRadius = 0.01;
  static constexpr double kMaxRadius = 64;
  /// Below it a window holds more lobes than are of use to anybody.
  static constexpr double kMinTau = 0.01;

  FilterKind kind() const noexcept { return kind_; }
  double radius_x() const noexcept { return radius_x_; }
  double radius_y() const noexcept { return radius_y_; }
  /// The profile along an axis at distance d of the centre; 0 beyond the radius.
  double along_x(double d) const noexcept;
  double along_y(double d) const noexcept;
  /// The filter: the product of both.
  double operator()(double dx, double dy) const noexcept { return along_x(dx) * along_y(dy); }
  /// Integral of the filter over the plane.
  double integral() const noexcept;
  /// True if it goes below 0.
  bool has_negative_lobes() const noexcept;
  /// Importance-samples the filter's magnitude: u, v in [0, 1) to an offset from the pixel's centre.
  FilterSample sample(double u, double v) const noexcept;
  /// As parse() reads it, every parameter exact.
  std::string to_text() const;
  friend bool operator==(const PixelFilter& a, const PixelFilter& b) noexcept {
    return a.kind_ == b.kind_ && a.radius_x_ == b.radius_x_ && a.radius_y_ == b.radius_y_ &&
           a.first_ == b.first_ && a.second_ == b.second_;
  }

 private:
  friend struct FilterAccess;
  struct Table;
  /// The filter with what follows from its parameters, or what is wrong with them.
  static Result<PixelFilter> shaped(FilterKind kind, double radius_x, double radius_y, double first,
                                    double second);
  static Result<PixelFilter> finished(PixelFilter filter);
  double profile(double d, double radius) const noexcept;
  FilterKind kind_ = FilterKind::kBox;
  double radius_x_ = 0.5;
  double radius_y_ = 0.5;
  double first_ = 0;      ///< sigma, b or tau
  double second_ = 0;     ///< c
  double integral_ = 1;   ///< over the plane
  double magnitude_ = 1;  ///< integral of the magnitude over that, for lobes below 0
  std::shared_ptr<const Table> table_x_, table_y_;  ///< to draw from; none where there is a closed form
};

}  // namespace spectile
