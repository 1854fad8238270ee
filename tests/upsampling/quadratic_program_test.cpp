// The quadratic program finds minima that are known beforehand, says so where there is no point at all, and
// what it finds cannot be improved.
#include "src/upsampling/quadratic_program.hpp"

#include <span>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

/// A program that looks for the point nearest to `target`.
QuadraticProgram nearest_to(std::initializer_list<double> target) {
  QuadraticProgram program;
  program.variables = target.size();
  std::size_t i = 0;
  for (const double v : target) program.squares.push_back({{{i++, 1.0}}, v});
  return program;
}

LinearTerm sum_of(std::size_t variables, double value) {
  LinearTerm term;
  for (std::size_t i = 0; i < variables; ++i) term.coefficients.emplace_back(i, 1.0);
  term.value = value;
  return term;
}

void expect_minimum(const QuadraticProgram& program, std::initializer_list<double> want,
                    double bound = 1e-9) {
  const auto got = minimize(program);
  ASSERT_TRUE(got);
  ASSERT_EQ(got->size(), want.size());
  std::size_t i = 0;
  for (const double v : want) {
    EXPECT_NEAR((*got)[i], v, bound) << i;
    EXPECT_GE((*got)[i], 0);
    EXPECT_LE((*got)[i], 1);
    ++i;
  }
}

double objective(const QuadraticProgram& program, std::span<const double> x) {
  double sum = 0;
  for (const LinearTerm& term : program.squares) {
    double value = -term.value;
    for (const auto& [variable, coefficient] : term.coefficients) value += coefficient * x[variable];
    sum += value * value;
  }
  return sum;
}

TEST(QuadraticProgram, WithoutConstraintsItIsTheNearestPointOfTheBox) {
  expect_minimum(nearest_to({0.3}), {0.3});
  expect_minimum(nearest_to({2.0}), {1.0});
  expect_minimum(nearest_to({-1.0}), {0.0});
  expect_minimum(nearest_to({0.5, -3.0, 7.0, 0.25}), {0.5, 0, 1, 0.25});
}

TEST(QuadraticProgram, EqualitiesMoveThePointAlongTheirNormal) {
  QuadraticProgram program = nearest_to({0.2, 0.9});
  program.equalities.push_back(sum_of(2, 1.0));
  expect_minimum(program, {0.15, 0.85});
  program.equalities[0] = {{{0, 3.0}, {1, 4.0}},
                           3.0};  // 3 x + 4 y = 3, from (0.2, 0.9) back by 1.2 / 25 of (3, 4)
  expect_minimum(program, {0.056, 0.708});
}

TEST(QuadraticProgram, BoundsThatHoldBackShareOutTheRest) {
  QuadraticProgram program = nearest_to({0.0, 0.0, 2.0});
  program.equalities.push_back(sum_of(3, 1.5));
  expect_minimum(program, {0.25, 0.25, 1.0});
  program = nearest_to({-1.0, 0.5, 0.5});
  program.equalities.push_back(sum_of(3, 0.6));
  expect_minimum(program, {0.0, 0.3, 0.3});
}

TEST(QuadraticProgram, WeightsOfTheSquaresCount) {
  QuadraticProgram program;
  program.variables = 2;
  program.squares = {{{{0, 2.0}}, 0.0}, {{{1, 1.0}}, 0.0}};  // 4 x^2 + y^2, x + y = 1
  program.equalities.push_back(sum_of(2, 1.0));
  expect_minimum(program, {0.2, 0.8});
}

TEST(QuadraticProgram, AsManyEqualitiesAsVariablesLeaveNoChoice) {
  QuadraticProgram program;
  program.variables = 2;
  program.equalities = {{{{0, 1.0}, {1, 1.0}}, 1.1}, {{{0, 1.0}, {1, -1.0}}, 0.3}};
  expect_minimum(program, {0.7, 0.4});
}

TEST(QuadraticProgram, EqualitiesThatNoPointMeetsGiveNothing) {
  for (const double value : {3.0, 2.001, -0.001, -5.0}) {
    QuadraticProgram program = nearest_to({0.5, 0.5});
    program.equalities.push_back(sum_of(2, value));
    EXPECT_FALSE(minimize(program)) << value;
  }
  QuadraticProgram program = nearest_to({0.5, 0.5});
  program.equalities = {{{{0, 1.0}, {1, 1.0}}, 1.1}, {{{0, 1.0}, {1, -1.0}}, 1.3}};  // 1.2 and -0.1
  EXPECT_FALSE(minimize(program));
}

TEST(QuadraticProgram, TheMinimumOfAnythingCannotBeImproved) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const std::size_t n : {3, 8, 40}) {
    for (int trial = 0; trial < 20; ++trial) {
      QuadraticProgram program;
      program.variables = n;
      for (std::size_t i = 0; i < n + 2; ++i) {
        LinearTerm term;
        for (std::size_t k = 0; k < n; ++k) term.coefficients.emplace_back(k, unit(random));
        term.value = 3 * unit(random);  // far enough for bounds to hold
        program.squares.push_back(std::move(term));
      }
      // Two equalities through a point well inside.
      for (int i = 0; i < 2; ++i) {
        LinearTerm term;
        for (std::size_t k = 0; k < n; ++k) {
          term.coefficients.emplace_back(k, unit(random));
          term.value += term.coefficients.back().second * (0.5 + 0.3 * unit(random));
        }
        if (i == 0 || n > 3) program.equalities.push_back(std::move(term));
      }
      const auto x = minimize(program);
      if (!x) continue;  // the second equality need not meet the box together with the first
      for (const LinearTerm& term : program.equalities) {
        double value = 0;
        for (const auto& [variable, coefficient] : term.coefficients) value += coefficient * (*x)[variable];
        ASSERT_NEAR(value, term.value, 1e-12);
      }
      // Towards other points of the same equalities: those nearest to random ones.
      const double least = objective(program, *x);
      for (int other = 0; other < 10; ++other) {
        QuadraticProgram nearest;
        nearest.variables = n;
        nearest.equalities = program.equalities;
        for (std::size_t k = 0; k < n; ++k) nearest.squares.push_back({{{k, 1.0}}, unit(random)});
        const auto y = minimize(nearest);
        ASSERT_TRUE(y);
        for (const double part : {1e-4, 1e-2, 1.0}) {
          std::vector<double> between(n);
          for (std::size_t k = 0; k < n; ++k) between[k] = (*x)[k] + part * ((*y)[k] - (*x)[k]);
          ASSERT_GE(objective(program, between), least - 1e-9) << n << " variables, trial " << trial;
        }
      }
    }
  }
}

}  // namespace
}  // namespace spectile::test
