// Sensors: exposure, white balance, projection over bands and at wavelengths, and the fit to XYZ.
#include <spectile/color/sensor.hpp>
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/lanes/wavelengths_support.hpp"

namespace spectile::test {
namespace {

Spectrum light(const char* name) {
  return *named_spectrum(name);
}

TEST(Sensor, AnObserverGivesOneForEqualEnergy) {
  for (const char* name : {"cie1931", "cie1964"}) {
    const auto xyz = Sensor::named(name)->response(ConstantSpectrum(1));
    EXPECT_NEAR(xyz[1], 1, 1e-14);
    EXPECT_NEAR(xyz[0], 1, 5e-4) << name;  // equal energy is at x = y = 1/3 to the tables' rounding
    EXPECT_NEAR(xyz[2], 1, 5e-4) << name;
  }
}

TEST(Sensor, ExposureScalesAndWhiteBalanceLevels) {
  const Spectrum a = light("A");
  const auto plain = *Sensor::named("canon-eos-5d-mkii");
  const auto twice = *Sensor::named("canon-eos-5d-mkii", {2, {}});
  const auto balanced = *Sensor::named("canon-eos-5d-mkii", {1, a});
  const auto rgb = plain.response(a);
  EXPECT_GT(rgb[0], 1.1 * rgb[2]);  // incandescent light is red
  for (std::size_t c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(twice.response(a)[c], 2 * rgb[c]);
  const auto level = balanced.response(a);
  EXPECT_DOUBLE_EQ(level[0], level[1]);
  EXPECT_DOUBLE_EQ(level[2], level[1]);
  EXPECT_DOUBLE_EQ(level[1], rgb[1]);
  // Whatever the light's scale.
  const auto dim = PiecewiseLinearSpectrum(*illuminant("A")).scaled(1e-6);
  const auto same = *Sensor::named("canon-eos-5d-mkii", {1, dim});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(same.factors()[c] / balanced.factors()[c], 1, 1e-12);
}

TEST(Sensor, CurvesWithoutAResponseAreErrors) {
  const Spectrum none = ConstantSpectrum(0);
  const Spectrum one = ConstantSpectrum(1);
  EXPECT_FALSE(Sensor::create({one, none, one}));
  EXPECT_FALSE(Sensor::create({one, ConstantSpectrum(-1), one}));
  EXPECT_FALSE(Sensor::create({one, ConstantSpectrum(std::nan("")), one}));
  EXPECT_FALSE(Sensor::create({one, one, one}, {1, none}));
  EXPECT_FALSE(Sensor::create({one, one, one}, {0, {}}));
  EXPECT_FALSE(Sensor::create({one, one, one}, {std::nan(""), {}}));
  const auto unknown = Sensor::named("kodak");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message,
            "sensor \"kodak\" is unknown; there are cie1931, cie1964, canon-eos-5d-mkii");
}

TEST(Projector, OfASensorIsTheResponseForWhatIsConstantOverTheBands) {
  const auto sensor = *Sensor::named("canon-eos-5d-mkii", {1, light("D65")});
  const Bands bands = *Bands::parse("360:830:10");
  for (const bool reflective : {false, true}) {
    const auto projector = reflective ? *Projector::reflective(bands, light("FL2"), sensor)
                                      : *Projector::emissive(bands, sensor);
    EXPECT_FALSE(projector.observer());
    EXPECT_EQ(projector.xyz_to_srgb(), (Matrix3{1, 0, 0, 0, 1, 0, 0, 0, 1}));
    auto spectra = *SampledSpectra::constant(bands, 65, 0.5F);
    auto rgb = *ColorLanes::create(65);
    ASSERT_TRUE(project(projector, spectra.view(), rgb.span()));
    const auto want = sensor.response(reflective ? light("FL2") : Spectrum(ConstantSpectrum(1)));
    for (std::size_t c = 0; c < 3; ++c) {
      for (const std::size_t i : {0U, 64U}) EXPECT_NEAR(rgb.at(i, c) / (0.5 * want[c]), 1, 1e-6);
      EXPECT_NEAR(projector.white()[c] / want[c], 1, 1e-12);
    }
    auto second = *ScalarLanes::create(65);
    ASSERT_TRUE(luminance(projector, spectra.view(), second.span()));
    EXPECT_EQ(second[64], rgb.at(64, 1));
  }
  auto other = *SampledSpectra::constant(Bands(), 65, 1);
  auto rgb = *ColorLanes::create(65);
  EXPECT_FALSE(project(*Projector::emissive(bands, sensor), other.view(), rgb.span()));
}

TEST(Projector, OfAnObserversSensorIsTheObservers) {
  const auto sensor = *Sensor::named("cie1931");
  const auto mine = *Projector::emissive(*Bands::parse("360:830:5"), sensor);
  const auto theirs = *Projector::emissive(*Bands::parse("360:830:5"));
  for (std::size_t b = 0; b < mine.bands().count(); ++b) {
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(mine.weights()[b][c], theirs.weights()[b][c], 1e-12) << b;
  }
}

TEST(Sensor, SampledWavelengthsEstimateItsResponse) {
  const auto sensor = *Sensor::named("canon-eos-5d-mkii", {1, light("D65")});
  const std::size_t lanes = 50000;
  const auto wavelengths = drawn_wavelengths(WavelengthSampling::kVisible, lanes, 8, 3);
  auto radiance = own_batch(lanes, 8);
  ASSERT_TRUE(sample(light("D50"), wavelengths.lambda_nm.view(), radiance.span()));
  auto rgb = *ColorLanes::create(lanes);
  ASSERT_TRUE(project(*sensor.response_curves(), radiance.view(), wavelengths, rgb.span()));
  const auto want = sensor.response(light("D50"));
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < lanes; ++i) {
      sum += rgb.at(i, c);
      squares += static_cast<double>(rgb.at(i, c)) * rgb.at(i, c);
    }
    const double mean = sum / lanes;
    const double error = std::sqrt((squares / lanes - mean * mean) / lanes);
    EXPECT_NEAR(mean, want[c], 4 * error + 2e-3 * want[c]) << c;  // its curves are tabulated at 1 nm
  }
}

TEST(SensorFit, AnObserverNeedsNoFit) {
  const auto fit = *fit_sensor_to_xyz(*Sensor::named("cie1931"), light("D65"));
  EXPECT_LT(fit.max_ciede2000, 1e-6);
  EXPECT_LT(fit.white_ciede2000, 1e-6);
  ASSERT_EQ(fit.patches.size(), 24U);
}

TEST(SensorFit, ACameraComesNearAndSaysHowNear) {
  for (const char* name : {"D65", "A", "FL2"}) {
    const auto sensor = *Sensor::named("canon-eos-5d-mkii", {1, light(name)});
    const auto fit = *fit_sensor_to_xyz(sensor, light(name));
    EXPECT_GT(fit.mean_ciede2000, 0.1) << name;  // no camera is an observer
    EXPECT_LT(fit.mean_ciede2000, 2) << name;
    EXPECT_LT(fit.max_ciede2000, 7) << name;
    EXPECT_LT(fit.white_ciede2000, 3) << name;
    // Exposure changes the matrix, not its errors.
    const auto bright =
        *fit_sensor_to_xyz(*Sensor::named("canon-eos-5d-mkii", {50, light(name)}), light(name));
    EXPECT_NEAR(bright.mean_ciede2000, fit.mean_ciede2000, 1e-9);
    EXPECT_NEAR(bright.rgb_to_xyz[4] * 50, fit.rgb_to_xyz[4], 1e-9 * std::abs(fit.rgb_to_xyz[4]));
  }
}

TEST(SensorFit, CurvesThatDependOnEachOtherAreAnError) {
  const Spectrum one = ConstantSpectrum(1);
  EXPECT_FALSE(fit_sensor_to_xyz(*Sensor::create({one, one, ConstantSpectrum(2)}), light("D65")));
}

}  // namespace
}  // namespace spectile::test
