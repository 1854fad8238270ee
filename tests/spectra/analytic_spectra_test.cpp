// Black bodies and sums of Gaussians: values, maxima and integrals against their laws and closed forms.
#include <cmath>
#include <limits>
#include <numbers>
#include <spectile/color/response_curves.hpp>
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/radiometry/directions.hpp>
#include <spectile/radiometry/irradiance.hpp>
#include <spectile/radiometry/radiometry.hpp>
#include <spectile/spectra/spectrum.hpp>

#include "tests/spectra/spectra_support.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

long double planck_exactly(long double lambda_nm, long double temperature_k) {
  constexpr long double kH = 6.62607015e-34L;
  constexpr long double kC = 299792458.0L;
  const long double m = lambda_nm / 1e9L;
  const long double x = kH * kC / (m * 1.380649e-23L * temperature_k);
  return 2 * kH * kC * kC / (m * m * m * m * m) / expm1l(x) / 1e9L;
}

/// By the midpoint rule in the wavelength's logarithm.
long double planck_integral(long double first_nm, long double last_nm, long double temperature_k) {
  constexpr int kSteps = 400000;
  const long double step = (logl(last_nm) - logl(first_nm)) / kSteps;
  long double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const long double nm = expl(logl(first_nm) + (i + 0.5L) * step);
    sum += nm * planck_exactly(nm, temperature_k);
  }
  return sum * step;
}

TEST(BlackbodySpectrum, IntegralsFarBeyondThePeakAreWithinTheirBound) {
  for (const double t : {300.0, 6500.0}) {
    const double unit = 1.4387768775e7 / t;  // nm
    for (const double from : {10.0, 1e3, 1e6}) {
      for (const double times : {4.0, 30.0}) {
        const double a = unit * from;
        const auto got = BlackbodySpectrum::create(t)->integral(a, times * a);
        const auto want = static_cast<double>(planck_integral(a, times * a, t));
        EXPECT_NEAR(got / want, 1, 5e-11) << t << " K, " << a << " to " << times * a;  // the sum's own error
      }
    }
  }
}

TEST(BlackbodySpectrum, IntegralsToInfinityFarBeyondThePeakAreWithinTheirBound) {
  // Where Rayleigh and Jeans hold, 2 c k T / (3 lambda^3), to a relative x.
  const double t = 6500;
  const double lambda = 1e12;
  const double want = 2 * 299792458.0 * 1.380649e-23 * t / 3 / std::pow(lambda * 1e-9, 3);
  EXPECT_NEAR(BlackbodySpectrum::create(t)->integral(lambda, std::numeric_limits<double>::infinity()) / want,
              1, 1e-6);
}

TEST(BlackbodySpectrum, ValuesFarBelowThePeakAreWithinTheirBound) {
  const double at[][2] = {{427.94, 60.5255}, {8417.94, 2.84881}, {23.145, 1059.81}, {3.01395e7, 0.00112506}};
  for (const auto& [t, nm] : at) {
    const double bound = std::max(1e-13, 0x1p-51 * 1.4387768775e7 / (nm * t));
    EXPECT_NEAR(static_cast<double>((*BlackbodySpectrum::create(t))(nm) / planck_exactly(nm, t)), 1, bound)
        << t << " K at " << nm;
  }
}

TEST(BlackbodySpectrum, ValuesFarBeyondThePeakAreWithinTheirBound) {
  for (const double nm : {1e9, 1e15}) {
    EXPECT_NEAR(static_cast<double>((*BlackbodySpectrum::create(6500))(nm) / planck_exactly(nm, 6500)), 1,
                1e-13)
        << nm;
  }
}

TEST(GaussianSumSpectrum, MaximumOfALobeNarrowerThanWavelengthsCanBeTold) {
  for (const GaussianSumSpectrum::Lobe lobe :
       {GaussianSumSpectrum::Lobe{1, 550, 1e-14, 1e-14}, {1, 1e17, 1, 1}}) {
    EXPECT_EQ(GaussianSumSpectrum::from_lobes({lobe})->max_value(), 1);
  }
}

TEST(BlackbodySpectrum, SeriesBelowTheirTurnAgreeWithASumInLogarithms) {
  // Ends where h c / (lambda k T) is just below 1: there all the terms of the series count.
  const double unit = 1.4387768775e7 / 3000;  // nm
  const auto s = *BlackbodySpectrum::create(3000);
  for (const double x : {0.999, 0.9, 0.7, 0.5}) {
    const double first = unit / 20;
    const double last = unit / x;
    long double sum = 0;
    constexpr int kSteps = 400000;
    const long double step = (std::log(last) - std::log(first)) / static_cast<long double>(kSteps);
    for (int i = 0; i < kSteps; ++i) {
      const long double nm = expl(logl(first) + (i + 0.5L) * step);
      const long double m = nm / 1e9L;
      const long double e = 6.62607015e-34L * 299792458.0L / (m * 1.380649e-23L * 3000);
      sum += step * nm * 2 * 6.62607015e-34L * 299792458.0L * 299792458.0L / (m * m * m * m * m) / expm1l(e) /
             1e9L;
    }
    EXPECT_NEAR(static_cast<double>(s.integral(first, last) / sum), 1, 3e-12) << x;
  }
}

TEST(BlackbodySpectrum, HasPlancksValues) {
  // From the law with CODATA's radiation constants, worked out by hand to eight digits: 2 h c^2 =
  // 1.191042972e-16 W m^2 sr^-1, h c / k = 1.438776877e-2 m K.
  const auto s = *BlackbodySpectrum::create(6500);
  const double lambda = 500e-9;
  const double want =
      1.191042972e-16 / std::pow(lambda, 5) / (std::exp(1.438776877e-2 / lambda / 6500) - 1) * 1e-9;
  EXPECT_NEAR(s(500) / want, 1, 1e-8);
  EXPECT_EQ(s(0), 0);
  EXPECT_EQ(s(-500), 0);
  EXPECT_EQ(s(1e-300), 0);
  EXPECT_EQ(s(std::numeric_limits<double>::infinity()), 0);
}

TEST(BlackbodySpectrum, ObeysWienAndStefanBoltzmann) {
  for (const double t : {100.0, 1000.0, 2856.0, 6504.0, 25000.0, 1e6}) {
    const auto s = *BlackbodySpectrum::create(t);
    const double peak_nm = 2.897771955e-3 / t * 1e9;  // CODATA 2018
    EXPECT_NEAR(s(peak_nm) / s.max_value(), 1, 1e-12);
    EXPECT_LT(s(peak_nm * 1.001), s.max_value());
    EXPECT_LT(s(peak_nm * 0.999), s.max_value());
    const double whole = s.integral(0, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(std::numbers::pi * whole / (5.670374419e-8 * std::pow(t, 4)), 1, 1e-9) << t;  // CODATA 2018
    // Both ways of integrating agree, and they add up.
    const double split = 2.5 * peak_nm;
    EXPECT_NEAR((s.integral(0, split) + s.integral(split, 1e12 * peak_nm)) / whole, 1, 1e-12) << t;
    double pieces = 0;
    for (double nm = peak_nm; nm < 20 * peak_nm; nm *= 1.25)
      pieces += s.integral(nm, std::min(1.25 * nm, 20 * peak_nm));
    EXPECT_NEAR(pieces / s.integral(peak_nm, 20 * peak_nm), 1, 1e-11) << t;
  }
}

TEST(BlackbodySpectrum, NormalisedIsOneAtItsMaximum) {
  const auto s = *BlackbodySpectrum::create(3200, BlackbodySpectrum::Scale::kNormalized);
  EXPECT_EQ(s.max_value(), 1);
  EXPECT_NEAR(s(2.897771955e6 / 3200), 1, 1e-12);
  const auto absolute = *BlackbodySpectrum::create(3200);
  EXPECT_NEAR(s(555) / absolute(555) * absolute.max_value(), 1, 1e-12);
  EXPECT_NEAR(s.integral(400, 700) / absolute.integral(400, 700) * absolute.max_value(), 1, 1e-12);
}

TEST(BlackbodySpectrum, TemperaturesThatAreNoneAreErrors) {
  for (const double t : {0.0, -5.0, 2e9, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(BlackbodySpectrum::create(t)) << t;
  }
}

TEST(GaussianSumSpectrum, IsTheSumOfItsLobes) {
  // The fit of Wyman, Sloan and Shirley to the x of the CIE 1931 observer (JCGT 2(2), 2013).
  const auto x_bar = *GaussianSumSpectrum::from_lobes(
      {{1.056, 599.8, 37.9, 31.0}, {0.362, 442.0, 16.0, 26.7}, {-0.065, 501.1, 20.4, 26.2}});
  EXPECT_NEAR(x_bar(599.8), 1.056 - 0.065 * std::exp(-0.5 * std::pow(98.7 / 26.2, 2)), 1e-6);
  EXPECT_NEAR(x_bar(600), 1.0622, 0.02);  // CIE 1931
  EXPECT_NEAR(x_bar(440), 0.34828, 0.02);
  EXPECT_NEAR(x_bar.integral(360, 830), riemann(x_bar, 360, 830), 1e-6);
  EXPECT_NEAR(x_bar.integral(360, 830), 106.86, 1);
  EXPECT_NEAR(x_bar.max_value(), 1.056, 1e-3);
  double most = 0;
  for (double nm = 360; nm < 830; nm += 0.001) most = std::max(most, x_bar(nm));
  EXPECT_NEAR(x_bar.max_value() / most, 1, 1e-6);
}

TEST(GaussianSumSpectrum, TheWholeOfALobeIsItsArea) {
  const auto s = *GaussianSumSpectrum::from_lobes({{2, 550, 10, 30}});
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(s.integral(-inf, inf), 2 * std::sqrt(std::numbers::pi / 2) * 40, 1e-12);
  EXPECT_NEAR(s.integral(550, inf), 2 * std::sqrt(std::numbers::pi / 2) * 30, 1e-12);
  EXPECT_EQ(s.max_value(), 2);
  EXPECT_EQ(s.to_text(), "Gaussian 2 at 550 nm, sigma 10 and 30 nm");
  EXPECT_FALSE(GaussianSumSpectrum::from_lobes({}));
  EXPECT_FALSE(GaussianSumSpectrum::from_lobes({{1, 500, 0, 1}}));
  EXPECT_FALSE(GaussianSumSpectrum::from_lobes({{1, std::nan(""), 1, 1}}));
}

TEST(GaussianSumSpectrum, MaximumOfNarrowLobesOnAWideOne) {
  const auto s = *GaussianSumSpectrum::from_lobes(
      {{1, 500, 1e-3, 1e-3}, {1, 500.0015, 1e-3, 1e-3}, {0.1, 600, 300, 300}});
  double most = 0;
  for (double nm = 499.99; nm < 500.01; nm += 1e-7) most = std::max(most, s(nm));
  EXPECT_NEAR(s.max_value() / most, 1, 1e-6);
}

}  // namespace
}  // namespace spectile::test
