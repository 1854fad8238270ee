// PixelFilter: profiles, their integrals and importance samples.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <spectile/film/pixel_filter.hpp>

#include "src/base/errors.hpp"
#include "src/film/filter_profile.hpp"
#include "src/film/filter_table.hpp"

namespace spectile {
namespace {

/// sin(pi x) / (pi x); exactly 0 at integers, so that a window ends where it should.
double sinc(double x) {
  if (x == 0) return 1;
  const double whole = std::nearbyint(x);
  const double sine = std::sin(std::numbers::pi * (x - whole));
  const bool odd = std::fmod(whole, 2) != 0;
  return (odd ? -sine : sine) / (std::numbers::pi * x);
}

/// (exp(-d^2 / 2s^2) - exp(-r^2 / 2s^2)) / (1 - exp(-r^2 / 2s^2)) for 0 <= d < r without the cancellation
/// that a wide sigma brings.
double gaussian_profile(double d, double r, double sigma) {
  const double at_end = 0.5 * (r / sigma) * (r / sigma);
  // So flat that the second-order term is all there is: 1 - d^2 / r^2 to the last bit.
  constexpr double kFlat = 1e-17;
  if (at_end < kFlat) return 1 - (d / r) * (d / r);
  const double here = 0.5 * (d / sigma) * (d / sigma);
  const double to_end = 0.5 * ((r - d) / sigma) * ((r + d) / sigma);
  return std::exp(-here) * (std::expm1(-to_end) / std::expm1(-at_end));
}

/// Six times the filter, x from 0 to 2. The outer piece is written from its double root at 2 outwards, so
/// that its sign there is right. Source: Mitchell, Netravali 1988, equation 8.
double mitchell_profile(double x, double b, double c) {
  if (x < 1) return ((12 - 9 * b - 6 * c) * x + (-18 + 12 * b + 6 * c)) * x * x + (6 - 2 * b);
  const double y = 2 - x;
  return y * y * ((b + 6 * c) * y - 6 * c);
}

/// True if it goes below 0 between 0 and 2: the outer piece does when the linear factor is below 0 at either
/// end, the inner one at its minimum.
bool mitchell_is_negative(double b, double c) {
  if (c > 0 || b < 0) return true;
  const double cubic = 12 - 9 * b - 6 * c;
  const double lowest = -2 * (-18 + 12 * b + 6 * c) / (3 * cubic);
  return cubic != 0 && lowest > 0 && lowest < 1 && mitchell_profile(lowest, b, c) < 0;
}

/// Integral of the profile over the axis.
template <class Profile>
double axis_integral(const Profile& profile, const std::vector<double>& pieces) {
  double sum = 0;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    sum += quadrature::ten_points(profile, pieces[i - 1], pieces[i]);
  }
  return 2 * sum;
}

}  // namespace

/// Table for importance sampling along an axis.
struct PixelFilter::Table : MagnitudeTable {
  using MagnitudeTable::MagnitudeTable;
};

double PixelFilter::profile(double d, double radius) const noexcept {
  const double distance = std::abs(d);
  if (kind_ == FilterKind::kBox) return d > -radius && d <= radius ? 1 : 0;
  if (!(distance <= radius)) return 0;
  switch (kind_) {
    case FilterKind::kTriangle:
      return 1 - distance / radius;
    case FilterKind::kGaussian:
      return distance < radius ? gaussian_profile(distance, radius, first_) : 0;
    case FilterKind::kMitchell:
      return mitchell_profile(2 * (distance / radius), first_, second_) / (6 - 2 * first_);
    case FilterKind::kLanczos:
      return sinc(distance) * sinc(distance / first_);
    case FilterKind::kBox:
      break;
  }
  return 0;
}

double PixelFilter::along_x(double d) const noexcept {
  return profile(d, radius_x_);
}

double PixelFilter::along_y(double d) const noexcept {
  return profile(d, radius_y_);
}

double PixelFilter::integral() const noexcept {
  return integral_;
}

bool PixelFilter::has_negative_lobes() const noexcept {
  if (kind_ == FilterKind::kMitchell) return mitchell_is_negative(first_, second_);
  // One of the factors changes its sign first, unless both do so together.
  return kind_ == FilterKind::kLanczos && first_ != 1 &&
         std::max(radius_x_, radius_y_) > std::min(1.0, first_);
}

std::vector<double> FilterAccess::smooth_pieces(const PixelFilter& filter, double radius) {
  std::vector<double> out = {0};
  double end = radius;
  double step = radius;
  if (filter.kind_ == FilterKind::kMitchell) step = radius / 2;
  if (filter.kind_ == FilterKind::kGaussian) {
    // exp(-39^2 / 2) is below the least double: beyond there is nothing.
    constexpr double kNothingLeft = 39;
    step = filter.first_;
    end = std::min(radius, kNothingLeft * step);
  }
  // A quarter of a period of the faster sine.
  if (filter.kind_ == FilterKind::kLanczos) step = 0.5 * std::min(1.0, filter.first_);
  const auto count = static_cast<int>(std::ceil(end / step));
  for (int i = 1; i < count; ++i) out.push_back(i * step);
  out.push_back(end);
  if (end < radius) out.push_back(radius);
  return out;
}

Result<PixelFilter> PixelFilter::finished(PixelFilter filter) {
  for (const double radius : {filter.radius_x_, filter.radius_y_}) {
    if (radius >= kMinRadius && radius <= kMaxRadius) continue;
    return make_error(ErrorCode::kBadArgument, "a filter's radius of {} pixels is not from {} to {}", radius,
                      kMinRadius, kMaxRadius);
  }
  const double first = filter.first_;
  if (filter.kind_ == FilterKind::kGaussian && !(first > 0 && std::isfinite(first))) {
    return make_error(ErrorCode::kBadArgument, "a Gaussian filter's sigma of {} is not above 0 and finite",
                      first);
  }
  if (filter.kind_ == FilterKind::kLanczos && !(first >= kMinTau && std::isfinite(first))) {
    return make_error(ErrorCode::kBadArgument, "a Lanczos filter's tau of {} is not finite and at least {}",
                      first, kMinTau);
  }
  if (filter.kind_ == FilterKind::kMitchell) {
    if (!std::isfinite(first) || !std::isfinite(filter.second_)) {
      return make_error(ErrorCode::kBadArgument, "a Mitchell filter's b = {} and c = {} are not finite",
                        first, filter.second_);
    }
    if (!(first < 3)) {
      return make_error(ErrorCode::kBadArgument, "a Mitchell filter of b = {} is not above 0 at its centre",
                        first);
    }
  }
  if (filter.kind_ == FilterKind::kBox || filter.kind_ == FilterKind::kTriangle) {
    const double area = filter.radius_x_ * filter.radius_y_;
    filter.integral_ = filter.kind_ == FilterKind::kBox ? 4 * area : area;
    return filter;
  }
  double integrals[2] = {};
  double magnitudes[2] = {};
  std::shared_ptr<const Table> tables[2];
  const double radii[2] = {filter.radius_x_, filter.radius_y_};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (axis == 1 && radii[1] == radii[0]) {
      integrals[1] = integrals[0];
      magnitudes[1] = magnitudes[0];
      tables[1] = tables[0];
      break;
    }
    const auto profile = [&](double d) { return filter.profile(d, radii[axis]); };
    const std::vector<double> pieces = FilterAccess::smooth_pieces(filter, radii[axis]);
    integrals[axis] = axis_integral(profile, pieces);
    const auto table = std::make_shared<const Table>(profile, pieces);
    magnitudes[axis] = 2 * table->total();
    tables[axis] = table;
  }
  // Of a narrow one both may be above 0, and their product not.
  filter.integral_ = integrals[0] * integrals[1];
  if (!(integrals[0] > 0 && filter.integral_ > 0) || !std::isfinite(magnitudes[0] * magnitudes[1])) {
    return make_error(ErrorCode::kBadArgument,
                      "a filter's integrals along x and y, {} and {}, and their product are not above 0 and "
                      "finite",
                      integrals[0], integrals[1]);
  }
  filter.magnitude_ = filter.has_negative_lobes() ? magnitudes[0] * magnitudes[1] / filter.integral_ : 1;
  filter.table_x_ = tables[0];
  filter.table_y_ = tables[1];
  return filter;
}

FilterSample PixelFilter::sample(double u, double v) const noexcept {
  // From -radius up, so that a box's samples lie in the half-open pixel: a distance is from the sample to the
  // centre.
  if (kind_ == FilterKind::kBox) return {(2 * u - 1) * radius_x_, (2 * v - 1) * radius_y_, 1};
  if (kind_ == FilterKind::kTriangle) {
    const auto tent = [](double t) { return t < 0.5 ? std::sqrt(2 * t) - 1 : 1 - std::sqrt(2 * (1 - t)); };
    return {tent(u) * radius_x_, tent(v) * radius_y_, 1};
  }
  const auto x = table_x_->sample(u);
  const auto y = table_y_->sample(v);
  return {x.d, y.d, x.negative != y.negative ? -magnitude_ : magnitude_};
}

}  // namespace spectile
