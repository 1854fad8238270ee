// Loops and systems of equations that representations are computed with.
#include "bench/representations/lane_loops.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "bench/representations/linear_system.hpp"
#include "src/dispatch/dispatch.hpp"

namespace spectile::test {
namespace {

using namespace measure;  // NOLINT(google-build-using-namespace): the subject of all tests here

/// Compares loops with their formulas in double.
void check(const LaneLoops& loops) {
  std::mt19937_64 random(1);
  const auto draw = [&](std::size_t n) {
    std::vector<float> out(n);
    for (float& v : out) v = std::uniform_real_distribution<float>(-1, 1)(random);
    return out;
  };
  constexpr std::size_t kBlocks = 3;
  for (std::size_t size = 0; size < std::size(kBasisSizes); ++size) {
    const std::size_t n = kBasisSizes[size];
    const std::size_t entries = n * (n + 1) / 2;
    const auto in = draw(kBlocks * n * kLoopLanes);
    const auto matrix = draw(kBlocks * entries * kLoopLanes);
    std::vector<float> out(in.size());
    loops.apply[size](out.data(), in.data(), matrix.data(), kBlocks);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::size_t block = i / (n * kLoopLanes);
      const std::size_t row = i / kLoopLanes % n;
      double expected = 0;
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t low = std::min(row, k);
        const std::size_t high = std::max(row, k);
        expected +=
            static_cast<double>(
                matrix[(block * entries + high * (high + 1) / 2 + low) * kLoopLanes + i % kLoopLanes]) *
            static_cast<double>(in[(block * n + k) * kLoopLanes + i % kLoopLanes]);
      }
      ASSERT_NEAR(static_cast<double>(out[i]), expected, 2e-6) << n << " functions, " << i;
    }
  }
  // Polynomials: the product sampled at the eight nodes of T8, and its first four coefficients by the
  // discrete cosine transform.
  constexpr std::size_t kPolynomials = 5;
  const auto a = draw(kPolynomials * kTerms * kLoopLanes);
  const auto b = draw(a.size());
  std::vector<float> out(a.size());
  loops.multiply_chebyshev(out.data(), a.data(), b.data(), kPolynomials);
  constexpr int kNodes = 8;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t first = i / (kTerms * kLoopLanes) * kTerms * kLoopLanes + i % kLoopLanes;
    const auto term = static_cast<double>(i / kLoopLanes % kTerms);
    double expected = 0;
    for (int node = 0; node < kNodes; ++node) {
      const double angle = std::numbers::pi * (node + 0.5) / kNodes;
      double u = 0;
      double v = 0;
      for (std::size_t k = 0; k < kTerms; ++k) {
        u += static_cast<double>(a[first + k * kLoopLanes]) * std::cos(static_cast<double>(k) * angle);
        v += static_cast<double>(b[first + k * kLoopLanes]) * std::cos(static_cast<double>(k) * angle);
      }
      expected += u * v * std::cos(term * angle) * (term == 0 ? 1 : 2) / kNodes;
    }
    ASSERT_NEAR(static_cast<double>(out[i]), expected, 1e-6) << i;
  }
  constexpr std::size_t kWavelengths = 5;
  const auto product = draw(kBlocks * kWavelengths * kLoopLanes);
  const auto weights = draw(3 * product.size());
  std::vector<float> xyz(3 * kBlocks * kLoopLanes);
  loops.weigh(xyz.data(), product.data(), weights.data(), kWavelengths, kBlocks);
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const std::size_t k = i / (kBlocks * kLoopLanes);
    const std::size_t block = i / kLoopLanes % kBlocks;
    double expected = 0;
    for (std::size_t w = 0; w < kWavelengths; ++w) {
      const std::size_t at = block * kWavelengths + w;
      expected += static_cast<double>(product[at * kLoopLanes + i % kLoopLanes]) *
                  static_cast<double>(weights[(at * 3 + k) * kLoopLanes + i % kLoopLanes]);
    }
    ASSERT_NEAR(static_cast<double>(xyz[i]), expected, 2e-6) << i;
  }
}

TEST(LaneLoops, AreTheirFormulasOnEveryLane) {
  for (const auto* table : dispatch::available()) {
    const LaneLoops& loops = lane_loops(table->name);
    SCOPED_TRACE(loops.flags);
    check(loops);
  }
}

TEST(LinearSystem, IsSolvedWithAZeroOnTheDiagonalAndRefusedWhereSingular) {
  std::vector<double> matrix = {0, 2, 1, 1, 0, 0, 3, 1, 1};
  std::vector<double> right = {7, 1, 8};  // of 1, 2, 3
  ASSERT_TRUE(solve_linear(matrix, right));
  EXPECT_NEAR(right[0], 1, 1e-14);
  EXPECT_NEAR(right[1], 2, 1e-14);
  EXPECT_NEAR(right[2], 3, 1e-14);
  matrix = {1, 2, 2, 4};
  right = {1, 1};
  EXPECT_FALSE(solve_linear(matrix, right));
}

}  // namespace
}  // namespace spectile::test
