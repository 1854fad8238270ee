// Shared by the tests of pixel filters.
#pragma once

#include <spectile/film/pixel_filter.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {

/// One of every shape, and some that are extreme.
inline const std::vector<std::string>& filters() {
  static const std::vector<std::string> texts = {
      "box:0.5",          "box:0.3x2",           "triangle:2",        "triangle:1x0.7",
      "gaussian:1.5:0.5", "gaussian:2x3:40",     "gaussian:3:0.01",   "gaussian:2:1e+12",
      "mitchell:2",       "mitchell:1.3x3:1:0",  "mitchell:2:0:0.5",  "mitchell:2:-0.5:-0.25",
      "lanczos:4:3",      "lanczos:2.5x3.7:1.7", "lanczos:0.8x1.1:1", "lanczos:6:0.4"};
  return texts;
}

inline PixelFilter filter_of(const std::string& text) {
  auto filter = PixelFilter::parse(text);
  EXPECT_TRUE(filter) << text << ": " << (filter ? "" : filter.error().message);
  return filter ? *filter : PixelFilter();
}

/// Simpson's rule, many steps.
template <class Function>
double brute_force(const Function& f, double a, double b, int steps = 200000) {
  const double h = (b - a) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double at = a + i * h;
    sum += h / 6 * (f(at) + 4 * f(at + 0.5 * h) + f(std::min(at + h, b)));
  }
  return sum;
}

}  // namespace spectile::test
