// Sums and products of spectra, lines, and spectra made to measure.
#include <gmock/gmock.h>

#include <cmath>
#include <spectile/color/colorimetry.hpp>
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/lanes/wavelength_distribution.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

Spectrum table(std::vector<double> nm, std::vector<double> values, Ends ends = Ends::kZero) {
  return *PiecewiseLinearSpectrum::from_samples(nm, values, ends);
}

std::vector<Spectrum> some_of_each_kind() {
  return {ConstantSpectrum(0.7),
          table({400, 450, 450, 700}, {1, 3, 0.5, 2}),
          table({420, 680}, {0.2, 0.9}, Ends::kHeld),
          *DenselySampledSpectrum::from(*named_spectrum("FL11")),
          *BlackbodySpectrum::create(3000, BlackbodySpectrum::Scale::kNormalized),
          *GaussianSumSpectrum::from_lobes({{1, 550, 20, 30}})};
}

TEST(CombinedSpectra, ValuesAreThoseOfTheArithmetic) {
  for (const Spectrum& a : some_of_each_kind()) {
    for (const Spectrum& b : some_of_each_kind()) {
      const Spectrum sum = a + b;
      const Spectrum difference = a - b;
      const Spectrum product = a * b;
      const Spectrum nested = 2.5 * ((a + b) * b);
      for (double nm = 360.25; nm < 830; nm += 3.7) {
        ASSERT_DOUBLE_EQ(sum(nm), a(nm) + b(nm));
        ASSERT_DOUBLE_EQ(product(nm), a(nm) * b(nm));
        ASSERT_NEAR(difference(nm), a(nm) - b(nm), 1e-15 * (std::abs(a(nm)) + std::abs(b(nm))));
        ASSERT_NEAR(nested(nm), 2.5 * (a(nm) + b(nm)) * b(nm), 1e-14 * std::abs(nested(nm)));
      }
    }
  }
}

TEST(CombinedSpectra, IntegralsAreThoseOfTheParts) {
  const Spectrum y = *named_spectrum("cie1931-y");
  for (const Spectrum& a : some_of_each_kind()) {
    for (const Spectrum& b : some_of_each_kind()) {
      const Spectrum sum = a + 3 * b;
      EXPECT_NEAR(sum.integral(), a.integral() + 3 * b.integral(), 1e-10 * sum.integral());
      EXPECT_NEAR(inner_product(sum, y), inner_product(a, y) + 3 * inner_product(b, y),
                  1e-9 * inner_product(sum, y));
      const Spectrum product = a * b;
      EXPECT_NEAR(product.integral(), inner_product(a, b), 1e-9 * inner_product(a, b));
      EXPECT_NEAR(inner_product(product, y), inner_product(a, b, y), 1e-9 * inner_product(a, b, y));
      const std::vector<float> averages = sum.average_over(Bands());
      const std::vector<float> of_a = a.average_over(Bands());
      const std::vector<float> of_b = b.average_over(Bands());
      for (std::size_t i = 0; i < averages.size(); ++i)
        ASSERT_NEAR(averages[i], of_a[i] + 3 * of_b[i], 1e-6F * averages[i]);
    }
  }
}

TEST(CombinedSpectra, FourTablesMultipliedAreIntegratedToTheirDegree) {
  // x^4 from 0 to 1, on a scale of 100 nm.
  const Spectrum x = table({500, 600}, {0, 1});
  EXPECT_NEAR((x * x * (x * x)).integral(500, 600), 100.0 / 5, 1e-8);
  EXPECT_NEAR(inner_product(x * x, x), 100.0 / 4, 1e-12);
}

TEST(CombinedSpectra, SamplersGiveTheirValues) {
  const Spectrum lines = *emission_lines(std::vector<EmissionLine>{{435.8, 2}, {546.1, 5}});
  const Spectrum combined = 0.5 * *named_spectrum("D65") + 20 * (lines * *named_spectrum("FL2")) +
                            *BlackbodySpectrum::create(4000, BlackbodySpectrum::Scale::kNormalized);
  const auto sampler = SpectrumSampler::create(combined);
  ASSERT_TRUE(sampler) << sampler.error().message;
  SampledSpectra lambda = own_batch(300, 2);
  for (std::size_t i = 0; i < 300; ++i) {
    lambda.at(i, 0) = 360 + 1.5F * static_cast<float>(i);
    lambda.at(i, 1) = i == 7 ? kNan : 545.7F + 0.003F * static_cast<float>(i);
  }
  SampledSpectra values = own_batch(300, 2);
  ASSERT_TRUE(sampler->sample(lambda, values));
  for (std::size_t i = 0; i < 300; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const auto nm = static_cast<double>(lambda.at(i, k));
      if (std::isnan(nm)) {
        EXPECT_TRUE(std::isnan(values.at(i, k)));
        continue;
      }
      // Knots are rounded to float, by 3e-5 nm at most, and slopes pass that on.
      const double below = std::abs(combined(nm) - combined(nm - 0.01));
      const double above = std::abs(combined(nm + 0.01) - combined(nm));
      const double slope = std::max(below, above) / 0.01;
      ASSERT_NEAR(values.at(i, k), combined(nm), 2e-6 * combined(nm) + 1e-4 * slope) << nm;
    }
  }
  SampledSpectra in_place = *lambda.clone();
  ASSERT_TRUE(sampler->sample(in_place, in_place));
  EXPECT_TRUE(same_lanes(in_place, values));
}

TEST(CombinedSpectra, AsLightsTheyKeepTheirLinesAndSteps) {
  const Spectrum ground = table({400, 500, 500, 700}, {1, 2, 1, 3});
  const Spectrum lines = *emission_lines(std::vector<EmissionLine>{{546.13, 40}, {611.37, 25}}, 0.3);
  const Spectrum sum = ground + lines;
  const auto light = named_light("lamp", sum);
  ASSERT_TRUE(light) << light.error().message;
  EXPECT_NEAR(light->spectrum.integral(360, 830), sum.integral(), 1e-6 * sum.integral());
  EXPECT_NEAR(light->spectrum.integral(545, 547), sum.integral(545, 547), 1e-6);
  EXPECT_NEAR(light->spectrum.at(499.9), sum(499.9), 1e-9);
  EXPECT_NEAR(light->spectrum.at(500), 1, 1e-12);
  const auto projector = Projector::reflective(Bands(), sum);
  ASSERT_TRUE(projector);
  const auto drawn = WavelengthDistribution::of_light(sum);
  EXPECT_TRUE(drawn);
}

TEST(EmissionLines, HaveTheirPowersAndTheirWidth) {
  const std::vector<EmissionLine> lines = {{500, 3}, {500.4, 2}, {600, 1}};
  const Spectrum s = *emission_lines(lines, 0.5);
  EXPECT_NEAR(s.integral(), 6, 1e-12);
  EXPECT_NEAR(s.integral(595, 605), 1, 1e-12);
  EXPECT_DOUBLE_EQ(s(600), 2);
  EXPECT_DOUBLE_EQ(s(600.25), 1);
  EXPECT_EQ(s(600.6), 0);
  EXPECT_NEAR(s(500), 3 / 0.5 + 2 / 0.5 * 0.2, 1e-12);
  EXPECT_EQ(code_of(emission_lines({}, 1)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(emission_lines(lines, 0)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(emission_lines(std::vector<EmissionLine>{{std::nan(""), 1}})),
            code(ErrorCode::kBadArgument));
}

TEST(SpectraMadeToMeasure, HaveTheLuminanceOrTheMaximumAskedFor) {
  const Spectrum y = *named_spectrum("cie1931-y");
  for (const Spectrum& s : some_of_each_kind()) {
    const Spectrum lit = *with_luminance(s, 36);
    EXPECT_NEAR(inner_product(lit, y) / y.integral(), 36, 1e-8);
    EXPECT_NEAR(lit(550) / lit(600), s(550) / s(600), 1e-12);
    EXPECT_NEAR(with_maximum(s, 4)->max_value(), 4, 1e-5);
  }
  EXPECT_EQ(code_of(with_luminance(ConstantSpectrum(0))), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(with_luminance(table({850, 900}, {1, 1}))), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(with_maximum(ConstantSpectrum(-1))), code(ErrorCode::kBadArgument));
}

TEST(SampledFunctions, AreLinearBetweenTheirSteps) {
  const Spectrum s = *sampled_function([](double nm) { return nm * nm; }, 400, 700, 10);
  EXPECT_EQ(s(400), 160000);
  EXPECT_EQ(s(405), (160000 + 168100) / 2.0);
  EXPECT_EQ(s(700), 490000);
  EXPECT_EQ(s(701), 0);
  const Spectrum odd = *sampled_function([](double nm) { return nm; }, 400, 405, 2, Ends::kHeld);
  EXPECT_EQ(odd(404.5), 404.5);
  EXPECT_EQ(odd(900), 405);
  const auto one = [](double) { return 1.0; };
  EXPECT_EQ(code_of(sampled_function(one, 700, 400)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(sampled_function(one, 400, 700, 0)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(sampled_function(one, 400, 700, 1e-9)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(sampled_function([](double) { return std::nan(""); })), code(ErrorCode::kBadArgument));
}

TEST(Spectra, AreEqualWhereTheirNumbersAre) {
  const std::vector<Spectrum> once = some_of_each_kind();
  const std::vector<Spectrum> again = some_of_each_kind();
  for (std::size_t i = 0; i < once.size(); ++i) {
    for (std::size_t j = 0; j < once.size(); ++j) EXPECT_EQ(once[i] == again[j], i == j) << i << ' ' << j;
    EXPECT_TRUE(once[i] + once[0] == again[i] + again[0]);
    EXPECT_FALSE(once[i] + once[0] == once[i] + once[1]);
    EXPECT_FALSE(once[i] == 2 * once[i]);
  }
  EXPECT_FALSE(table({400, 500}, {1, 2}) == table({400, 500}, {1, 2}, Ends::kHeld));
  EXPECT_TRUE(Spectrum(*illuminant("A")) == Spectrum(*illuminant("A")));
}

}  // namespace
}  // namespace spectile::test
