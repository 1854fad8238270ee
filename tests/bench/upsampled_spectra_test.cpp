// Spectra made of RGB as others make them: each against the conditions that define it.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <spectile/color/colorimetry.hpp>

#include "bench/representations/linear_system.hpp"
#include "bench/representations/representation.hpp"

namespace spectile::test {
namespace {

using namespace measure;  // NOLINT(google-build-using-namespace): the subject of all tests here
using Color = std::array<double, 3>;

/// The observer's sums for RGB of the default bands.
struct RgbSums {
  RgbSums() {
    const auto projector = *Projector::reflective(bands, reference_light("D65")->spectrum);
    for (std::size_t b = 0; b < bands.count(); ++b) {
      weights.push_back(times(projector.xyz_to_srgb(), projector.weights()[b]));
      phases.push_back(moment_phase(bands[b].centre_nm));
    }
  }
  Color of(const std::vector<double>& spectrum) const {
    Color out{};
    for (std::size_t b = 0; b < weights.size(); ++b) {
      for (std::size_t k = 0; k < 3; ++k) out[k] += weights[b][k] * spectrum[b];
    }
    return out;
  }
  Bands bands;
  std::vector<Color> weights;
  std::vector<double> phases;
};
constexpr Color kColors[] = {
    {0.5, 0.5, 0.5}, {0.7, 0.2, 0.1}, {0.1, 0.4, 0.15}, {0.05, 0.08, 0.5}, {0.9, 0.85, 0.3}};

/// Rest of a vector without the part along the colours' sums, each band's weight times `scale`.
double off_the_sums(std::vector<double> vector, const RgbSums& sums, const std::vector<double>& scale) {
  std::vector<double> matrix(9);
  std::vector<double> right(3);
  for (std::size_t b = 0; b < vector.size(); ++b) {
    for (std::size_t j = 0; j < 3; ++j) {
      right[j] += sums.weights[b][j] * scale[b] * vector[b];
      for (std::size_t k = 0; k < 3; ++k) {
        matrix[3 * j + k] += sums.weights[b][j] * sums.weights[b][k] * scale[b] * scale[b];
      }
    }
  }
  EXPECT_TRUE(solve_linear(matrix, right));
  double most = 0;
  for (std::size_t b = 0; b < vector.size(); ++b) {
    for (std::size_t k = 0; k < 3; ++k) vector[b] -= right[k] * sums.weights[b][k] * scale[b];
    most = std::max(most, std::abs(vector[b]));
  }
  return most;
}

/// Gradient of the sum of squared differences of neighbours.
std::vector<double> slope_gradient(const std::vector<double>& z) {
  std::vector<double> out(z.size());
  for (std::size_t b = 1; b < z.size(); ++b) {
    out[b] += 2 * (z[b] - z[b - 1]);
    out[b - 1] -= 2 * (z[b] - z[b - 1]);
  }
  return out;
}

TEST(UpsampledSpectra, HaveTheirColorWithinZeroAndOne) {
  const RgbSums sums;
  for (const Color& color : kColors) {
    for (const auto& spectrum :
         {moment_spectrum(sums.phases, sums.weights, color), smoothest_spectrum(sums.weights, color),
          least_slope_spectrum(sums.weights, color)}) {
      ASSERT_EQ(spectrum.size(), 60U);
      const Color found = sums.of(spectrum);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], color[k], 1e-6);
      for (const double v : spectrum) {
        EXPECT_GE(v, 0);
        EXPECT_LE(v, 1);
      }
    }
  }
  EXPECT_TRUE(least_slope_spectrum(sums.weights, {1.5, 0, 0}).empty());
  EXPECT_TRUE(smoothest_spectrum(sums.weights, {1.5, 0, 0}).empty());
  EXPECT_TRUE(moment_spectrum(sums.phases, sums.weights, {1.5, 0, 0}).empty());
}

TEST(UpsampledSpectra, LeastSlopesMeetLagrangesConditions) {
  const RgbSums sums;
  for (const Color& color : kColors) {
    // In z, of which the reflectance is (tanh z + 1) / 2.
    std::vector<double> z;
    std::vector<double> scale;
    for (const double r : least_slope_spectrum(sums.weights, color)) {
      z.push_back(std::atanh(2 * r - 1));
      scale.push_back(2 * r * (1 - r));
    }
    EXPECT_LT(off_the_sums(slope_gradient(z), sums, scale), 1e-6);
    // The smoothest one, where it is inside the range, in the reflectance itself.
    const auto smoothest = smoothest_spectrum(sums.weights, color);
    bool inside = true;
    for (const double r : smoothest) inside = inside && r > 1e-6 && r < 1 - 1e-6;
    if (inside) {
      EXPECT_LT(off_the_sums(slope_gradient(smoothest), sums, std::vector<double>(60, 1.0)), 1e-6);
    }
  }
}

TEST(UpsampledSpectra, MomentsGiveTheSpectrumBack) {
  // The reconstruction of Peters et al.: exponential moments, the autoregressive extension of those of the
  // density, and its argument. Here it is run on, term by term, until it has converged.
  using Complex = std::complex<double>;
  const RgbSums sums;
  constexpr double kPi = std::numbers::pi;
  for (const Color& color : kColors) {
    const auto spectrum = moment_spectrum(sums.phases, sums.weights, color);
    // c0 + c1 cos + c2 cos 2 through three bands, whence the signal at every phase.
    std::vector<double> matrix;
    std::vector<double> c;
    for (const std::size_t b : {3, 30, 57}) {
      const double p = sums.phases[b];
      matrix.insert(matrix.end(), {1.0, std::cos(p), std::cos(2 * p)});
      c.push_back(std::tan(kPi * (spectrum[b] - 0.5)));
    }
    ASSERT_TRUE(solve_linear(matrix, c));
    double moments[3] = {};
    constexpr int kParts = 4000;
    for (int i = 0; i < kParts; ++i) {
      const double p = kPi * (i + 0.5) / kParts;
      const double g = 0.5 + std::atan(c[0] + c[1] * std::cos(p) + c[2] * std::cos(2 * p)) / kPi;
      for (int j = 0; j < 3; ++j) moments[j] += g * std::cos(j * p) / kParts;
    }
    // h: coefficients of exp(i pi (G - 1/2)), G = c0 + 2 (c1 z + c2 z^2).
    std::vector<Complex> h = {std::exp(Complex(0, kPi * (moments[0] - 0.5)))};
    h.push_back(Complex(0, 2 * kPi) * moments[1] * h[0]);
    h.push_back(Complex(0, kPi) * (2.0 * moments[2] * h[0] + moments[1] * h[1]));
    // Moments of the density, the real part, and the filter that predicts the next from the two before.
    std::vector<Complex> gamma = {h[0].real(), h[1] / 2.0, h[2] / 2.0};
    const Complex g0 = gamma[0];
    const Complex determinant = g0 * g0 - gamma[1] * std::conj(gamma[1]);
    const Complex a1 = -(gamma[1] * g0 - gamma[2] * std::conj(gamma[1])) / determinant;
    const Complex a2 = -(gamma[2] * g0 - gamma[1] * gamma[1]) / determinant;
    for (int l = 3; l < 4000; ++l) {
      gamma.push_back(-a1 * gamma[static_cast<std::size_t>(l - 1)] -
                      a2 * gamma[static_cast<std::size_t>(l - 2)]);
    }
    for (std::size_t b = 0; b < spectrum.size(); ++b) {
      const Complex z = std::polar(1.0, sums.phases[b]);
      Complex value = Complex(gamma[0].real(), h[0].imag());
      Complex power = 1;
      for (std::size_t l = 1; l < gamma.size(); ++l) value += 2.0 * gamma[l] * (power *= z);
      EXPECT_NEAR(std::arg(value) / kPi + 0.5, spectrum[b], 1e-6) << b;
    }
  }
}

}  // namespace
}  // namespace spectile::test
