// Spectra that a plan is fitted to beside those it is given: steep edges at any place, and smooth deviations.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "src/planner/problem.hpp"

namespace spectile::plan {
namespace {

/// Uniform in [0, 1), the same on every platform.
double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-53;
}

/// Nearly normal, of variance 1: the sum of twelve uniform parameters.
double normal(std::mt19937_64& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += uniform(random);
  return sum;
}

/// From 0 to 1, a half at 0, with the long ends of real absorption edges.
double edge(double x) {
  return 0.5 + 0.5 * x / std::sqrt(1 + x * x);
}

}  // namespace

Matrix synthetic_reflectances(Eigen::Index count, double first_nm, double last_nm) {
  // Up to four edges, 8 to 30 nm wide, on a logistic scale, between a gloss of 1.5 % and 96.5 %: chosen to
  // look like measured saturated paints, of which a set of some two hundred has a handful.
  constexpr double kMeanLogit = -1.2;
  constexpr double kLogitSpread = 1.2;
  constexpr double kStepSpread = 2.5;
  std::mt19937_64 random(11);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  Matrix out(kGrid, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int edges = 1 + static_cast<int>(uniform(random) * 3.999);
    double base = kMeanLogit + kLogitSpread * normal(random);
    std::vector<std::array<double, 3>> steps;  // where, how wide, how high
    for (int k = 0; k < edges; ++k) {
      const double where = first_nm + uniform(random) * (last_nm - first_nm);
      const double wide = 8 + 22 * uniform(random);
      steps.push_back({where, wide, kStepSpread * normal(random)});
      base -= 0.5 * steps.back()[2];
    }
    for (Eigen::Index g = 0; g < kGrid; ++g) {
      double logit = base;
      for (const auto& s : steps) logit += s[2] * edge((kFirstNm + static_cast<double>(g) - s[0]) / s[1]);
      out(g, i) = 0.015 + 0.95 / (1 + std::exp(-logit));
    }
  }
  return out;
}

Matrix smooth_spectra() {
  // Correlated over 25 nm, as measured reflectances are.
  constexpr double kLengthNm = 25;
  constexpr double kSize = 0.15;
  constexpr Eigen::Index kCount = 24;
  Matrix covariance(kGrid, kGrid);
  for (Eigen::Index a = 0; a < kGrid; ++a) {
    for (Eigen::Index b = 0; b < kGrid; ++b) {
      const double d = static_cast<double>(a - b) / kLengthNm;
      covariance(a, b) = kSize * kSize * std::exp(-0.5 * d * d);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance);
  Matrix out(kGrid, kCount);
  for (Eigen::Index k = 0; k < kCount; ++k) {
    const Eigen::Index at = kGrid - 1 - k;
    out.col(k) = solver.eigenvectors().col(at) * std::sqrt(std::max(0.0, solver.eigenvalues()[at]));
  }
  return out;
}

}  // namespace spectile::plan
