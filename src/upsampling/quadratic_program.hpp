// A small convex quadratic program over a box, the only place that uses Eigen.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace spectile {

/// A sparse row and a value: sum of coefficient times variable, compared with the value.
struct LinearTerm {
  std::vector<std::pair<std::size_t, double>> coefficients;  // variable, coefficient
  double value = 0;
};

/// Minimise the sum over `squares` of (row - value)^2, subject to row = value for each of `equalities` and
/// 0 <= x <= 1. The equalities must be linearly independent.
struct QuadraticProgram {
  std::size_t variables = 0;
  std::vector<LinearTerm> squares;
  std::vector<LinearTerm> equalities;
};

/// The minimum, its equalities met to 1e-12 of their largest coefficient, or nothing where no point meets
/// them. Every variable is in [0, 1]. Method: primal-dual interior point with Mehrotra's corrector, then the
/// linear system of the variables that are not at a bound. Source: Nocedal and Wright, Numerical
/// Optimization, 2nd edition, chapter 16.
std::optional<std::vector<double>> minimize(const QuadraticProgram& program);

}  // namespace spectile
