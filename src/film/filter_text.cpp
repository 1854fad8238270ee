// Pixel filters by their parameters, and from and to text.
#include <array>
#include <cmath>
#include <spectile/film/pixel_filter.hpp>
#include <vector>

#include "src/base/errors.hpp"
#include "src/base/text.hpp"

namespace spectile {
namespace {

/// A shape's name and its parameters after the radius.
struct Shape {
  FilterKind kind;
  std::string_view name;
  std::size_t parameters;
  std::string_view form;
};

constexpr std::array kShapes = {Shape{FilterKind::kBox, "box", 0, "box:RADIUS"},
                                Shape{FilterKind::kTriangle, "triangle", 0, "triangle:RADIUS"},
                                Shape{FilterKind::kGaussian, "gaussian", 1, "gaussian:RADIUS:SIGMA"},
                                Shape{FilterKind::kMitchell, "mitchell", 2, "mitchell:RADIUS:B:C"},
                                Shape{FilterKind::kLanczos, "lanczos", 1, "lanczos:RADIUS:TAU"}};

const Shape& find_shape(FilterKind kind) {
  return kShapes[static_cast<std::size_t>(kind)];
}

/// The part of a text that an error quotes.
std::string_view quoted(std::string_view text) {
  constexpr std::size_t kMaxQuoted = 64;
  return text.substr(0, kMaxQuoted);
}

Result<double> number(std::string_view whole, std::string_view text, const Shape& shape) {
  const auto value = parse_number<double>(text);
  if (value && std::isfinite(*value)) return *value;
  return make_error(ErrorCode::kBadArgument, "filter \"{}\": \"{}\" is not a finite number; use {}",
                    quoted(whole), quoted(text), shape.form);
}

PixelFilter defaults(FilterKind kind) {
  switch (kind) {
    case FilterKind::kTriangle:
      return *PixelFilter::triangle();
    case FilterKind::kGaussian:
      return *PixelFilter::gaussian();
    case FilterKind::kMitchell:
      return *PixelFilter::mitchell();
    case FilterKind::kLanczos:
      return *PixelFilter::lanczos();
    case FilterKind::kBox:
      break;
  }
  return {};
}

}  // namespace

Result<PixelFilter> PixelFilter::shaped(FilterKind kind, double radius_x, double radius_y, double first,
                                        double second) {
  PixelFilter filter;
  filter.kind_ = kind;
  filter.radius_x_ = radius_x;
  filter.radius_y_ = radius_y;
  filter.first_ = first;
  filter.second_ = second;
  return finished(filter);
}

Result<PixelFilter> PixelFilter::box(double radius_x, double radius_y) {
  return shaped(FilterKind::kBox, radius_x, radius_y, 0, 0);
}

Result<PixelFilter> PixelFilter::triangle(double radius_x, double radius_y) {
  return shaped(FilterKind::kTriangle, radius_x, radius_y, 0, 0);
}

Result<PixelFilter> PixelFilter::gaussian(double radius_x, double radius_y, double sigma) {
  return shaped(FilterKind::kGaussian, radius_x, radius_y, sigma, 0);
}

Result<PixelFilter> PixelFilter::mitchell(double radius_x, double radius_y, double b, double c) {
  return shaped(FilterKind::kMitchell, radius_x, radius_y, b, c);
}

Result<PixelFilter> PixelFilter::lanczos(double radius_x, double radius_y, double tau) {
  return shaped(FilterKind::kLanczos, radius_x, radius_y, tau, 0);
}

Result<PixelFilter> PixelFilter::parse(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  const Shape* shape = nullptr;
  std::vector<std::string_view> names;
  for (const Shape& known : kShapes) {
    if (known.name == parts[0]) shape = &known;
    names.push_back(known.name);
  }
  if (shape == nullptr) {
    return make_error(ErrorCode::kUnknownName, "filter \"{}\" is unknown; there are {}", quoted(parts[0]),
                      fmt::join(names, ", "));
  }
  if (parts.size() > 2 + shape->parameters) {
    return make_error(ErrorCode::kBadArgument, "filter \"{}\" has {} numbers too many; use {}", quoted(text),
                      parts.size() - 2 - shape->parameters, shape->form);
  }
  const auto radii = parts.size() > 1 ? split(parts[1], 'x') : std::vector<std::string_view>{};
  if (radii.size() > 2) {
    return make_error(ErrorCode::kBadArgument,
                      "filter \"{}\": a radius is one number or two with an x between, not \"{}\"",
                      quoted(text), quoted(parts[1]));
  }
  std::vector<double> given;
  for (const std::string_view radius : radii) {
    SPECTILE_ASSIGN(const auto value, number(text, radius, *shape));
    given.push_back(value);
  }
  if (given.size() == 1) given.push_back(given[0]);
  for (std::size_t i = 2; i < parts.size(); ++i) {
    SPECTILE_ASSIGN(const auto value, number(text, parts[i], *shape));
    given.push_back(value);
  }
  PixelFilter wanted = defaults(shape->kind);
  if (!radii.empty()) {
    wanted.radius_x_ = given[0];
    wanted.radius_y_ = given[1];
  }
  if (given.size() > 2) wanted.first_ = given[2];
  if (given.size() > 3) wanted.second_ = given[3];
  auto filter = finished(wanted);
  if (!filter) {
    return make_error(filter.error().code, "filter \"{}\": {}", quoted(text), filter.error().message);
  }
  return filter;
}

std::string PixelFilter::to_text() const {
  const Shape& shape = find_shape(kind_);
  std::string text = fmt::format("{}:{}", shape.name, radius_x_);
  if (radius_y_ != radius_x_) text += fmt::format("x{}", radius_y_);
  if (shape.parameters > 0) text += fmt::format(":{}", first_);
  if (shape.parameters > 1) text += fmt::format(":{}", second_);
  return text;
}

}  // namespace spectile
