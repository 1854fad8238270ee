// The functions that sigmoids combine: the published ones, flat where the eye sees nothing, convex together.
#include "src/spectra/sigmoid_functions.hpp"

#include <gtest/gtest.h>

#include <spectile/color/colorimetry.hpp>

#include "src/data/tables.hpp"

namespace spectile::test {
namespace {

constexpr Observer kObservers[] = {Observer::kCie1931, Observer::kCie1964};

TEST(SigmoidFunctions, AreTheQuadraticsPowers) {
  const SigmoidFunctions& quadratic = SigmoidFunctions::of(std::nullopt);
  EXPECT_TRUE(quadratic.are_quadratic());
  for (const double nm : {0.0, 400.0, 550.0, 712.5, 3000.0}) {
    const double l = (nm - 550) / 150;
    EXPECT_EQ(quadratic.at(nm)[0], l * l);
    EXPECT_EQ(quadratic.at(nm)[1], l);
  }
}

TEST(SigmoidFunctions, MeetTheQuadraticsAtThreePlaces) {
  for (const Observer observer : kObservers) {
    const SigmoidFunctions& functions = SigmoidFunctions::of(observer);
    const double wanted[][3] = {{450, 1, -1}, {550, 0, 0}, {650, 1, 1}};
    for (const auto& [nm, p, q] : wanted) {
      EXPECT_NEAR(functions.at(nm)[0], p, 1e-12);
      EXPECT_NEAR(functions.at(nm)[1], q, 1e-12);
    }
  }
}

/// The definition, each value from sums of its own: the double integral of f from the left is the sum of
/// (x - t) f(t), with half the first sample and a sixth at the end, by trapezoids of trapezoids.
double double_integral(std::span<const double> a, std::span<const double> b, std::size_t end) {
  double sum_a = 0;
  double sum_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_a += a[i];
    sum_b += b[i];
  }
  const auto f = [&](std::size_t i) { return a[i] / sum_a - b[i] / sum_b; };
  // Once by trapezoids up to i, then the same of those.
  double out = 0;
  double once = 0;
  for (std::size_t i = 1; i <= end; ++i) {
    const double next = once + (f(i - 1) + f(i)) / 2;
    out += (once + next) / 2;
    once = next;
  }
  return out;
}

TEST(SigmoidFunctions, AreCombinationsOfTheDoubleIntegrals) {
  const data::MatchingFunctions& curves = data::kCie1931;
  const SigmoidFunctions& functions = SigmoidFunctions::of(Observer::kCie1931);
  const auto u = [&](std::size_t i) { return double_integral(curves.x_bar, curves.y_bar, i); };
  const auto v = [&](std::size_t i) { return double_integral(curves.z_bar, curves.y_bar, i); };
  // p = a u + b v + c: the factors from three places, then seen at all others.
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t places[3] = {100, 200, 300};
    Matrix3 m{};
    std::array<double, 3> right{};
    for (std::size_t row = 0; row < 3; ++row) {
      m[3 * row] = u(places[row]);
      m[3 * row + 1] = v(places[row]);
      m[3 * row + 2] = 1;
      right[row] = functions.at(360.0 + static_cast<double>(places[row]))[k];
    }
    const auto factors = times(inverse(m), right);
    for (std::size_t i = 0; i <= 470; i += 7) {
      const double want = factors[0] * u(i) + factors[1] * v(i) + factors[2];
      ASSERT_NEAR(functions.at(360.0 + static_cast<double>(i))[k], want, 1e-11) << i;
    }
  }
}

TEST(SigmoidFunctions, AreThePublishedOnes) {
  // Of the table that was made from the 1931 observer independently: wavelength, q, p.
  const double published[][3] = {
      {360, -1.05649463, 1.16830859}, {363, -1.05649442, 1.16830791}, {830, 1.02067343, 1.02816028}};
  const SigmoidFunctions& functions = SigmoidFunctions::of(Observer::kCie1931);
  for (const auto& [nm, q, p] : published) {
    EXPECT_NEAR(functions.at(nm)[1], q, 6e-9) << nm;
    EXPECT_NEAR(functions.at(nm)[0], p, 6e-9) << nm;
  }
}

TEST(SigmoidFunctions, AreFlatAtBothEndsAndConstantBeyond) {
  for (const Observer observer : kObservers) {
    const SigmoidFunctions& functions = SigmoidFunctions::of(observer);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(functions.at(365)[k], functions.at(360)[k], 1e-4);
      EXPECT_NEAR(functions.at(820)[k], functions.at(830)[k], 1e-5);
      EXPECT_EQ(functions.at(-1e9)[k], functions.at(360)[k]);
      EXPECT_EQ(functions.at(1e9)[k], functions.at(830)[k]);
    }
  }
}

TEST(SigmoidFunctions, ACombinationIsZeroTwiceAtMost) {
  // The curve (p, q) turns one way only, so no straight line meets it three times; like a quadratic's. Beyond
  // 680 nm the matching functions have one proportion, and it is straight.
  for (const Observer observer : kObservers) {
    const SigmoidFunctions& functions = SigmoidFunctions::of(observer);
    for (double nm = 381; nm < 680; ++nm) {
      const auto before = functions.at(nm - 1);
      const auto here = functions.at(nm);
      const auto after = functions.at(nm + 1);
      const double turn =
          (here[0] - before[0]) * (after[1] - here[1]) - (here[1] - before[1]) * (after[0] - here[0]);
      ASSERT_LT(turn, 0) << nm;
    }
  }
}

TEST(SigmoidFunctions, InFloatAreTheDoublesAndExactAtWholeNanometres) {
  for (const Observer observer : kObservers) {
    const SigmoidFunctions& functions = SigmoidFunctions::of(observer);
    for (double nm = 350; nm < 840; nm += 0.3) {
      for (std::size_t k = 0; k < 2; ++k) {
        ASSERT_NEAR(functions.at_float(nm)[k], functions.at(nm)[k], 5e-7) << nm;
      }
    }
    for (int nm = 360; nm < 830; ++nm) {
      for (std::size_t k = 0; k < 2; ++k)
        ASSERT_EQ(functions.at_float(nm)[k], static_cast<float>(functions.at(nm)[k]));
    }
  }
}

}  // namespace
}  // namespace spectile::test
