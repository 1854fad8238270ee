// Distributions: values, maxima and integrals against definitions, closed forms and sums worked out
// otherwise.
#include <numbers>
#include <spectile/spectra/spectrum.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

/// A midpoint sum: slow, and nothing like what the library does.
template <class Function>
double riemann(const Function& f, double first, double last, int steps = 400000) {
  double sum = 0;
  const double step = (last - first) / steps;
  for (int i = 0; i < steps; ++i) sum += f(first + (i + 0.5) * step);
  return sum * step;
}

PiecewiseLinearSpectrum triangle() {
  const double nm[] = {500, 550, 650};
  const double v[] = {0, 2, 1};
  return *PiecewiseLinearSpectrum::from_samples(nm, v);
}

TEST(ConstantSpectrum, IsTheSameEverywhere) {
  const ConstantSpectrum s(0.25);
  EXPECT_EQ(s(-1e9), 0.25);
  EXPECT_EQ(s.max_value(), 0.25);
  EXPECT_EQ(s.integral(400, 700), 75);
  EXPECT_EQ(s.integral(700, 400), 0);
  EXPECT_EQ(s.average_over(Bands())[59], 0.25F);
  EXPECT_EQ(s.to_text(), "constant 0.25");
}

TEST(PiecewiseLinearSpectrum, IsLinearBetweenItsSamplesAndZeroOutside) {
  const auto s = triangle();
  EXPECT_EQ(s(525), 1);
  EXPECT_EQ(s(600), 1.5);
  EXPECT_EQ(s(650), 1);
  EXPECT_EQ(s(650.0001), 0);
  EXPECT_EQ(s(499.999), 0);
  EXPECT_EQ(s(std::numeric_limits<double>::infinity()), 0);
  EXPECT_TRUE(std::isnan(s(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_EQ(s.max_value(), 2);
  EXPECT_DOUBLE_EQ(s.integral(-1e6, 1e6), 50 + 150);
  EXPECT_DOUBLE_EQ(s.integral(525, 550), 37.5);
  EXPECT_EQ(s.integral(700, 800), 0);
  // Averaging a measured reflectance goes on with its ends; a lamp's spectrum does not.
  EXPECT_EQ(s.measured().integral(650, 700), 50);
  EXPECT_EQ(s.to_text(), "piecewise linear, 3 samples from 500 to 650 nm");
}

TEST(PiecewiseLinearSpectrum, WhatIsBelowZeroEverywhereIsMostOutside) {
  const double nm[] = {500, 600};
  const double v[] = {-2, -1};
  EXPECT_EQ(PiecewiseLinearSpectrum::from_samples(nm, v)->max_value(), 0);
}

TEST(PiecewiseLinearSpectrum, AveragesOverAnyBandsAreThoseOfASum) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int table = 0; table < 200; ++table) {
    std::vector<double> nm;
    std::vector<double> v;
    double at = 380 + 60 * unit(random);
    const int count = 2 + static_cast<int>(random() % 30);
    for (int i = 0; i < count; ++i) {
      nm.push_back(at);
      v.push_back(unit(random) * 3 - 1);
      at += random() % 7 == 0 ? 0 : 20 * unit(random);  // steps among them
    }
    const auto s = *PiecewiseLinearSpectrum::from_samples(nm, v);
    // Wholly outside, touching the ends, narrower than the samples' spacing, wider than all.
    const double edges[] = {300,       350,           nm.front(), nm.front() + 0.3, nm.front() + 7.1,
                            nm.back(), nm.back() + 4, 2000};
    for (std::size_t i = 1; i < std::size(edges); ++i) {
      const double a = edges[i - 1];
      const double b = edges[i];
      if (!(b > a)) continue;
      const int steps = 20000;
      ASSERT_NEAR(s.integral(a, b), riemann(s, a, b, steps), 3 * (b - a) / steps * (count + 2)) << table;
    }
  }
}

TEST(DenselySampledSpectrum, IsItsSpectrumAtEveryNanometre) {
  const auto black = *BlackbodySpectrum::create(5000);
  const auto dense = *DenselySampledSpectrum::from(Spectrum(black));
  EXPECT_EQ(dense.first_nm(), 360);
  EXPECT_EQ(dense.last_nm(), 830);
  EXPECT_EQ(dense.values().size(), 471U);
  for (int nm = 360; nm <= 830; ++nm) ASSERT_EQ(dense(nm), black(nm));
  EXPECT_DOUBLE_EQ(dense(400.25), 0.75 * black(400) + 0.25 * black(401));
  EXPECT_EQ(dense(359.999), 0);
  EXPECT_EQ(dense(830.001), 0);
  EXPECT_NEAR(dense.integral(380.3, 401.9), riemann(dense, 380.3, 401.9), 1e-7);
  EXPECT_EQ(dense.integral(900, 1000), 0);
  EXPECT_EQ(dense.max_value(), *std::max_element(dense.values().begin(), dense.values().end()));
}

TEST(DenselySampledSpectrum, RangesWithoutALengthAndValuesThatAreNoneAreErrors) {
  const Spectrum one = ConstantSpectrum(1);
  EXPECT_FALSE(DenselySampledSpectrum::from(one, 500, 500));
  EXPECT_FALSE(DenselySampledSpectrum::from(one, 600, 500));
  EXPECT_FALSE(DenselySampledSpectrum::from(one, -2000000000, 2000000000));
  EXPECT_FALSE(DenselySampledSpectrum::from_values(400, {1}));
  const auto bad = DenselySampledSpectrum::from_values(400, {1, std::nan("")});
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().message, "the value at 401 nm is nan; it must be finite");
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

TEST(UpsampledSpectrum, AtTheCentresItIsWhatTheBatchMakes) {
  for (const Method method : {Method::kSmitsExact, Method::kMallett, Method::kSigmoid}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
      const auto upsampler = *Upsampler::create(method, quantity, Bands());
      const std::array<double, 3> rgb = {0.8, 0.35, 0.1};
      const auto s = *UpsampledSpectrum::from_rgb(upsampler, rgb);
      auto lanes = *ColorLanes::create(1);
      for (std::size_t k = 0; k < 3; ++k) lanes.at(0, k) = static_cast<float>(rgb[k]);
      auto batch = *SampledSpectra::create(Bands(), 1);
      ASSERT_TRUE(upsample_srgb(upsampler, lanes.view(), batch.span()));
      for (std::size_t b = 0; b < 60; ++b) {
        const double want = batch.at(0, b);
        ASSERT_NEAR(s(Bands()[b].centre_nm), want, 2e-6 * std::max(1.0, want)) << to_string(method) << b;
      }
      EXPECT_EQ(s(0), s(402.5));
      EXPECT_EQ(s(5000), s(697.5));
      EXPECT_NEAR(s.integral(380, 750), riemann(s, 380, 750), 1e-5 * s.integral(380, 750));
      double most = 0;
      for (double nm = 402.5; nm <= 697.5; nm += 0.01) most = std::max(most, s(nm));
      EXPECT_NEAR(s.max_value() / most, 1, 1e-6);
      EXPECT_FALSE(s.to_text().empty());
    }
  }
}

TEST(UpsampledSpectrum, QuantitiesAreNotConfused) {
  const auto reflectances = *Upsampler::create(Method::kSigmoid, Quantity::kReflectance, Bands());
  const auto unbounded = *Upsampler::create(Method::kSigmoid, Quantity::kUnbounded, Bands());
  const auto lights = *Upsampler::create(Method::kSigmoid, Quantity::kIlluminant, Bands());
  EXPECT_TRUE(rgb_albedo_spectrum(reflectances, {0.5, 0.2, 1}));
  EXPECT_TRUE(rgb_unbounded_spectrum(unbounded, {5, 0.2, 1}));
  EXPECT_TRUE(rgb_illuminant_spectrum(lights, {5, 0.2, 1}));
  EXPECT_FALSE(rgb_albedo_spectrum(reflectances, {1.5, 0.2, 1}));
  EXPECT_FALSE(rgb_albedo_spectrum(lights, {0.5, 0.2, 1}));
  EXPECT_FALSE(rgb_unbounded_spectrum(reflectances, {0.5, 0.2, 1}));
  EXPECT_FALSE(rgb_illuminant_spectrum(unbounded, {0.5, 0.2, 1}));
  EXPECT_FALSE(rgb_unbounded_spectrum(unbounded, {5, -3, 1}));
  EXPECT_FALSE(rgb_illuminant_spectrum(lights, {5, std::nan(""), 1}));
  EXPECT_FALSE(rgb_illuminant_spectrum(lights, {1e300, 0, 1}));
}

TEST(UpsampledSpectrum, WhiteLightIsItsIlluminantWithLuminanceOne) {
  const auto lights = *Upsampler::create(Method::kSigmoid, Quantity::kIlluminant, *Bands::parse("360:830:5"));
  const auto white = *rgb_illuminant_spectrum(lights, {1, 1, 1});
  const auto d65 = *illuminant("D65");
  for (const double nm : {400.0, 450.0, 555.0, 620.0}) {
    EXPECT_NEAR(white(nm) / white(560), d65.at(nm) / d65.at(560), 0.03) << nm;  // averages over 5 nm
  }
}

TEST(Spectrum, IsWhicheverDistribution) {
  const Spectrum all[] = {ConstantSpectrum(2), triangle(), *DenselySampledSpectrum::from(triangle()),
                          *BlackbodySpectrum::create(4000),
                          *GaussianSumSpectrum::from_lobes({{1, 550, 30, 30}})};
  for (const Spectrum& s : all) {
    const double nm[] = {450, 550, 600.5};
    const auto values = s.sample(nm);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(values[i], s(nm[i]));
    EXPECT_GE(s.max_value(), s(600.5));
    EXPECT_FALSE(s.to_text().empty());
    const Bands bands = *Bands::parse("380:780:10");
    const auto averages = s.average_over(bands);
    for (std::size_t b = 0; b < bands.count(); ++b) {
      EXPECT_FLOAT_EQ(averages[b], static_cast<float>(s.integral(bands[b].lower_nm, bands[b].upper_nm) / 10));
    }
  }
  EXPECT_EQ(Spectrum(triangle()).integral(), 200);
}

TEST(InnerProduct, IsTheIntegralOfTheProduct) {
  const auto gaussian = *GaussianSumSpectrum::from_lobes({{1, 550, 30, 12}, {0.5, 610, 1, 1}});
  const auto light = *Upsampler::create(Method::kSigmoid, Quantity::kIlluminant, Bands());
  const Spectrum all[] = {ConstantSpectrum(2),
                          triangle(),
                          *DenselySampledSpectrum::from(gaussian, 400, 700),
                          *BlackbodySpectrum::create(4000),
                          gaussian,
                          *rgb_illuminant_spectrum(light, {0.9, 0.5, 0.2}),
                          PiecewiseLinearSpectrum(*illuminant("FL11"))};
  for (const Spectrum& a : all) {
    for (const Spectrum& b : all) {
      const double got = inner_product(a, b);
      const double want = riemann([&](double nm) { return a(nm) * b(nm); }, 360, 830, 200000);
      EXPECT_NEAR(got, want, 1e-5 * std::abs(want) + 1e-12) << a.to_text() << ", " << b.to_text();
      EXPECT_EQ(got, inner_product(b, a));
    }
  }
}

TEST(InnerProduct, IsExactForWhatIsLinear) {
  // The square of a triangle: of 2 (x / 50) over 50 nm, then of 2 - x / 100 over 100 nm.
  EXPECT_DOUBLE_EQ(inner_product(triangle(), triangle()), 4.0 * 50 / 3 + (8 - 1) * 100.0 / 3);
  EXPECT_NEAR(inner_product(triangle(), ConstantSpectrum(3), 500, 550), 150, 1e-11);
  EXPECT_EQ(inner_product(triangle(), triangle(), 700, 800), 0);
  EXPECT_EQ(inner_product(triangle(), triangle(), 600, 500), 0);
}

}  // namespace
}  // namespace spectile::test
