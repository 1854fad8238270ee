// Values beyond the ends of tables: 0 or held, in look-ups, integrals, averages, lights and reflectances.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile::test {
namespace {

const std::vector<double> kNm = {430, 460, 470};
const std::vector<double> kValues = {1, 2, 1.5};

/// Sums at every hundredth of a nanometre, of a function that the test writes down itself.
template <class Function>
double sum(double first_nm, double last_nm, const Function& f) {
  constexpr double kStep = 0.01;
  const auto count = static_cast<int>(std::lround((last_nm - first_nm) / kStep));
  double out = 0;
  for (int i = 0; i < count; ++i) out += kStep * f(first_nm + (i + 0.5) * kStep);
  return out;
}

double lamp(double nm) {
  if (nm < 430 || nm > 470) return 0;
  return nm < 460 ? 1 + (nm - 430) / 30 : 2 - (nm - 460) / 20;
}

TEST(Ends, AreStatedWhenASpectrumIsMade) {
  const auto zero = MeasuredSpectrum::from_samples(kNm, kValues, Ends::kZero);
  const auto held = MeasuredSpectrum::from_samples(kNm, kValues, Ends::kHeld);
  ASSERT_TRUE(zero && held);
  for (const double nm : {429.999, 470.001, 0.0, 1e6}) EXPECT_EQ(zero->at(nm), 0) << nm;
  EXPECT_EQ(zero->at(430), 1);
  EXPECT_EQ(zero->at(470), 1.5);
  EXPECT_EQ(held->at(400), 1);
  EXPECT_EQ(held->at(500), 1.5);
  EXPECT_EQ(zero->with_ends(Ends::kHeld).at(500), 1.5);
  EXPECT_EQ(zero->scaled(2).at(500), 0);
  EXPECT_NEAR(zero->integral(360, 830), sum(360, 830, lamp), 1e-4);
  EXPECT_NEAR(zero->integral(440, 465), sum(440, 465, lamp), 1e-4);
  EXPECT_DOUBLE_EQ(held->integral(400, 430), 30);
  const Bands bands = *Bands::uniform(400, 500, 20);
  const auto averages = zero->average_over(bands);
  for (std::size_t b = 0; b < bands.count(); ++b) {
    EXPECT_NEAR(averages[b], sum(bands[b].lower_nm, bands[b].upper_nm, lamp) / bands[b].width_nm(), 1e-4)
        << b;
  }
  EXPECT_NEAR(product_integral(*zero, *held, 360, 830),
              sum(360, 830, [](double nm) { return lamp(nm) * lamp(nm); }), 1e-4);
}

TEST(Ends, OfAPiecewiseLinearSpectrumAreKeptEverywhere) {
  const Spectrum zero = *PiecewiseLinearSpectrum::from_samples(kNm, kValues);
  const Spectrum held = *PiecewiseLinearSpectrum::from_samples(kNm, kValues, Ends::kHeld);
  EXPECT_EQ(zero(500), 0);
  EXPECT_EQ(held(500), 1.5);
  EXPECT_EQ(held(300), 1);
  EXPECT_DOUBLE_EQ(held.integral(470, 480), 15);
  EXPECT_EQ(zero.integral(470, 480), 0);
  EXPECT_EQ(std::get<PiecewiseLinearSpectrum>(held.kind()).scaled(2)(500), 3);
  EXPECT_NEAR(inner_product(zero, held), sum(360, 830, [](double nm) { return lamp(nm) * lamp(nm); }), 1e-4);
  EXPECT_EQ(tabulated(zero)->at(500), 0);
  EXPECT_EQ(tabulated(held)->at(500), 1.5);
}

TEST(Ends, OfPublishedLightsAreZeroAndOfReflectancesHeld) {
  EXPECT_EQ(illuminant("FL11")->at(781), 0);
  EXPECT_GT(illuminant("FL11")->at(780), 0);
  EXPECT_EQ(find_light("FL11")->spectrum.at(781), 0);
  EXPECT_EQ((*named_spectrum("FL11"))(781), 0);
  const Spectrum patch = *named_spectrum("colorchecker-red");
  EXPECT_EQ(patch(800), patch(730));
  EXPECT_EQ((*find_reflectances("colorchecker-red")).spectra[0](800), patch(730));
}

TEST(Ends, OfAFileFollowItsUseOrTheOption) {
  TempFolder folder;
  const std::string path = folder / "lamp.csv";
  write_text(path, "430,0.5\n460,1\n470,0.75\n");
  EXPECT_EQ(find_light(path)->spectrum.at(500), 0);
  EXPECT_EQ((*find_reflectances(path)).spectra[0](500), 0.75);
  EXPECT_EQ((*load_spectrum(path))(500), 0);
  EXPECT_EQ(load_spectrum_csv(path)->at(500), 0.75);
  SpectrumFileOptions held;
  held.ends = Ends::kHeld;
  const auto light = find_light(path, held);
  ASSERT_TRUE(light);
  EXPECT_EQ(light->spectrum.at(800), 0.75);
  EXPECT_EQ(light->spectrum.at(360), 0.5);
  EXPECT_THAT(light->notes, testing::ElementsAre(testing::HasSubstr("held beyond its ends")));
  SpectrumFileOptions zero;
  zero.ends = Ends::kZero;
  const auto dark = find_reflectances(path, zero);
  ASSERT_TRUE(dark);
  EXPECT_EQ(dark->spectra[0](500), 0);
  EXPECT_EQ(dark->spectra[0](460), 1);
}

}  // namespace
}  // namespace spectile::test
