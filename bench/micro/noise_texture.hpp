// A procedural texture: noise at four scales, with colours from all over the lower half of the cube.
#pragma once

#include <cstddef>

namespace bench {

/// A hash of two numbers, in [0, 1).
inline double noise(unsigned x, unsigned y) {
  unsigned h = x * 374761393U + y * 668265263U;
  h = (h ^ (h >> 13)) * 1274126177U;
  return ((h ^ (h >> 16)) & 0xFFFFFFU) / 16777216.0;
}

/// Smooth noise at a scale of `cell` pixels.
inline double smooth(double x, double y, double cell, unsigned seed) {
  const double u = x / cell;
  const double v = y / cell;
  const auto i = static_cast<unsigned>(u);
  const auto j = static_cast<unsigned>(v);
  const double a = u - i;
  const double b = v - j;
  const auto at = [&](unsigned p, unsigned q) { return noise(i + p + 7919 * seed, j + q); };
  return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
}

/// Component `k` of pixel x, y, in [0, 1).
inline double texture(std::size_t x, std::size_t y, std::size_t k) {
  const auto fx = static_cast<double>(x);
  const auto fy = static_cast<double>(y);
  const auto seed = static_cast<unsigned>(k);
  return 0.5 * smooth(fx, fy, 301, seed) + 0.3 * smooth(fx, fy, 37, 9) + 0.15 * smooth(fx, fy, 5, 11) +
         0.05 * noise(static_cast<unsigned>(x), static_cast<unsigned>(y) + 31 * seed);
}

}  // namespace bench
