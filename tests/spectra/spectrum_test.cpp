// Distributions: values, maxima and integrals against definitions, closed forms and sums worked out
// otherwise.
#include <numbers>
#include <spectile/spectra/spectrum.hpp>
#include <spectile/upsampling/rgb_spectrum.hpp>

#include "tests/spectra/spectra_support.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

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

TEST(InnerProduct, OfABlackBodyOverAVeryWideRangeIsItsIntegral) {
  const auto s = *BlackbodySpectrum::create(6500);
  for (const double last : {1e10, 1e11, 1e12, 1e13}) {
    EXPECT_NEAR(inner_product(ConstantSpectrum(1), s, 1, last) / s.integral(1, last), 1, 1e-9) << last;
  }
}

TEST(DenselySampledSpectrum, ItsLastValueIsThatOfTheTable) {
  EXPECT_EQ((*DenselySampledSpectrum::from_values(500, {1e17, 1}))(501), 1);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 100; ++i) {
    const double last = unit(random);
    ASSERT_EQ((*DenselySampledSpectrum::from_values(500, {unit(random), last}))(501), last) << i;
  }
}

TEST(DenselySampledSpectrum, FiniteValuesOfAnySizeAreThemselves) {
  const auto s = *DenselySampledSpectrum::from_values(500, {1.5e308, -1.5e308});
  EXPECT_EQ(s(500), 1.5e308);
  EXPECT_EQ(s(500.5), 0);
}

TEST(DenselySampledSpectrum, TheRangeMayEndAtTheGreatestInt) {
  EXPECT_EQ(DenselySampledSpectrum::from(ConstantSpectrum(1), 2147483640, 2147483647)->values().size(), 8U);
  const auto beyond = DenselySampledSpectrum::from_values(2147483647, {1, 2});
  EXPECT_TRUE(!beyond || beyond->last_nm() > beyond->first_nm());
}

TEST(PiecewiseLinearSpectrum, MaximumIsTheLargestSample) {
  const double nm[] = {400, 500, 500, 500, 600};
  const double v[] = {0, 0, 9, 0, 0};  // the middle of three is neither on the left nor on the right
  const auto s = *PiecewiseLinearSpectrum::from_samples(nm, v);
  EXPECT_EQ(s(500), 0);
  EXPECT_EQ(s.max_value(), 9);  // the largest sample, as documented
}

TEST(InnerProduct, OfTwoGaussiansIsTheClosedForm) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const double s1 = std::pow(10, -3 + 5 * unit(random));
    const double s2 = std::pow(10, -3 + 5 * unit(random));
    const double m1 = 400 + 300 * unit(random);
    // Every third pair is so close that the product lies in both's tails.
    const double m2 =
        i % 3 == 0 ? m1 + (24 * unit(random) - 12) * std::max(s1, s2) : 400 + 300 * unit(random);
    const double square = s1 * s1 + s2 * s2;
    const double sigma = s1 * s2 / std::sqrt(square);
    const double mean = (m1 * s2 * s2 + m2 * s1 * s1) / square;
    const double want =
        std::exp(-0.5 * (m1 - m2) * (m1 - m2) / square) * std::sqrt(2 * std::numbers::pi) * sigma;
    if (want < 1e-280) continue;
    ++compared;
    const auto a = *GaussianSumSpectrum::from_lobes({{1, m1, s1, s1}});
    const auto b = *GaussianSumSpectrum::from_lobes({{1, m2, s2, s2}});
    const double half_width = 60 * (s1 + s2) + 100;
    ASSERT_NEAR(inner_product(a, b, mean - half_width, mean + half_width) / want, 1, 1e-9)
        << a.to_text() << ", " << b.to_text();
  }
  EXPECT_GT(compared, 200);
}

TEST(InnerProduct, SpikesAndLinesAgainstABlackBodyAreItsValueThere) {
  const auto black = *BlackbodySpectrum::create(6500, BlackbodySpectrum::Scale::kNormalized);
  for (const double at : {400.0, 555.5, 829.0}) {
    const double nm[] = {at - 1e-3, at, at + 1e-3};
    const double v[] = {0, 1, 0};
    EXPECT_NEAR(inner_product(*PiecewiseLinearSpectrum::from_samples(nm, v), black) / (1e-3 * black(at)), 1,
                1e-9);
    const auto line = *GaussianSumSpectrum::from_lobes({{1, at, 0.01, 0.01}});
    // To second order: half the square of sigma times the curvature.
    const double curvature = (black(at + 1) - 2 * black(at) + black(at - 1)) / black(at);
    EXPECT_NEAR(inner_product(line, black) / (0.01 * std::sqrt(2 * std::numbers::pi) * black(at)),
                1 + 0.5e-4 * curvature, 1e-9);
    const double one[] = {at};
    EXPECT_EQ(inner_product(*PiecewiseLinearSpectrum::from_samples(one, std::array{5.0}), black), 0);
  }
}

}  // namespace
}  // namespace spectile::test
