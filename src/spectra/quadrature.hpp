// Adaptive Gauss-Legendre quadrature of smooth functions.
#pragma once

#include <cmath>

namespace spectile::quadrature {

/// Ten-point rule on [a, b]. Source of nodes and weights: Abramowitz, Stegun, Handbook of Mathematical
/// Functions, table 25.4.
template <class Function>
double ten_points(Function&& f, double a, double b) {
  constexpr double kNodes[5] = {0.1488743389816312109, 0.4333953941292471908, 0.6794095682990244062,
                                0.8650633666889845107, 0.9739065285171717201};
  constexpr double kWeights[5] = {0.2955242247147528702, 0.2692667193099963551, 0.2190863625159820440,
                                  0.1494513491505805931, 0.0666713443086881376};
  const double middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  double sum = 0;
  for (int i = 0; i < 5; ++i) {
    sum += kWeights[i] * (f(middle - half * kNodes[i]) + f(middle + half * kNodes[i]));
  }
  return half * sum;
}

/// Integral of f from a to b: halved until both halves agree with the whole to `tolerance` of their own
/// magnitude or to `negligible`, at most 2^`depth` times.
template <class Function>
double adaptive(Function&& f, double a, double b, double tolerance, double negligible = 0, int depth = 24) {
  const double middle = 0.5 * (a + b);
  const double whole = ten_points(f, a, b);
  const double left = ten_points(f, a, middle);
  const double right = ten_points(f, middle, b);
  const double allowed = std::fmax(negligible, tolerance * (std::abs(left) + std::abs(right)));
  if (depth <= 0 || !(std::abs(left + right - whole) > allowed)) return left + right;
  return adaptive(f, a, middle, tolerance, negligible, depth - 1) +
         adaptive(f, middle, b, tolerance, negligible, depth - 1);
}

}  // namespace spectile::quadrature
