// What plausible mistakes would have slipped by: table ends, wrap-around at exactly 1, the density over other
// ranges.
#include <cmath>
#include <spectile/lanes/wavelengths.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

TEST(SpectrumSampler, TablesAtEveryNanometreEndWithTheirLastSample) {
  const auto s = *DenselySampledSpectrum::from_values(500, {1, 2, 4, 8});
  auto lambda = *WavelengthLanes::create(6, 1);
  auto values = *WavelengthLanes::create(6, 1);
  const float nm[] = {std::nextafter(500.0F, 0.0F), 500, 501, 502.5F, 503, std::nextafter(503.0F, 1000.0F)};
  const float want[] = {0, 1, 2, 6, 8, 0};
  for (std::size_t i = 0; i < 6; ++i) lambda.at(i, 0) = nm[i];
  ASSERT_TRUE(sample(s, lambda.view(), values.span()));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(values.at(i, 0), want[i]) << nm[i];
}

TEST(SampleWavelengths, WhatReachesExactlyOneStartsAgain) {
  auto u = *ScalarLanes::create(2);
  u[0] = 0.5F;
  u[1] = 0.75F;
  auto w = *SampledWavelengths::create(2, 4);
  ASSERT_TRUE(sample_wavelengths(WavelengthSampling::kUniform, u.view(), w, 400, 720));
  const float want[2][4] = {{560, 640, 400, 480}, {640, 400, 480, 560}};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(w.lambda_nm.at(i, k), want[i][k]) << i << " " << k;
  }
}

TEST(SampleWavelengths, VisibleOnesFollowTheirDensityOverAnyRange) {
  constexpr std::size_t kLanes = 4096;
  auto u = *ScalarLanes::create(kLanes);
  for (std::size_t i = 0; i < kLanes; ++i) u[i] = (static_cast<float>(i) + 0.5F) / kLanes;
  for (const auto& [first, last] :
       {std::pair{400.0, 700.0}, {360.0, 500.0}, {600.0, 1000.0}, {538.0, 538.5}, {1.0, 10.0}}) {
    auto w = *SampledWavelengths::create(kLanes, 1);
    ASSERT_TRUE(sample_wavelengths(WavelengthSampling::kVisible, u.view(), w, first, last));
    const auto share = [](double nm) { return std::tanh(0.0072 * (nm - 538)); };
    const double whole = share(last) - share(first);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double nm = w.lambda_nm.at(i, 0);
      ASSERT_GE(nm, first - 1e-4);
      ASSERT_LE(nm, last + 1e-4);
      const double c = std::cosh(0.0072 * (nm - 538));
      ASSERT_NEAR(w.density.at(i, 0) * whole * c * c / 0.0072, 1, 1e-5) << first << " to " << last;
      // The share below it is the random number; a wavelength's rounding is 2^-15 nm.
      ASSERT_NEAR((share(nm) - share(first)) / whole, u[i], 1e-6 + 6.2e-5 * w.density.at(i, 0))
          << first << " to " << last;
    }
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

}  // namespace
}  // namespace spectile::test
