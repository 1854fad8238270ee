// MeasuredSpectrum: samples in any order, exact averages and integrals, illuminants by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <spectile/spectra/measured_spectrum.hpp>
#include <vector>

#include "src/reference/oracle/oracle.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using Doubles = std::vector<double>;

MeasuredSpectrum spectrum(const Doubles& wavelengths, const Doubles& values) {
  return *MeasuredSpectrum::from_samples(wavelengths, values);
}

/// Samples at irregular places from 350 to 800 nm, in ascending order.
struct Samples {
  Doubles wavelengths, values;
};
Samples irregular(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Samples s;
  for (std::size_t i = 0; i < count; ++i) {
    s.wavelengths.push_back(350 +
                            450 * (static_cast<double>(i) + 0.9 * unit(random)) / static_cast<double>(count));
    s.values.push_back(unit(random));
  }
  return s;
}

TEST(MeasuredSpectrum, KeepsItsOwnSortedCopyAndLeavesTheCallersAlone) {
  const Doubles wavelengths = {600, 400, 500};
  const Doubles values = {3, 1, 2};
  Doubles given_wavelengths = wavelengths;
  Doubles given_values = values;
  const auto s = MeasuredSpectrum::from_samples(given_wavelengths, given_values);
  ASSERT_TRUE(s);
  EXPECT_EQ(given_wavelengths, wavelengths);
  EXPECT_EQ(given_values, values);
  given_values.assign(3, -1);
  EXPECT_THAT(s->wavelengths_nm(), testing::ElementsAre(400, 500, 600));
  EXPECT_THAT(s->values(), testing::ElementsAre(1, 2, 3));
}

TEST(MeasuredSpectrum, OrderOfTheSamplesDoesNotMatter) {
  const Samples s = irregular(40, 1);
  std::vector<std::size_t> order(40);
  for (std::size_t i = 0; i < 40; ++i) order[i] = (i * 17) % 40;
  Samples shuffled;
  for (const std::size_t i : order) {
    shuffled.wavelengths.push_back(s.wavelengths[i]);
    shuffled.values.push_back(s.values[i]);
  }
  const Bands bands;
  EXPECT_EQ(spectrum(shuffled.wavelengths, shuffled.values).average_over(bands),
            spectrum(s.wavelengths, s.values).average_over(bands));
  EXPECT_EQ(*average_over(bands, shuffled.wavelengths, shuffled.values),
            spectrum(s.wavelengths, s.values).average_over(bands));
}

TEST(MeasuredSpectrum, IsLinearBetweenSamplesAndConstantBeyond) {
  const auto s = spectrum({400, 500, 600}, {1, 3, 0});
  EXPECT_EQ(s.at(400), 1);
  EXPECT_EQ(s.at(450), 2);
  EXPECT_EQ(s.at(500), 3);
  EXPECT_DOUBLE_EQ(s.at(590), 0.3);
  EXPECT_EQ(s.at(600), 0);
  EXPECT_EQ(s.at(0), 1);
  EXPECT_EQ(s.at(-1e9), 1);
  EXPECT_EQ(s.at(1e9), 0);
}

TEST(MeasuredSpectrum, TwoSamplesAtOnePlaceAreAStep) {
  // Also out of order: of the samples at 500 the first given is on the left.
  for (const auto& s :
       {spectrum({400, 500, 500, 600}, {1, 1, 5, 5}), spectrum({600, 500, 400, 500}, {5, 1, 1, 5})}) {
    EXPECT_EQ(s.at(std::nextafter(500.0, 0.0)), 1);
    EXPECT_EQ(s.at(500), 5);
    EXPECT_DOUBLE_EQ(s.integral(490, 510), 60);
    const auto averages = s.average_over(*Bands::uniform(480, 520, 20));
    EXPECT_THAT(averages, testing::ElementsAre(1.0F, 5.0F));
    EXPECT_FLOAT_EQ(s.average_over(*Bands::uniform(490, 510, 20))[0], 3.0F);
  }
}

TEST(MeasuredSpectrum, StepsKeepTheirSidesAmongManySamplesInAnyOrder) {
  // 200 steps of 1 on the left and 3 on the right, whose wavelengths come in a mixed order.
  Doubles wavelengths;
  Doubles values;
  for (const double value : {1.0, 3.0}) {
    for (int i = 0; i < 200; ++i) {
      wavelengths.push_back(400 + (i * 77) % 200);
      values.push_back(value);
    }
  }
  const auto s = spectrum(wavelengths, values);
  for (int l = 400; l < 600; ++l) ASSERT_EQ(s.at(l), 3) << l;
  for (int l = 400; l < 599; ++l) ASSERT_DOUBLE_EQ(s.at(l + 0.75), 1.5) << l;
}

TEST(MeasuredSpectrum, StepsAtTheEndsHaveTheirOuterValueBeyond) {
  const auto s = spectrum({400, 400, 500, 500}, {0, 2, 2, 0});
  EXPECT_EQ(s.at(399), 0);
  EXPECT_EQ(s.at(400), 2);
  EXPECT_EQ(s.at(500), 0);
  EXPECT_DOUBLE_EQ(s.integral(300, 600), 200);
}

TEST(MeasuredSpectrum, OfThreeSamplesAtOnePlaceFirstAndLastCount) {
  const auto s = spectrum({400, 500, 500, 500, 600}, {1, 1, 1000, 3, 3});
  EXPECT_EQ(s.at(500), 3);
  EXPECT_DOUBLE_EQ(s.integral(450, 550), 200);
}

TEST(MeasuredSpectrum, OneSampleIsAConstant) {
  const auto s = spectrum({550}, {0.25});
  EXPECT_EQ(s.at(100), 0.25);
  EXPECT_EQ(s.at(900), 0.25);
  EXPECT_DOUBLE_EQ(s.integral(400, 700), 75);
  for (const float average : s.average_over(Bands())) EXPECT_EQ(average, 0.25F);
}

TEST(MeasuredSpectrum, RejectsWhatIsNotASpectrum) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const auto of = [](const Doubles& w, const Doubles& v) {
    return code_of(MeasuredSpectrum::from_samples(w, v));
  };
  EXPECT_EQ(of({}, {}), code(ErrorCode::kBadArgument));
  EXPECT_EQ(of({400, 500}, {1}), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(of({}, {1}), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(of({400, nan}, {1, 2}), code(ErrorCode::kBadArgument));
  EXPECT_EQ(of({400, inf}, {1, 2}), code(ErrorCode::kBadArgument));
  EXPECT_EQ(of({400, 500}, {1, nan}), code(ErrorCode::kBadArgument));
  EXPECT_EQ(of({400, 500}, {-inf, 1}), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(average_over(Bands(), Doubles{400, 500}, Doubles{1})), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(average_over(Bands(), Doubles{400}, Doubles{nan})), code(ErrorCode::kBadArgument));
  const auto bad = MeasuredSpectrum::from_samples(Doubles{400, 500}, Doubles{1, nan});
  EXPECT_THAT(bad.error().message, testing::HasSubstr("500"));
}

TEST(MeasuredSpectrum, AveragesAreTheOnesWorkedOutByHand) {
  // A triangle from 0 at 400 over 10 at 410 to 0 at 420: a band's average is the area above it by its width.
  const auto s = spectrum({400, 410, 420}, {0, 10, 0});
  EXPECT_THAT(s.average_over(*Bands::uniform(390, 430, 10)), testing::ElementsAre(0.0F, 5.0F, 5.0F, 0.0F));
  EXPECT_THAT(s.average_over(*Bands::uniform(405, 415, 10)), testing::ElementsAre(7.5F));
  EXPECT_THAT(s.average_over(*Bands::uniform(400, 440, 40)), testing::ElementsAre(2.5F));
  const auto gaps = *Bands::from_list({{402, 403, 404}, {415, 419, 425}});
  EXPECT_THAT(s.average_over(gaps), testing::ElementsAre(3.0F, 1.25F));
}

TEST(MeasuredSpectrum, AveragesAreConstantBeyondBothEnds) {
  const auto s = spectrum({500, 600}, {2, 4});
  const auto averages = s.average_over(*Bands::uniform(400, 700, 50));
  EXPECT_THAT(averages, testing::ElementsAre(2.0F, 2.0F, 2.5F, 3.5F, 4.0F, 4.0F));
}

TEST(MeasuredSpectrum, AveragesAgreeWithTheOracleForFewerAndMoreSamplesThanBands) {
  for (const std::size_t count : {2, 5, 60, 977}) {
    const Samples s = irregular(count, static_cast<std::uint32_t>(count));
    for (const Bands& bands :
         {Bands(), *Bands::uniform(300, 900, 0.5), *Bands::parse("380,500,510,511,640")}) {
      const auto averages = *average_over(bands, s.wavelengths, s.values);
      ASSERT_EQ(averages.size(), bands.count());
      for (std::size_t b = 0; b < bands.count(); ++b) {
        const double exact = oracle::average(s.wavelengths, s.values, bands[b].lower_nm, bands[b].upper_nm);
        // Rounded to float once; the oracle's difference of integrals of up to 500 cancels down to 1e-12 /
        // width.
        EXPECT_NEAR(averages[b], exact, 0x1p-24 * std::abs(exact) + 1e-11);
      }
    }
  }
}

TEST(MeasuredSpectrum, IntegralsAdd) {
  const Samples s = irregular(77, 9);
  const auto m = spectrum(s.wavelengths, s.values);
  const double whole = m.integral(300, 900);
  for (const double middle : {300.0, 310.0, 402.34567, s.wavelengths[40], 899.0, 900.0}) {
    EXPECT_NEAR(m.integral(300, middle) + m.integral(middle, 900), whole, 1e-14 * 600) << middle;
  }
  double sum = 0;
  for (int l = 300; l < 900; ++l) sum += m.integral(l, l + 1);
  EXPECT_NEAR(sum, whole, 1e-13 * 600);
  EXPECT_EQ(m.integral(500, 500), 0);
}

TEST(MeasuredSpectrum, ProductIntegralAgreesWithBruteForce) {
  const Samples a = irregular(23, 11);
  const Samples b = irregular(8, 12);
  const auto p = spectrum(a.wavelengths, a.values);
  const auto q = spectrum(b.wavelengths, b.values);
  for (const auto& [first, last] :
       {std::pair(300.0, 900.0), std::pair(421.5, 433.25), std::pair(500.0, 500.01)}) {
    constexpr int kSteps = 400000;
    const double h = (last - first) / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double l = first + (i + 0.5) * h;
      sum += p.at(l) * q.at(l);
    }
    // The midpoint rule's own error is h^2/24 times the jump of the slope, at kinks, times the count of
    // those.
    EXPECT_NEAR(product_integral(p, q, first, last), sum * h, 1e-7 * (last - first)) << first;
    EXPECT_DOUBLE_EQ(product_integral(p, q, first, last), product_integral(q, p, first, last));
  }
}

TEST(MeasuredSpectrum, ProductIntegralIsExactForStraightLinesAndSteps) {
  const auto ramp = spectrum({0, 1000}, {0, 1000});
  EXPECT_NEAR(product_integral(ramp, ramp, 100, 400), (64e6 - 1e6) / 3, 1e-6);
  const auto step = spectrum({200, 200}, {0, 2});
  EXPECT_NEAR(product_integral(ramp, step, 100, 400), 400 * 400 - 200 * 200, 1e-8);
  EXPECT_NEAR(product_integral(ramp, spectrum({1}, {1}), 100, 400), ramp.integral(100, 400), 1e-9);
}

TEST(MeasuredSpectrum, ScaledMultipliesEveryValue) {
  const auto s = spectrum({400, 500}, {1, -3}).scaled(-2);
  EXPECT_THAT(s.values(), testing::ElementsAre(-2, 6));
  EXPECT_THAT(s.wavelengths_nm(), testing::ElementsAre(400, 500));
}

TEST(Illuminants, NamesWorkInAnyCase) {
  const std::pair<const char*, const char*> pairs[] = {
      {"d65", "D65"}, {"fl11", "FL11"}, {"led-rgb1", "LED-RGB1"}};
  for (const auto& [lower, upper] : pairs) {
    const auto a = illuminant(lower);
    const auto b = illuminant(upper);
    ASSERT_TRUE(a) << lower;
    ASSERT_TRUE(b) << upper;
    EXPECT_TRUE(std::ranges::equal(a->values(), b->values()));
  }
  EXPECT_EQ(illuminant("D65")->at(560), 100);
  EXPECT_EQ(illuminant("A")->at(560), 100);
}

TEST(Illuminants, EveryNameListedIsThere) {
  const char* const documented[] = {"A",   "C",    "D50",  "D55",  "D60", "D65",    "D75",    "E",
                                    "FL1", "FL2",  "FL3",  "FL4",  "FL5", "FL6",    "FL7",    "FL8",
                                    "FL9", "FL10", "FL11", "FL12", "HP1", "LED-B1", "LED-B3", "LED-RGB1"};
  EXPECT_THAT(illuminant_names(), testing::UnorderedElementsAreArray(documented));
  for (const std::string& name : illuminant_names()) {
    const auto light = illuminant(name);
    ASSERT_TRUE(light) << name;
    EXPECT_GT(light->integral(400, 700), 0) << name;
  }
}

TEST(Illuminants, UnknownNameIsAnErrorThatListsTheNames) {
  for (const char* name : {"", "D6", "D650", "D 65", "FL13", "D65 "}) {
    const auto light = illuminant(name);
    EXPECT_EQ(code_of(light), code(ErrorCode::kUnknownName)) << name;
    EXPECT_THAT(light.error().message, testing::HasSubstr("D65"));
    EXPECT_THAT(light.error().message, testing::HasSubstr("LED-RGB1"));
  }
}

}  // namespace
}  // namespace spectile::test
