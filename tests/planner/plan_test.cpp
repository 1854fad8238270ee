// Plans: white is exact, errors are as stated, few wavelengths beat many even ones, and what cannot be is
// said.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/spectile.hpp>

namespace spectile {
namespace {

using testing::HasSubstr;

std::vector<Spectrum> chart() {
  std::vector<Spectrum> out;
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.name.rfind("colorchecker-", 0) == 0) out.push_back(*named_spectrum(info.name));
  }
  return out;
}

NamedLight light(const char* name) {
  return *find_light(name);
}

PlannerOptions options(std::vector<const char*> lights, std::size_t bands) {
  PlannerOptions o;
  for (const char* name : lights) o.lights.push_back(light(name));
  o.reflectances = chart();
  o.bands = bands;
  o.folds = 3;
  return o;
}

TEST(Plan, WhiteIsExactUnderEveryLight) {
  PlannerOptions o = options({"D65", "FL11", "A"}, 10);
  o.folds = 0;
  const auto plan = make_plan(o);
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->count(), 10U);
  EXPECT_TRUE(plan->report.errors.empty());
  const std::vector<double> ones(plan->count(), 1.0);
  const Sensor observer = *Sensor::named("cie1931");
  for (std::size_t l = 0; l < o.lights.size(); ++l) {
    const auto white = plan->xyz(l, ones);
    EXPECT_NEAR(white[1], 1, 1e-12);
    // The sums every nanometre and the exact integrals of the light differ by its corners only.
    const auto exact = observer.response(PiecewiseLinearSpectrum(o.lights[l].spectrum));
    for (const std::size_t c : {0U, 2U}) EXPECT_NEAR(white[c], exact[c] / exact[1], 5e-4) << l;
    EXPECT_LT(plan->absolute_sum(l), 1.5);
  }
}

/// A line, 2 nm wide at its foot.
NamedLight line(double nm) {
  const std::vector<double> wavelengths = {nm - 1, nm, nm + 1};
  const std::vector<double> values = {0, 1, 0};
  return {"line", *MeasuredSpectrum::from_samples(wavelengths, values)};
}

TEST(Plan, LightsWithoutAComponentOfWhiteAreRefused) {
  PlannerOptions o = options({}, 4);
  o.folds = 0;
  for (const double nm : {660.0, 740.0}) {
    o.lights = {light("D65"), line(nm)};
    const auto plan = make_plan(o);
    ASSERT_FALSE(plan) << nm;
    EXPECT_EQ(plan.error().code, ErrorCode::kBadArgument);
    EXPECT_THAT(plan.error().message, HasSubstr("the light line has a white of X"));
    EXPECT_FALSE(even_bands_error(Bands(), line(nm), o.reflectances, 1));
  }
}

TEST(Plan, ALightBeyondEvenBandsHasNothingToCompareWith) {
  PlannerOptions o = options({}, 4);
  o.lights = {line(385)};
  const auto plan = make_plan(o);
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->report.errors.size(), 1U);
  // Of the four, 380:780:5 alone reaches it.
  ASSERT_EQ(plan->report.even_bands.size(), 2U);
  for (const EvenBandsError& e : plan->report.even_bands) EXPECT_EQ(e.bands, "380:780:5");
}

TEST(Plan, ReflectancesThatAreNoNumbersAreRefused) {
  PlannerOptions o = options({"D65"}, 4);
  o.reflectances[3] = ConstantSpectrum(std::nan(""));
  const auto plan = make_plan(o);
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, HasSubstr("reflectance 4 of 24 is no number at 360 nm"));
  EXPECT_FALSE(even_bands_error(Bands(), o.lights[0], o.reflectances, 1));
}

TEST(Plan, TwoLightsOfOneNameAreRefused) {
  const auto plan = make_plan(options({"D65", "A", "D65"}, 4));
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, HasSubstr("two lights are called D65"));
}

TEST(Plan, WavelengthsAscendWithinTheVisible) {
  PlannerOptions o = options({"D65"}, 12);
  o.folds = 0;
  const Plan plan = *make_plan(o);
  for (std::size_t k = 0; k < plan.count(); ++k) {
    EXPECT_GT(plan.wavelengths_nm[k], 380);
    EXPECT_LT(plan.wavelengths_nm[k], 730);
    EXPECT_GT(plan.wavelengths_nm[k], k == 0 ? 0 : plan.wavelengths_nm[k - 1]);
  }
}

TEST(Plan, FewWavelengthsDoWhatManyEvenBandsDo) {
  for (const char* name : {"D65", "FL11", "HP1"}) {
    const PlannerOptions o = options({name}, 12);
    const auto plan = make_plan(o);
    ASSERT_TRUE(plan);
    const auto even = even_bands_error(*Bands::parse("400:700:18.75"), o.lights[0], o.reflectances, 1);
    ASSERT_TRUE(even);
    ASSERT_EQ(plan->report.errors.size(), 1U);
    // Evaluated on patches that it has not seen, of sixteen that it was fitted to.
    EXPECT_LT(plan->report.errors[0].error.mean, 0.8 * even->mean) << name;
    EXPECT_LE(plan->report.errors[0].error.mean, plan->report.errors[0].error.percentile95);
    EXPECT_LE(plan->report.errors[0].error.percentile95, plan->report.errors[0].error.maximum);
    // On what it was fitted to it is better than on held-out ones.
    const auto fitted = plan_error(*plan, o.lights[0], o.reflectances, 1);
    ASSERT_TRUE(fitted);
    EXPECT_LT(fitted->mean, plan->report.errors[0].error.mean) << name;
  }
}

TEST(Plan, BandsAreMoreExactThanPoints) {
  for (const char* name : {"D65", "A"}) {
    PlannerOptions o = options({name}, 10);
    const auto points = make_plan(o);
    o.sampling = BandSampling::kAverages;
    const auto bands = make_plan(o);
    ASSERT_TRUE(points && bands);
    EXPECT_TRUE(points->bands.empty());
    EXPECT_LT(bands->report.errors[0].error.mean, 0.8 * points->report.errors[0].error.mean) << name;
    ASSERT_EQ(bands->bands.size(), 10U);
    ASSERT_TRUE(Bands::from_overlapping(bands->bands)) << name;
    for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(bands->bands[k].centre_nm, bands->wavelengths_nm[k]);
  }
}

TEST(Plan, BandsThatOverlapAreNearerThanBandsApart) {
  for (const char* name : {"D65", "FL11"}) {
    PlannerOptions o = options({name}, 8);
    o.sampling = BandSampling::kAverages;
    o.folds = 0;
    // No weight below 0 to speak of: noise in samples is not amplified.
    const auto whole = make_plan(o);
    ASSERT_TRUE(whole);
    EXPECT_LT(whole->absolute_sum(0), 1.01) << name;
    // Of what follows every other patch takes no part.
    o.reflectances.clear();
    std::vector<Spectrum> held_out;
    for (const Spectrum& patch : chart())
      (o.reflectances.size() == held_out.size() ? o.reflectances : held_out).push_back(patch);
    const auto overlapping = make_plan(o);
    o.apart = true;
    const auto apart = make_plan(o);
    ASSERT_TRUE(overlapping && apart);
    EXPECT_TRUE(planned_bands(*overlapping)->overlap()) << name;
    EXPECT_FALSE(planned_bands(*apart)->overlap()) << name;
    EXPECT_TRUE(Bands::from_list(apart->bands)) << name;
    const auto nearer = plan_error(*overlapping, o.lights[0], held_out, 1);
    const auto farther = plan_error(*apart, o.lights[0], held_out, 1);
    ASSERT_TRUE(nearer && farther);
    EXPECT_LT(nearer->mean, 0.8 * farther->mean) << name;
  }
}

TEST(Plan, WavelengthsAreWholePicometres) {
  PlannerOptions o = options({"A"}, 7);
  o.folds = 0;
  for (const BandSampling sampling : {BandSampling::kPoints, BandSampling::kAverages}) {
    o.sampling = sampling;
    const Plan plan = *make_plan(o);
    for (const double nm : plan.wavelengths_nm) EXPECT_EQ(nm, std::round(nm * 1000) / 1000);
  }
}

TEST(Plan, SaysWhatEvenBandsDo) {
  PlannerOptions o = options({"D65", "FL2"}, 12);
  o.bounces = 2;
  const Plan plan = *make_plan(o);
  ASSERT_EQ(plan.report.even_bands.size(), 2U * 4 * 2 * 2);
  EXPECT_EQ(plan.report.even_bands[0].bands, "400:700:25");
  for (const EvenBandsError& e : plan.report.even_bands) {
    const auto again =
        even_bands_error(*Bands::parse(e.bands), light(e.light.c_str()), o.reflectances, e.bounces, e.sums);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->mean, e.error.mean);
  }
}

TEST(Plan, EvenBandsErrAsTheProjectorDoes) {
  for (const char* name : {"D65", "FL11", "HP1"}) {
    for (const char* text : {"400:700:30", "400:700:5", "380:780:5"}) {
      const auto bands = *Bands::parse(text);
      const auto projector = *Projector::reflective(bands, light(name).spectrum);
      const Sensor observer = *Sensor::named("cie1931");
      const PiecewiseLinearSpectrum emitted(light(name).spectrum);
      const auto light_white = observer.response(emitted);
      const std::array<double, 3> relative = {light_white[0] / light_white[1], 1,
                                              light_white[2] / light_white[1]};
      std::vector<double> differences;
      for (const Spectrum& patch : chart()) {
        auto reference = observer.response(emitted, patch);
        for (double& v : reference) v /= light_white[1];
        const std::vector<float> samples = patch.average_over(bands);
        std::array<double, 3> xyz{};
        for (std::size_t b = 0; b < samples.size(); ++b) {
          for (std::size_t k = 0; k < 3; ++k)
            xyz[k] += projector.weights()[b][k] * static_cast<double>(samples[b]);
        }
        differences.push_back(ciede2000(xyz_to_lab(reference, relative), xyz_to_lab(xyz, projector.white())));
      }
      const ColorError expected = summarize(differences);
      const auto error = even_bands_error(bands, light(name), chart(), 1);
      // Integrated every nanometre, where the projector does it exactly.
      EXPECT_NEAR(error->mean, expected.mean, 0.002 + 0.03 * expected.mean) << name << " " << text;
      EXPECT_NEAR(error->maximum, expected.maximum, 0.008 + 0.03 * expected.maximum) << name << " " << text;
    }
  }
}

TEST(Plan, EvenBandsErrAsTheirSumsDo) {
  // By hand: averages over each band of reflectance, light and curve, multiplied and added.
  const auto bands = *Bands::parse("400:700:30");
  const std::vector<Spectrum> one = {chart()[2]};
  const PiecewiseLinearSpectrum fl(light("FL11").spectrum);
  const Sensor observer = *Sensor::named("cie1931");
  std::array<double, 3> sum{};
  double luminance = 0;
  for (const Band& band : bands.list()) {
    double r = 0;
    double l = 0;
    std::array<double, 3> c{};
    constexpr int kSteps = 3000;
    for (int i = 0; i < kSteps; ++i) {
      const double nm = band.lower_nm + (i + 0.5) / kSteps * band.width_nm();
      r += one[0](nm) / kSteps;
      l += fl(nm) / kSteps;
      for (std::size_t k = 0; k < 3; ++k) c[k] += observer.curves()[k](nm) / kSteps;
    }
    for (std::size_t k = 0; k < 3; ++k) sum[k] += c[k] * l * r;
    luminance += c[1] * l;
  }
  for (double& v : sum) v /= luminance;
  const auto white = observer.response(fl);
  auto reference = observer.response(fl, one[0]);
  for (double& v : reference) v /= white[1];
  const std::array<double, 3> relative = {white[0] / white[1], 1, white[2] / white[1]};
  const double expected = ciede2000(xyz_to_lab(reference, relative), xyz_to_lab(sum, relative));
  const auto error = even_bands_error(bands, light("FL11"), one, 1, EvenBandsSums::kAveragesMultiplied);
  EXPECT_NEAR(error->maximum, expected, 0.02 * expected);
}

TEST(Plan, ErrorsAreThoseOfItsOwnFormula) {
  PlannerOptions o = options({"FL2"}, 9);
  o.folds = 0;
  const Plan plan = *make_plan(o);
  const Sensor observer = *Sensor::named("cie1931");
  const PiecewiseLinearSpectrum fl2(o.lights[0].spectrum);
  const auto white = observer.response(fl2);
  double mean = 0;
  for (const Spectrum& patch : o.reflectances) {
    std::vector<double> samples;
    for (const double nm : plan.wavelengths_nm) samples.push_back(patch(nm));
    auto reference = observer.response(fl2, patch);
    for (double& v : reference) v /= white[1];
    const std::array<double, 3> relative = {white[0] / white[1], 1, white[2] / white[1]};
    mean += ciede2000(xyz_to_lab(reference, relative), xyz_to_lab(plan.xyz(0, samples), relative)) /
            static_cast<double>(o.reflectances.size());
  }
  EXPECT_NEAR(plan_error(plan, o.lights[0], o.reflectances, 1)->mean, mean, 0.02);
}

TEST(Plan, IsTheSameEveryTime) {
  PlannerOptions o = options({"D65", "A"}, 6);
  o.folds = 0;
  const Plan a = *make_plan(o);
  const Plan b = *make_plan(o);
  EXPECT_EQ(a.wavelengths_nm, b.wavelengths_nm);
  EXPECT_EQ(a.weights.sensor, b.weights.sensor);
  EXPECT_EQ(a.weights.lights[1].emission, b.weights.lights[1].emission);
}

TEST(Plan, ManyBouncesHaveAnErrorToo) {
  PlannerOptions o = options({"D65"}, 12);
  o.bounces = 2;
  const Plan plan = *make_plan(o);
  ASSERT_EQ(plan.report.errors.size(), 2U);
  EXPECT_EQ(plan.report.errors[1].bounces, 2);
  EXPECT_LT(plan.report.errors[1].error.mean, 0.5);
}

TEST(Plan, SaysWhatItCannotDo) {
  const auto refusal = [](const PlannerOptions& o) {
    const auto plan = make_plan(o);
    EXPECT_FALSE(plan);
    return plan ? "" : plan.error().message;
  };
  PlannerOptions o = options({"D65"}, 8);
  o.max_error = 1;
  EXPECT_THAT(refusal(o), HasSubstr("either"));
  EXPECT_THAT(refusal(options({}, 8)), HasSubstr("one light"));
  EXPECT_THAT(refusal(options({"D65"}, 2)), HasSubstr("2 bands"));
  o = options({"D65"}, 8);
  o.reflectances.resize(5, Spectrum(ConstantSpectrum(0.5)));
  EXPECT_THAT(refusal(o), HasSubstr("not 5"));
  o = options({"D65"}, 8);
  o.lights[0] = *named_light("dark", ConstantSpectrum(0));
  EXPECT_THAT(refusal(o), HasSubstr("no luminance"));
  o = options({"D65"}, 8);
  o.bounces = 9;
  EXPECT_THAT(refusal(o), HasSubstr("9 bounces"));
  EXPECT_FALSE(plan_error(*make_plan(options({"D65"}, 4)), light("A"), chart(), 1));
}

TEST(Plan, AnErrorAskedForIsMetByAsFewAsThat) {
  PlannerOptions o = options({"D65"}, 8);
  o.bands.reset();
  o.max_error = 3;
  const auto plan = make_plan(o);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_LT(plan->count(), 12U);
  EXPECT_LE(plan->report.errors[0].error.maximum, 3);
}

}  // namespace
}  // namespace spectile
