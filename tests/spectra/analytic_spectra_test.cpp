// Spectra, samplers and directions at the ends of what they promise.
#include <cmath>
#include <numbers>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/radiometry/directions.hpp>
#include <spectile/radiometry/irradiance.hpp>
#include <spectile/radiometry/radiometry.hpp>
#include <spectile/spectra/spectrum.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

constexpr double kU = 0x1p-24;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

long double planck_exactly(long double lambda_nm, long double temperature_k) {
  constexpr long double kH = 6.62607015e-34L;
  constexpr long double kC = 299792458.0L;
  const long double m = lambda_nm / 1e9L;
  const long double x = kH * kC / (m * 1.380649e-23L * temperature_k);
  return 2 * kH * kC * kC / (m * m * m * m * m) / expm1l(x) / 1e9L;
}

/// By the midpoint rule in the wavelength's logarithm.
long double planck_integral(long double first_nm, long double last_nm, long double temperature_k) {
  constexpr int kSteps = 400000;
  const long double step = (logl(last_nm) - logl(first_nm)) / kSteps;
  long double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const long double nm = expl(logl(first_nm) + (i + 0.5L) * step);
    sum += nm * planck_exactly(nm, temperature_k);
  }
  return sum * step;
}

float looked_up(const Spectrum& spectrum, float nm) {
  auto lambda = *WavelengthLanes::create(1, 1);
  auto value = *WavelengthLanes::create(1, 1);
  lambda.at(0, 0) = nm;
  EXPECT_TRUE(sample(spectrum, lambda.view(), value.span()));
  return value.at(0, 0);
}

// --- black bodies

TEST(BlackbodySpectrum, IntegralsFarBeyondThePeakAreWithinTheirBound) {
  for (const double t : {300.0, 6500.0}) {
    const double unit = 1.4387768775e7 / t;  // nm
    for (const double from : {10.0, 1e3, 1e6}) {
      for (const double times : {4.0, 30.0}) {
        const double a = unit * from;
        const auto got = BlackbodySpectrum::create(t)->integral(a, times * a);
        const auto want = static_cast<double>(planck_integral(a, times * a, t));
        EXPECT_NEAR(got / want, 1, 5e-11) << t << " K, " << a << " to " << times * a;  // the sum's own error
      }
    }
  }
}

TEST(BlackbodySpectrum, IntegralsToInfinityFarBeyondThePeakAreWithinTheirBound) {
  // Where Rayleigh and Jeans hold, 2 c k T / (3 lambda^3), to a relative x.
  const double t = 6500;
  const double lambda = 1e12;
  const double want = 2 * 299792458.0 * 1.380649e-23 * t / 3 / std::pow(lambda * 1e-9, 3);
  EXPECT_NEAR(BlackbodySpectrum::create(t)->integral(lambda, kInfinity) / want, 1, 1e-6);
}

TEST(BlackbodySpectrum, ValuesFarBelowThePeakAreWithinTheirBound) {
  const double at[][2] = {{427.94, 60.5255}, {8417.94, 2.84881}, {23.145, 1059.81}, {3.01395e7, 0.00112506}};
  for (const auto& [t, nm] : at) {
    const double bound = std::max(1e-13, 0x1p-51 * 1.4387768775e7 / (nm * t));
    EXPECT_NEAR(static_cast<double>((*BlackbodySpectrum::create(t))(nm) / planck_exactly(nm, t)), 1, bound)
        << t << " K at " << nm;
  }
}

TEST(BlackbodySpectrum, ValuesFarBeyondThePeakAreWithinTheirBound) {
  for (const double nm : {1e9, 1e15}) {
    EXPECT_NEAR(static_cast<double>((*BlackbodySpectrum::create(6500))(nm) / planck_exactly(nm, 6500)), 1,
                1e-13)
        << nm;
  }
}

TEST(SpectrumSampler, BlackBodiesAreFiniteAtEveryWavelength) {
  for (const double t : {1.0, 6500.0, 1e9}) {
    for (const float nm : {1e-38F, 1e-4F, 2e-4F, 1e9F, 1e15F, 1e20F, 3e38F}) {
      const auto s = *BlackbodySpectrum::create(t);
      const float got = looked_up(s, nm);
      EXPECT_TRUE(std::isfinite(got)) << t << " K at " << nm;
      EXPECT_LE(got, s(nm) * (1 + 9 * kU) + 1.5e-45) << t << " K at " << nm;
      if (nm < 1e10F) {
        EXPECT_NEAR(got, s(nm), 9 * kU * s(nm) + 1.5e-45) << t << " K at " << nm;
      }
    }
  }
}

TEST(InnerProduct, OfABlackBodyOverAVeryWideRangeIsItsIntegral) {
  const auto s = *BlackbodySpectrum::create(6500);
  for (const double last : {1e10, 1e11, 1e12, 1e13}) {
    EXPECT_NEAR(inner_product(ConstantSpectrum(1), s, 1, last) / s.integral(1, last), 1, 1e-9) << last;
  }
}

TEST(PhotonRate, OfABlackBodyOverAVeryWideRangeIsTheLaws) {
  // 4 zeta(3) c (k T / (h c))^3.
  const double kt = 1.380649e-23 * 6500 / (6.62607015e-34 * 299792458.0);
  const double want = 4 * 1.2020569031595942 * 299792458.0 * kt * kt * kt;
  EXPECT_NEAR(photon_rate(*BlackbodySpectrum::create(6500), 1, 1e12)->value() / want, 1, 1e-9);
}

// --- tables

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

TEST(SpectrumSampler, KnotsThatAreNoFloatsAreWithinTheBoundForThoseRoundedToFloat) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> nm;
  std::vector<double> rounded;
  std::vector<double> v;
  for (double at = 400.1; at < 700; at += 0.3 + unit(random)) {
    nm.push_back(at);
    rounded.push_back(static_cast<float>(at));
    v.push_back(unit(random));
  }
  const auto sampler = *SpectrumSampler::create(*PiecewiseLinearSpectrum::from_samples(nm, v));
  const auto want = *PiecewiseLinearSpectrum::from_samples(rounded, v);
  auto lambda = *WavelengthLanes::create(4096, 1);
  auto values = *WavelengthLanes::create(4096, 1);
  for (std::size_t i = 0; i < 4096; ++i) {
    lambda.at(i, 0) = static_cast<float>(nm.front() + (nm.back() - nm.front()) * unit(random));
  }
  ASSERT_TRUE(sampler.sample(lambda.view(), values.span()));
  double worst = 0;
  for (std::size_t i = 0; i < 4096; ++i) {
    const double at = lambda.at(i, 0);
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(rounded, at) - rounded.begin());
    if (above == 0 || above == rounded.size()) continue;
    const double larger = std::max(v[above - 1], v[above]);
    worst = std::max(worst, std::abs(values.at(i, 0) - want(at)) / (kU * larger));
  }
  EXPECT_LE(worst, 4);  // in u of the larger neighbour
}

TEST(SpectrumSampler, SlopesBeyondFloatAreErrorsOrRight) {
  const double nm[] = {1, 2};
  const double v[] = {-3e38, 3e38};
  const auto s = *PiecewiseLinearSpectrum::from_samples(nm, v);
  if (!SpectrumSampler::create(s)) return;
  EXPECT_NEAR(looked_up(s, 1.5F), 0, 4 * kU * 3e38);
  EXPECT_NEAR(looked_up(s, 1.25F), -1.5e38, 4 * kU * 3e38);
}

TEST(SpectrumSampler, KnotsWhoseRangeIsBeyondFloatStayInTheirTable) {
  const auto s = *PiecewiseLinearSpectrum::from_samples(std::array{-3e38, 3e38}, std::array{1.0, 2.0});
  EXPECT_FALSE(SpectrumSampler::create(s));
}

TEST(SpectrumSampler, KnotsWithinADenormalRangeStayInTheirTable) {
  // As load_spectrum() takes it: wavelengths above 0.
  const auto s = *PiecewiseLinearSpectrum::from_samples(std::array{1e-40, 1.1e-40}, std::array{1.0, 2.0});
  EXPECT_FALSE(SpectrumSampler::create(s));  // its slope is beyond float
}

// --- Gaussians

TEST(GaussianSumSpectrum, MaximumOfALobeNarrowerThanWavelengthsCanBeTold) {
  for (const GaussianSumSpectrum::Lobe lobe :
       {GaussianSumSpectrum::Lobe{1, 550, 1e-14, 1e-14}, {1, 1e17, 1, 1}}) {
    EXPECT_EQ(GaussianSumSpectrum::from_lobes({lobe})->max_value(), 1);
  }
}

TEST(SpectrumSampler, GaussiansOfExtremeWidthAndHeightAreWhatTheyAre) {
  EXPECT_EQ(looked_up(*GaussianSumSpectrum::from_lobes({{1, 500, 1e-310, 1e-310}}), 500),
            1);  // 0 * (1 / sigma)
  EXPECT_FALSE(SpectrumSampler::create(*GaussianSumSpectrum::from_lobes({{1e300, 500, 1, 1}})));
}

// --- wavelengths

TEST(SampleWavelengths, VisibleOnesOverInfraredRangesAreInRangeWithDensitiesThatAddUp) {
  for (const auto& [first, last] : {std::pair{2500.0, 4000.0}, {3000.0, 5000.0}, {8000.0, 14000.0}}) {
    constexpr std::size_t kLanes = 4096;
    auto u = *ScalarLanes::create(kLanes);
    for (std::size_t i = 0; i < kLanes; ++i) u[i] = static_cast<float>(i) / kLanes;
    auto w = *SampledWavelengths::create(kLanes, 1);
    if (!sample_wavelengths(WavelengthSampling::kVisible, u.view(), w, first, last)) continue;  // may refuse
    std::size_t bad = 0;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double nm = w.lambda_nm.at(i, 0);
      const double density = w.density.at(i, 0);
      // sech^2 over the difference of two tanh, in a form where nothing cancels; in logarithms.
      const auto log_cosh = [](double x) {
        return std::abs(x) + std::log1p(std::exp(-2 * std::abs(x))) - std::log(2);
      };
      const double a = 0.0072 * (first - 538);
      const double b = 0.0072 * (last - 538);
      const double x = 0.0072 * (nm - 538);
      const double log_sinh = (b - a) + std::log1p(-std::exp(-2 * (b - a))) - std::log(2);
      const double want = 0.0072 * std::exp(log_cosh(a) + log_cosh(b) - log_sinh - 2 * log_cosh(x));
      if (!(nm >= first - 1e-3 && nm <= last + 1e-3 && std::abs(density / want - 1) < 1e-4)) ++bad;
    }
    EXPECT_EQ(bad, 0U) << first << " to " << last;
  }
}

TEST(ProjectWavelengths, SteepCurvesAreWithinTheBound) {
  // From 0.7 at 500 nm to 0 at 501 nm: near the end the interpolation cancels.
  const double nm[] = {500, 501};
  const double v[] = {0.7, 0};
  const Spectrum fall = *PiecewiseLinearSpectrum::from_samples(nm, v);
  const auto curves = *ResponseCurves::create({fall, fall, fall});
  auto w = *SampledWavelengths::create(64, 1);
  auto radiance = *WavelengthLanes::create(64, 1);
  for (std::size_t i = 0; i < 64; ++i) {
    w.lambda_nm.at(i, 0) = 501 - static_cast<float>(i + 1) * 0x1p-15F;
    w.density.at(i, 0) = radiance.at(i, 0) = 1;
  }
  auto out = *ColorLanes::create(64);
  ASSERT_TRUE(project(curves, radiance.view(), w, out.span()));
  double worst = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    const double want = fall(static_cast<double>(w.lambda_nm.at(i, 0)));
    worst = std::max(worst, std::abs(out.at(i, 1) - want) / (0.7 * kU));
  }
  EXPECT_LE(worst, 1 + 6);  // (K + 6) u
}

// --- directions and emitters

TEST(SphericalTheta, IsRightForAnyLength) {
  for (const double s : {5e-324, 1.0, 1e200, 1.7e308}) {
    EXPECT_NEAR(spherical_theta({s, s, s}), std::atan(std::numbers::sqrt2), 1e-15) << s;
  }
}

TEST(SolidAngleOfRectangle, IsRightInAnyUnit) {
  for (const double s : {1e-200, 1.0, 1e200}) {
    EXPECT_NEAR(solid_angle_of_rectangle(-s, s, -s, s, s), 2 * std::numbers::pi / 3, 4e-15) << s;
  }
}

TEST(ProjectedSolidAngleOverCorner, IsRightForAnyFiniteSides) {
  const double want = projected_solid_angle_over_corner(1, 1, 1)->value();
  EXPECT_NEAR(projected_solid_angle_over_corner(1.7e308, 1.7e308, 1.7e308)->value(), want, 1e-15);
}

TEST(ProjectedSolidAngle, OfADiskNearTheReceiversPlaneIsWithinTheBound) {
  for (const double e : {1.0, 1e-3, 1e-6}) {
    // The normal (3, 0, 4) / 5 is no number of doubles, the angle to a plane at 5 e is.
    const Vector3 centre = {4000 + 3 * e, 0, -3000 + 4 * e};
    const long double h = (3.0L * centre.x + 4.0L * centre.z) / 5;
    const long double aside = (4.0L * centre.x - 3.0L * centre.z) / 5;
    const long double r = 1000;
    const long double a = (aside - r) * (aside + r) + h * h;
    const long double b = hypotl(aside - r, h) * hypotl(aside + r, h);
    const long double want = std::numbers::pi_v<long double> / 2 * (4 * r * r * h * h / b / (a + b));
    const auto got = projected_solid_angle(DiskEmitter{centre, {-3, 0, -4}, 1000}, Receiver{{}, {3, 0, 4}});
    ASSERT_TRUE(got);
    EXPECT_NEAR(static_cast<double>(got->value() / want), 1, 1e-14 + 1e-12 / e)
        << e;  // 5000 m of 1e-16, twice
  }
}

}  // namespace
}  // namespace spectile::test
