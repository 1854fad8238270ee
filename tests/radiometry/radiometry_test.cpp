// Laws of thermal radiation against each other and against CODATA, luminous quantities against independent
// integrals, photons.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <limits>
#include <numbers>
#include <spectile/radiometry/radiometry.hpp>
#include <type_traits>

#include "src/data/tables.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

using std::numbers::pi;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const int kSeeded = ::setenv("RC_PARAMS", "seed=20240229 max_success=200", 0);

double between(double low, double high) {
  const int step = *rc::gen::inRange(0, (1 << 30) + 1);
  return low + (high - low) * (step * 0x1p-30);
}

Spectrum blackbody(double temperature_k) {
  return *BlackbodySpectrum::create(temperature_k);
}

/// A laser: all of one watt within a fraction of a nanometre.
Spectrum line_at(double lambda_nm, double width_nm = 0.01) {
  const double height = 1 / (width_nm * std::sqrt(2 * pi));
  return *GaussianSumSpectrum::from_lobes({{height, lambda_nm, width_nm, width_nm}});
}

/// Lumens per watt of a black body, by the second radiation constant, CODATA's sigma, and Simpson's rule on
/// tenths of a nanometre over the observer's table.
double independent_efficacy(double temperature_k) {
  constexpr double kC1L = 1.191042972397188e-16;  // 2 h c^2, W m^2/sr
  constexpr double kC2 = 1.438776877e-2;          // h c / k, m K
  const auto planck = [&](double nm) {
    const double m = nm * 1e-9;
    return kC1L / std::pow(m, 5) / (std::exp(kC2 / (m * temperature_k)) - 1) * 1e-9;
  };
  const auto y_bar = data::kCie1931.y_bar;
  double lumens = 0;
  for (std::size_t i = 0; i + 1 < y_bar.size(); ++i) {
    for (int k = 0; k < 5; ++k) {
      const auto at = [&](double t) {
        return ((1 - t) * y_bar[i] + t * y_bar[i + 1]) * planck(360 + static_cast<double>(i) + t);
      };
      lumens += (at(0.2 * k) + 4 * at(0.2 * k + 0.1) + at(0.2 * k + 0.2)) * 0.2 / 6;
    }
  }
  return 683 * lumens / (5.670374419e-8 * std::pow(temperature_k, 4) / pi);
}

// --- laws of thermal radiation
// ------------------------------------------------------------------------------

TEST(ThermalRadiation, ConstantsAreThoseOfCodata2018) {
  static_assert(kWienDisplacement.unit() == Unit{.metre = 1, .kelvin = 1});
  static_assert(kStefanBoltzmann.unit() == Unit{.watt = 1, .metre = -2, .kelvin = -4});
  EXPECT_NEAR(kStefanBoltzmann.value() / 5.670374419e-8, 1, 1e-10);
  EXPECT_NEAR(kWienDisplacement.value() / 2.897771955e-3, 1, 1e-10);
  EXPECT_NEAR(kWienRoot - 5 * (1 - std::exp(-kWienRoot)), 0, 1e-15);
}

TEST(ThermalRadiation, StefanBoltzmannIsTheIntegralOfPlanck) {
  for (const double t : {1.0, 77.0, 300.0, 2856.0, 5772.0, 1e5, 1e9}) {
    const double planck = BlackbodySpectrum::create(t)->integral(0, kInfinity);
    EXPECT_NEAR(planck / blackbody_radiance(t).value(), 1, 1e-12) << t;
    EXPECT_NEAR(pi * planck / blackbody_exitance(t).value(), 1, 1e-12) << t;
  }
  // A wide range is its narrow parts, which are integrated in another way.
  const auto planck = *BlackbodySpectrum::create(3000);
  double parts = 0;
  for (double first = 300; first < 3e5; first *= 2) parts += planck.integral(first, 2 * first);
  EXPECT_NEAR(parts / planck.integral(300, 300 * 1024), 1, 1e-12);
  // The sun: its nominal radius, 6.957e8 m, and luminosity, 3.828e26 W (IAU 2015, resolution B3).
  EXPECT_NEAR(4 * pi * 6.957e8 * 6.957e8 * blackbody_exitance(5772).value() / 3.828e26, 1, 1e-3);
}

TEST(ThermalRadiation, WienIsTheMaximumOfPlanck) {
  for (const double t : {1.0, 300.0, 3000.0, 5772.0, 1e6}) {
    const auto planck = *BlackbodySpectrum::create(t);
    const double peak_nm = wien_peak_nm(t);
    EXPECT_NEAR(planck(peak_nm) / planck.max_value(), 1, 1e-13) << t;
    // Flat there: of two neighbours at equal distance neither is higher, but for the third derivative.
    const double step = 1e-3 * peak_nm;
    const double left = planck(peak_nm - step) / planck.max_value();
    const double right = planck(peak_nm + step) / planck.max_value();
    EXPECT_LT(left, 1) << t;
    EXPECT_LT(right, 1) << t;
    EXPECT_NEAR(left, right, 1e-6 * 0.1) << t;
  }
  EXPECT_NEAR(wien_peak_nm(5772), 502.04, 0.01);
  EXPECT_NEAR(wien_peak_nm(300), 9659.24, 0.01);
}

RC_GTEST_PROP(ThermalRadiation, ScalesWithTheFourthPower, ()) {
  const double t = between(10, 1e5);
  RC_ASSERT(std::abs(blackbody_exitance(2 * t) / blackbody_exitance(t) - 16) < 1e-13);
  RC_ASSERT(std::abs(wien_peak_nm(2 * t) / wien_peak_nm(t) - 0.5) < 1e-15);
  RC_ASSERT(std::abs(blackbody_exitance(t) / (blackbody_radiance(t) * (pi * kSteradian)) - 1) < 1e-15);
}

TEST(ThermalRadiation, OfNoTemperature) {
  EXPECT_EQ(blackbody_exitance(0).value(), 0);
  EXPECT_EQ(blackbody_radiance(0).value(), 0);
  EXPECT_EQ(wien_peak_nm(0), kInfinity);
  EXPECT_EQ(wien_peak_nm(-0.0), kInfinity);
  EXPECT_EQ(wien_peak_nm(kInfinity), 0);
  EXPECT_EQ(blackbody_exitance(kInfinity).value(), kInfinity);
  EXPECT_EQ(blackbody_exitance(1e100).value(), kInfinity);
  for (const double t : {-1.0, -kInfinity, kNotANumber}) {
    EXPECT_TRUE(std::isnan(blackbody_exitance(t).value())) << t;
    EXPECT_TRUE(std::isnan(blackbody_radiance(t).value())) << t;
    EXPECT_TRUE(std::isnan(wien_peak_nm(t))) << t;
  }
}

// --- luminous quantities
// ------------------------------------------------------------------------------------

TEST(Luminous, EfficacyOfOneWavelength) {
  EXPECT_NEAR(luminous_efficacy_at(555).value(), 683, 1e-9);
  EXPECT_NEAR(luminous_efficacy_at(555.016).value(), 683, 0.01);
  EXPECT_NEAR(luminous_efficacy_at(510).value(), 683 * 0.503, 1e-9);
  EXPECT_NEAR(luminous_efficacy_at(510.5).value(),
              (luminous_efficacy_at(510) + luminous_efficacy_at(511)).value() / 2, 1e-9);
  EXPECT_EQ(luminous_efficacy_at(359.9).value(), 0);
  EXPECT_EQ(luminous_efficacy_at(830.1).value(), 0);
  EXPECT_EQ(luminous_efficacy_at(-kInfinity).value(), 0);
  EXPECT_EQ(luminous_efficacy_at(kInfinity).value(), 0);
  EXPECT_TRUE(std::isnan(luminous_efficacy_at(kNotANumber).value()));
}

TEST(Luminous, ALaserAt555NanometresHas683LumensAWatt) {
  EXPECT_NEAR(luminous_flux(line_at(555)).value(), 683, 0.01);
  EXPECT_NEAR(luminous_efficacy(line_at(555))->value(), 683, 0.01);
  EXPECT_NEAR(*luminous_efficiency(line_at(555)), 1, 1e-5);
  // A laser pointer of one milliwatt at 532 nm: 0.6 lm.
  EXPECT_NEAR((1e-3 * luminous_flux(line_at(532))).value(),
              (1e-3 * kWatt * luminous_efficacy_at(532)).value(), 1e-5);
}

TEST(Luminous, EfficacyOfBlackBodies) {
  for (const double t : {1500.0, 2856.0, 3000.0, 5772.0, 6500.0, 20000.0}) {
    EXPECT_NEAR(luminous_efficacy(blackbody(t))->value() / independent_efficacy(t), 1, 1e-8) << t;
    // Whatever the scale.
    const Spectrum normalized = *BlackbodySpectrum::create(t, BlackbodySpectrum::Scale::kNormalized);
    EXPECT_NEAR(*luminous_efficacy(normalized) / *luminous_efficacy(blackbody(t)), 1, 1e-12) << t;
  }
  EXPECT_NEAR(luminous_efficacy(blackbody(5772))->value(), 93, 1);
  EXPECT_NEAR(luminous_efficacy(blackbody(2856))->value(), 16.45, 0.01);
}

TEST(Luminous, TheBestBlackBodyHas95LumensAWattNear6640Kelvin) {
  double best = 0;
  double at = 0;
  for (double t = 5000; t <= 9000; t += 10) {
    const double efficacy = luminous_efficacy(blackbody(t))->value();
    if (efficacy > best) {
      best = efficacy;
      at = t;
    }
  }
  EXPECT_NEAR(best, 95, 0.5);
  EXPECT_NEAR(at, 6640, 50);
}

TEST(Luminous, ABlackBodyAtTheFreezingPointOfPlatinumHas60CandelasASquareCentimetre) {
  // The candela's definition from 1948 to 1979; 2041.4 K on the scale of 1990.
  EXPECT_NEAR(luminance(blackbody(2041.4)).value() / 6e5, 1, 0.01);
}

TEST(Luminous, OfAConstantSpectrumIsTheSumOfTheTable) {
  double sum = 0;
  for (const double y : data::kCie1931.y_bar) sum += y;
  sum -= 0.5 * (data::kCie1931.y_bar.front() + data::kCie1931.y_bar.back());
  EXPECT_NEAR(sum, 106.857, 1e-3);
  EXPECT_NEAR(luminance(ConstantSpectrum(2)).value() / (2 * 683 * sum), 1, 1e-12);
  EXPECT_NEAR(luminous_efficacy(ConstantSpectrum(2))->value() / (683 * sum / 470), 1, 1e-12);
  EXPECT_NEAR(luminous_efficacy(ConstantSpectrum(2), 400, 700)->value() / (683 * sum / 300), 1, 1e-12);
}

TEST(Luminous, OfSamplesIsExact) {
  // A triangle from 554 to 556 nm, against the products of lines by hand: y-bar is linear on both sides.
  const double nm[] = {554, 555, 556};
  const double values[] = {0, 3, 0};
  const Spectrum triangle = *PiecewiseLinearSpectrum::from_samples(nm, values);
  const auto y = data::kCie1931.y_bar;
  const double left = (y[194] + 2 * y[195]) / 6;
  const double right = (2 * y[195] + y[196]) / 6;
  EXPECT_NEAR(luminous_intensity(triangle).value() / (683 * 3 * (left + right)), 1, 1e-13);
  EXPECT_NEAR(luminous_efficacy(triangle)->value() / (683 * (left + right)), 1, 1e-13);
}

TEST(Luminous, QuantitiesHaveTheirUnits) {
  const Spectrum one = ConstantSpectrum(1);
  static_assert(std::is_same_v<decltype(luminance(one)), Luminance>);
  static_assert(std::is_same_v<decltype(luminous_flux(one)), LuminousFlux>);
  static_assert(std::is_same_v<decltype(luminous_intensity(one)), LuminousIntensity>);
  static_assert(std::is_same_v<decltype(illuminance(one)), Illuminance>);
  EXPECT_EQ(illuminance(one).value(), luminance(one).value());
  EXPECT_EQ(luminous_from<LuminousExitance>(one), illuminance(one));
}

TEST(Luminous, SpecialValues) {
  EXPECT_EQ(luminance(ConstantSpectrum(0)).value(), 0);
  EXPECT_EQ(luminance(ConstantSpectrum(-1)), -luminance(ConstantSpectrum(1)));
  EXPECT_TRUE(std::isnan(luminance(ConstantSpectrum(kNotANumber)).value()));
  EXPECT_FALSE(std::isfinite(luminance(ConstantSpectrum(kInfinity)).value()));
  for (const double value : {0.0, -1.0, kInfinity, kNotANumber}) {
    EXPECT_EQ(code_of(luminous_efficacy(ConstantSpectrum(value))), code(ErrorCode::kBadArgument)) << value;
    EXPECT_EQ(code_of(luminous_efficiency(ConstantSpectrum(value))), code(ErrorCode::kBadArgument)) << value;
  }
  EXPECT_EQ(code_of(luminous_efficacy(ConstantSpectrum(1), 700, 400)), code(ErrorCode::kBadArgument));
  // Watts that nobody sees.
  EXPECT_EQ(luminous_efficacy(line_at(1064))->value(), 0);
}

RC_GTEST_PROP(Luminous, IsAtMost683LumensAWatt, ()) {
  const double mean = between(200, 1200);
  const double width = between(0.5, 200);
  const Spectrum any = *GaussianSumSpectrum::from_lobes({{1, mean, width, width}});
  const auto efficacy = luminous_efficacy(any);
  RC_ASSERT(efficacy->value() >= 0 && efficacy->value() <= 683 * (1 + 1e-5));
}

// --- photons
// ------------------------------------------------------------------------------------------------

TEST(Photons, EnergyOfOne) {
  EXPECT_NEAR(photon_energy(550) / kElectronvolt, 2.2543, 5e-5);
  // h c is 1239.841984 eV nm (CODATA 2018).
  EXPECT_NEAR(photon_energy(1) / kElectronvolt / 1239.841984, 1, 1e-9);
  EXPECT_EQ(photon_energy(0).value(), kInfinity);
  EXPECT_EQ(photon_energy(-0.0).value(), kInfinity);
  EXPECT_EQ(photon_energy(kInfinity).value(), 0);
  EXPECT_TRUE(std::isnan(photon_energy(-1).value()));
  EXPECT_TRUE(std::isnan(photon_energy(kNotANumber).value()));
}

TEST(Photons, RateOfAFlux) {
  EXPECT_NEAR(photon_rate(kWatt, 555).value() / 2.794e18, 1, 1e-3);
  EXPECT_EQ(photon_rate(kWatt, 0).value(), 0);
  EXPECT_EQ(photon_rate(RadiantFlux(0), 555).value(), 0);
  EXPECT_EQ(photon_rate(-kWatt, 555), -photon_rate(kWatt, 555));
  EXPECT_EQ(photon_rate(kWatt, kInfinity).value(), kInfinity);
  EXPECT_TRUE(std::isnan(photon_rate(kWatt, -1).value()));
}

TEST(Photons, RateOfASpectrum) {
  EXPECT_NEAR(*photon_rate(line_at(600)) / photon_rate(kWatt, 600), 1, 1e-6);
  // One watt a nanometre from 400 to 700 nm: as many as 300 W at 550 nm.
  EXPECT_NEAR(*photon_rate(ConstantSpectrum(1), 400, 700) / photon_rate(300 * kWatt, 550), 1, 1e-12);
  EXPECT_NEAR(*photon_rate(ConstantSpectrum(1), 0, 100) / photon_rate(100 * kWatt, 50), 1, 1e-12);
  for (const auto& [first, last] :
       {std::pair{-1.0, 5.0}, {5.0, 5.0}, {6.0, 5.0}, {0.0, kInfinity}, {kNotANumber, 5.0}}) {
    EXPECT_EQ(code_of(photon_rate(ConstantSpectrum(1), first, last)), code(ErrorCode::kBadArgument));
  }
}

TEST(Photons, OfABlackBodyAreCountedByZetaOfThree) {
  // All wavelengths: 2 c zeta(3) * 2 (k T / h c)^3 a steradian; here up to 1000 peaks.
  const double t = 3000;
  const double wavenumber = (kBoltzmannConstant * Temperature(t) / (kPlanckConstant * kSpeedOfLight)).value();
  const double want = 4 * 1.2020569031595942 * 299792458.0 * std::pow(wavenumber, 3);
  double got = 0;
  for (double first = 100; first < 1e6; first *= 1.5)
    got += photon_rate(blackbody(t), first, 1.5 * first)->value();
  EXPECT_NEAR(got / want, 1, 1e-4);
}

TEST(PhotonRate, OfABlackBodyOverAVeryWideRangeIsTheLaws) {
  // 4 zeta(3) c (k T / (h c))^3.
  const double kt = 1.380649e-23 * 6500 / (6.62607015e-34 * 299792458.0);
  const double want = 4 * 1.2020569031595942 * 299792458.0 * kt * kt * kt;
  EXPECT_NEAR(photon_rate(*BlackbodySpectrum::create(6500), 1, 1e12)->value() / want, 1, 1e-9);
}

}  // namespace
}  // namespace spectile::test
