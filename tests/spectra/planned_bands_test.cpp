// Bands of plans: what they weigh by, exact colours of every method, and films.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/spectile.hpp>

#include "tests/upsampling/round_trip.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

Plan plan_for(std::vector<const char*> lights, std::size_t bands, BandSampling sampling) {
  PlannerOptions o;
  for (const char* name : lights) o.lights.push_back(*find_light(name));
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind == "reflectance") o.reflectances.push_back(*named_spectrum(info.name));
  }
  o.bands = bands;
  o.folds = 0;
  o.sampling = sampling;
  return *make_plan(o);
}

/// Made once: they take a second each.
const Plan& points() {
  static const Plan plan = plan_for({"D65", "FL11"}, 12, BandSampling::kPoints);
  return plan;
}
const Plan& averages() {
  static const Plan plan = plan_for({"D65", "FL11"}, 12, BandSampling::kAverages);
  return plan;
}

class PlannedBands : public testing::TestWithParam<BandSampling> {
 protected:
  const Plan& plan_ = GetParam() == BandSampling::kPoints ? points() : averages();
  const Bands bands_ = *planned_bands(plan_);
};

TEST_P(PlannedBands, LieAtThePlansWavelengths) {
  ASSERT_EQ(bands_.count(), plan_.count());
  for (std::size_t k = 0; k < bands_.count(); ++k) EXPECT_EQ(bands_[k].centre_nm, plan_.wavelengths_nm[k]);
  EXPECT_EQ(bands_.are_points(), GetParam() == BandSampling::kPoints);
  ASSERT_NE(bands_.weights(), nullptr);
  EXPECT_EQ(Bands().weights(), nullptr);
  EXPECT_FALSE(Bands().are_points());
}

TEST_P(PlannedBands, EqualThoseOfTheSameWeightsOnly) {
  EXPECT_EQ(*planned_bands(plan_), bands_);
  Plan other = plan_;
  other.weights.lights[1].emission[3] *= 1.000001;
  EXPECT_FALSE(*planned_bands(other) == bands_);
  other = plan_;
  other.weights.sensor[0][2] += 1e-9;
  EXPECT_FALSE(*planned_bands(other) == bands_);
  other = plan_;
  other.weights.lights[0].spectrum = *illuminant("D50");
  EXPECT_FALSE(*planned_bands(other) == bands_);
  other = plan_;
  other.weights.lights[0].name = "daylight";
  EXPECT_FALSE(*planned_bands(other) == bands_);
  other = plan_;
  other.weights.lights[0].spectrum = plan_.weights.lights[0].spectrum.scaled(0.3);
  other.report.errors = {{"D65", 1, {}}};
  EXPECT_EQ(*planned_bands(other), bands_) << "scale and report do not count";
  EXPECT_FALSE(*Bands::from_overlapping({bands_.list().begin(), bands_.list().end()}) == bands_);
}

TEST_P(PlannedBands, GiveTheirPlanBack) {
  Plan plan = plan_;
  plan.report.errors = {{"FL11", 2, {1, 2, 3}}};
  const Plan back = plan_of_bands(*planned_bands(plan));
  EXPECT_EQ(plan_to_json(back), plan_to_json(plan));
}

TEST_P(PlannedBands, AreWeighedBySensorAndEmission) {
  for (std::size_t l = 0; l < plan_.weights.lights.size(); ++l) {
    const auto projector = Projector::reflective(bands_, *illuminant(plan_.weights.lights[l].name));
    ASSERT_TRUE(projector) << projector.error().message;
    std::vector<double> ones(plan_.count(), 1.0);
    const auto white = plan_.xyz(l, ones);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(projector->white()[c], white[c], 1e-12);
      for (std::size_t k = 0; k < plan_.count(); ++k) {
        EXPECT_NEAR(projector->weights()[k][c],
                    plan_.weights.sensor[k][c] * plan_.weights.lights[l].emission[k], 1e-12);
      }
    }
  }
  // A light on another scale is the same light.
  EXPECT_TRUE(Projector::reflective(bands_, illuminant("FL11")->scaled(0.01)));
}

TEST_P(PlannedBands, LightsWeighTheSameAsReflectancesUnderThem) {
  const auto emissive = Projector::emissive(bands_);
  ASSERT_TRUE(emissive);
  double y = 0;
  for (const auto& w : emissive->weights()) y += w[1];
  EXPECT_NEAR(y, 1, 1e-12);
  // Emission values times a reflectance, as a light of its own.
  std::array<double, 3> light{};
  for (std::size_t k = 0; k < plan_.count(); ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      light[c] += emissive->weights()[k][c] * plan_.weights.lights[1].emission[k];
  }
  const auto under = *Projector::reflective(bands_, *illuminant("FL11"));
  for (const std::size_t c : {0U, 2U}) EXPECT_NEAR(light[c] / light[1], under.white()[c], 1e-12);
}

TEST_P(PlannedBands, SayWhichLightsTheyHave) {
  const auto other = Projector::reflective(bands_, *illuminant("A"));
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("D65, FL11"));
  const auto observer = Projector::reflective(bands_, *illuminant("D65"), Observer::kCie1964);
  ASSERT_FALSE(observer);
  EXPECT_THAT(observer.error().message, HasSubstr("1931"));
  EXPECT_FALSE(Projector::emissive(bands_, *Sensor::named("canon-eos-5d-mkii")));
}

TEST_P(PlannedBands, SampleSpectraAsTheirPlanDoes) {
  const auto ramp =
      *MeasuredSpectrum::from_samples(std::vector<double>{300, 555, 800}, std::vector<double>{0, 2, 1});
  const auto samples = ramp.average_over(bands_);
  for (std::size_t k = 0; k < bands_.count(); ++k) {
    const double expected =
        GetParam() == BandSampling::kPoints
            ? ramp.at(plan_.wavelengths_nm[k])
            : ramp.integral(bands_[k].lower_nm, bands_[k].upper_nm) / bands_[k].width_nm();
    EXPECT_EQ(samples[k], static_cast<float>(expected)) << k;
  }
}

TEST_P(PlannedBands, GiveEveryColourBackExactly) {
  const ColorLanes rgb = test::cube_grid(9);
  for (const Method method : {Method::kSmitsExact, Method::kMallett, Method::kSigmoid}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
      const auto upsampler = Upsampler::create(method, quantity, bands_);
      ASSERT_TRUE(upsampler) << to_string(method) << ": " << upsampler.error().message;
      const SampledSpectra spectra = test::spectra_of(*upsampler, rgb);
      const auto projector = quantity == Quantity::kIlluminant
                                 ? Projector::emissive(bands_)
                                 : Projector::reflective(bands_, *illuminant("D65"));
      ColorLanes back = *ColorLanes::create(rgb.lanes());
      ASSERT_TRUE(project(*projector, spectra.view(), back.span()));
      ASSERT_TRUE(transform(projector->xyz_to_srgb(), back.view(), back.span()));
      double most = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < rgb.lanes(); ++i) {
          most = std::max(most,
                          std::abs(static_cast<double>(back.at(i, c)) - static_cast<double>(rgb.at(i, c))));
        }
      }
      EXPECT_LT(most, 4e-6) << to_string(method) << " " << to_string(quantity);
    }
  }
}

TEST_P(PlannedBands, RelightWithinThePlansError) {
  const auto upsampler = Upsampler::create(Method::kSmitsExact, Quantity::kReflectance, bands_);
  const auto under = Projector::reflective(bands_, *illuminant("FL11"));
  ASSERT_TRUE(upsampler && under);
  const auto relighter = Relighter::create(*upsampler, *under, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  ASSERT_TRUE(relighter);
  const ColorLanes white = test::lanes_of({{1, 1, 1}});
  ColorLanes xyz = *ColorLanes::create(1);
  ASSERT_TRUE(relight(*relighter, white.view(), xyz.span()));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(xyz.at(0, c), under->white()[c], 1e-6);
}

TEST_P(PlannedBands, FeedFilms) {
  FilmOptions o;
  o.width = o.height = 1;
  o.input = FilmInput::kBands;
  o.bands = bands_;
  o.xyz = Observer::kCie1931;
  o.spectral = true;
  auto film = Film::create(o);
  ASSERT_TRUE(film) << film.error().message;
  std::vector<float> radiance;
  std::array<double, 3> expected{};
  const auto emissive = *Projector::emissive(bands_);
  for (std::size_t k = 0; k < bands_.count(); ++k) {
    radiance.push_back(static_cast<float>(plan_.weights.lights[1].emission[k]) * 0.5F);
    for (std::size_t c = 0; c < 3; ++c)
      expected[c] += emissive.weights()[k][c] * static_cast<double>(radiance[k]);
  }
  const std::vector<float> at = {0.5F};
  const std::vector<float> weight = {1.0F};
  BandSamples samples{at, at, weight, {}};
  samples.radiance = {radiance.data(), bands_.count(), 1};
  ASSERT_TRUE(film->add(samples));
  auto development = FilmDevelopment::create(*film, FilmLayer::kXyz);
  ASSERT_TRUE(development);
  ASSERT_TRUE(development->update());
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(development->plane(c)[0], expected[c], 1e-6 * expected[1]);
}

INSTANTIATE_TEST_SUITE_P(Samplings, PlannedBands,
                         testing::Values(BandSampling::kPoints, BandSampling::kAverages),
                         [](const auto& sampling) {
                           return sampling.param == BandSampling::kPoints ? "Points" : "Bands";
                         });

TEST(PlannedBandsOfPoints, AreNoBucketsForWavelengths) {
  FilmOptions o;
  o.width = o.height = 1;
  o.input = FilmInput::kWavelengths;
  o.spectral = true;
  o.bands = *planned_bands(points());
  const auto film = Film::create(o);
  ASSERT_FALSE(film);
  EXPECT_THAT(film.error().message, HasSubstr("values at 12 wavelengths"));
}

TEST(PlannedBandsThatOverlap, AreNoBucketsForWavelengths) {
  const Bands bands = *planned_bands(plan_for({"D65"}, 8, BandSampling::kAverages));
  ASSERT_TRUE(bands.overlap());
  FilmOptions o;
  o.width = o.height = 1;
  o.input = FilmInput::kWavelengths;
  o.spectral = true;
  o.bands = bands;
  const auto film = Film::create(o);
  ASSERT_FALSE(film);
  EXPECT_THAT(film.error().message, HasSubstr("bands overlap"));
  // Samples on the bands need no dividing.
  o.input = FilmInput::kBands;
  EXPECT_TRUE(Film::create(o));
}

TEST(PlannedBandsThatOverlap, NeedTheirPlan) {
  const Bands planned = *planned_bands(plan_for({"D65"}, 8, BandSampling::kAverages));
  const Bands bare = *Bands::from_overlapping({planned.list().begin(), planned.list().end()});
  EXPECT_TRUE(Projector::reflective(planned, *illuminant("D65")));
  for (const auto& projector : {Projector::reflective(bare, *illuminant("D65")), Projector::emissive(bare),
                                Projector::emissive(bare, *Sensor::named("cie1931"))}) {
    ASSERT_FALSE(projector);
    EXPECT_THAT(projector.error().message, HasSubstr("overlap"));
  }
  EXPECT_FALSE(Upsampler::create(kDefaultMethod, Quantity::kReflectance, bare));
  const auto spectra = *SampledSpectra::create(planned, 64);
  auto lanes = *ScalarLanes::create(64);
  EXPECT_FALSE(average(spectra.view(), lanes.span()));
  const auto [first, last] = planned.range_nm();
  for (const Band& band : planned.list()) {
    EXPECT_LE(first, band.lower_nm);
    EXPECT_GE(last, band.upper_nm);
  }
}

TEST(PlannedBandsThatOverlap, GiveColoursBack) {
  const Bands bands = *planned_bands(plan_for({"D65"}, 8, BandSampling::kAverages));
  for (const Method method : {Method::kTetrahedral, Method::kSmitsExact, Method::kSigmoid}) {
    const auto upsampler = Upsampler::create(method, Quantity::kReflectance, bands);
    ASSERT_TRUE(upsampler) << upsampler.error().message;
    auto rgb = *ColorLanes::create(64);
    for (std::size_t i = 0; i < 64; ++i) {
      rgb.at(i, 0) = static_cast<float>(i % 4) / 3;
      rgb.at(i, 1) = static_cast<float>(i / 4 % 4) / 3;
      rgb.at(i, 2) = static_cast<float>(i / 16) / 3;
    }
    auto spectra = *SampledSpectra::create(bands, 64);
    ASSERT_TRUE(upsample_srgb(*upsampler, rgb.view(), spectra.span()));
    const auto projector = *Projector::reflective(bands, *illuminant("D65"));
    for (std::size_t i = 0; i < 64; ++i) {
      std::array<double, 3> xyz{};
      for (std::size_t b = 0; b < bands.count(); ++b) {
        for (std::size_t k = 0; k < 3; ++k)
          xyz[k] += projector.weights()[b][k] * static_cast<double>(spectra.at(i, b));
      }
      const auto back = times(projector.xyz_to_srgb(), xyz);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back[k], rgb.at(i, k), 2e-6) << to_string(method);
    }
  }
}

TEST(PlannedBandsOfBrokenPlans, AreRefused) {
  EXPECT_FALSE(planned_bands({}));
  Plan plan = points();
  plan.weights.lights[0].emission.pop_back();
  const auto bands = planned_bands(plan);
  ASSERT_FALSE(bands);
  EXPECT_THAT(bands.error().message, HasSubstr("not whole"));
  plan = points();
  std::swap(plan.wavelengths_nm[0], plan.wavelengths_nm[1]);
  EXPECT_FALSE(planned_bands(plan));
}

}  // namespace
}  // namespace spectile
