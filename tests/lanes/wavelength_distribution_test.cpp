// Wavelengths drawn as a light falls on the eye: counts, densities, estimates that are right on average.
#include <spectile/color/response_curves.hpp>
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/lanes/wavelength_distribution.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/lanes/wavelengths_support.hpp"

namespace spectile::test {
namespace {

Spectrum fl11() {
  return *named_spectrum("FL11");
}

/// Lanes of drawn wavelengths by random numbers that are evenly spread.
SampledWavelengths drawn(const WavelengthDistribution& from, std::size_t lanes, std::size_t count) {
  auto u = *ScalarLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i)
    u[i] = (static_cast<float>(i) + 0.5F) / static_cast<float>(lanes * count);
  auto out = *SampledWavelengths::create(lanes, count);
  EXPECT_TRUE(sample_wavelengths(from, u, out));
  return out;
}

TEST(WavelengthDistributions, AreSharesOfEachNanometre) {
  const auto of = *WavelengthDistribution::of_light(fl11(), Observer::kCie1931, 0);
  const Spectrum curves[3] = {*named_spectrum("cie1931-x"), *named_spectrum("cie1931-y"),
                              *named_spectrum("cie1931-z")};
  std::vector<double> want(470);
  for (const Spectrum& curve : curves) {
    const double whole = inner_product(fl11(), curve);
    for (int i = 0; i < 470; ++i) {
      const double part = inner_product(fl11(), curve, 360 + i, 361 + i) / whole;
      want[static_cast<std::size_t>(i)] += part * part;
    }
  }
  double all = 0;
  for (double& v : want) all += v = std::sqrt(v);
  double sum = 0;
  for (int i = 0; i < 470; ++i) {
    // Two starts in float.
    EXPECT_NEAR(of.density(360.5 + i), want[static_cast<std::size_t>(i)] / all, 1.3e-7) << i;
    sum += of.density(360.25 + i);
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_EQ(of.density(359.9), 0);
  EXPECT_EQ(of.density(830.1), 0);
  EXPECT_GT(of.density(546), 20 * of.density(570));  // a line, and between the lines
  EXPECT_EQ(of.first_nm(), 360);
  EXPECT_EQ(of.last_nm(), 830);
}

TEST(WavelengthDistributions, AreDrawnAsOftenAsTheySay) {
  const auto of = *WavelengthDistribution::of_light(fl11());
  for (const std::size_t count : {1, 4}) {
    constexpr std::size_t kDraws = std::size_t{1} << 18;
    const auto w = drawn(of, kDraws / count, count);
    std::vector<double> counts(470);
    for (std::size_t i = 0; i < w.lanes(); ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        const float nm = w.lambda_nm.at(i, k);
        ASSERT_GE(nm, 360);
        ASSERT_LT(nm, 830);
        counts[static_cast<std::size_t>(nm) - 360] += 1;
        ASSERT_EQ(w.density.at(i, k), static_cast<float>(of.density(static_cast<double>(nm))));
      }
    }
    for (std::size_t b = 0; b < 470; ++b) {
      // Evenly spread numbers leave one over at each end, in each of the parts that K shifts make.
      EXPECT_NEAR(counts[b], of.density(360.5 + static_cast<double>(b)) * kDraws,
                  2.0 * static_cast<double>(count))
          << b;
    }
  }
}

TEST(WavelengthDistributions, KeepAnEvenShare) {
  const auto of = *WavelengthDistribution::of_light(fl11(), Observer::kCie1964, 0.25);
  for (int nm = 360; nm < 830; ++nm) EXPECT_GE(of.density(nm + 0.5), 0.25 / 470 - 1.3e-7);
  const auto even = *WavelengthDistribution::proportional_to(fl11(), 1, 400, 700);
  for (int nm = 400; nm < 700; ++nm) EXPECT_NEAR(even.density(nm + 0.5), 1.0 / 300, 1.3e-7);
}

TEST(WavelengthDistributions, DensitiesOfAnyWavelengthsAreLookedUp) {
  const auto of = *WavelengthDistribution::of_light(fl11());
  auto w = drawn_wavelengths(WavelengthSampling::kVisible, 500, 4, 3);
  w.lambda_nm.at(0, 0) = kNan;
  w.lambda_nm.at(1, 0) = 359.99F;
  w.lambda_nm.at(2, 0) = kInf;
  auto density = own_batch(500, 4);
  ASSERT_TRUE(wavelength_density(of, w.lambda_nm, density));
  EXPECT_TRUE(std::isnan(density.at(0, 0)));
  EXPECT_EQ(density.at(1, 0), 0);
  EXPECT_EQ(density.at(2, 0), 0);
  for (std::size_t i = 3; i < 500; ++i) {
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_EQ(density.at(i, k), static_cast<float>(of.density(static_cast<double>(w.lambda_nm.at(i, k)))));
  }
}

/// Means of the X, Y, Z of a light estimated from four wavelengths a lane, and variances of single estimates.
struct Estimate {
  std::array<double, 3> mean{}, variance{};
  /// Relative to the components, summed.
  double noise() const {
    double out = 0;
    for (std::size_t c = 0; c < 3; ++c) out += variance[c] / (mean[c] * mean[c]);
    return out;
  }
};

Estimate color_of(const Spectrum& light, const SampledWavelengths& w) {
  auto radiance = *SampledSpectra::create(w.axis(), w.lanes());
  auto xyz = *ColorLanes::create(w.lanes());
  EXPECT_TRUE(sample(light, w.lambda_nm, radiance));
  EXPECT_TRUE(project(*ResponseCurves::of_observer(), radiance, w, xyz));
  Estimate out;
  const auto n = static_cast<double>(w.lanes());
  for (std::size_t c = 0; c < 3; ++c) {
    double squares = 0;
    for (std::size_t i = 0; i < w.lanes(); ++i) {
      const double v = xyz.at(i, c);
      out.mean[c] += v / n;
      squares += v * v / n;
    }
    out.variance[c] = squares - out.mean[c] * out.mean[c];
  }
  return out;
}

/// Wavelengths drawn in proportion to a light times a mixture of the matching functions.
SampledWavelengths drawn_as(const Spectrum& light, const std::array<double, 3>& mixture, std::size_t lanes) {
  const Spectrum curves[3] = {*named_spectrum("cie1931-x"), *named_spectrum("cie1931-y"),
                              *named_spectrum("cie1931-z")};
  std::vector<double> values;
  for (int nm = 360; nm <= 830; ++nm) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += mixture[c] * curves[c](nm);
    values.push_back(light(nm) * sum);
  }
  const auto of = *WavelengthDistribution::proportional_to(*DenselySampledSpectrum::from_values(360, values));
  auto w = *SampledWavelengths::create(lanes, 4);
  EXPECT_TRUE(sample_wavelengths(of, random_lanes(lanes, 8), w));
  return w;
}

TEST(WavelengthDistributions, OfTheLightHaveLessThanHalfTheVarianceAndTheSameMean) {
  constexpr std::size_t kMany = 100000;
  auto w = *SampledWavelengths::create(kMany, 4);
  std::printf("variance: uniform, visible, of the light, light * (x + y + z), light * y\n");
  for (const char* name : {"A", "D65", "FL2", "FL11", "HP1", "LED-B3"}) {
    const Spectrum light = *named_spectrum(name);
    ASSERT_TRUE(sample_wavelengths(*WavelengthDistribution::of_light(light), random_lanes(kMany, 8), w));
    const Estimate aware = color_of(light, w);
    std::printf("%s:", name);
    for (const auto sampling : {WavelengthSampling::kUniform, WavelengthSampling::kVisible}) {
      const Estimate other = color_of(light, drawn_wavelengths(sampling, kMany, 4, 7));
      const double part = sampling == WavelengthSampling::kUniform ? 0.5 : 1;
      EXPECT_LT(aware.noise(), part * other.noise()) << name;
      for (std::size_t c = 0; c < 3; ++c) {
        const double deviation = std::sqrt((aware.variance[c] + other.variance[c]) / kMany);
        EXPECT_NEAR(aware.mean[c], other.mean[c], 4.5 * deviation) << name << " " << c;
      }
      std::printf(" %.3f,", other.noise());
    }
    std::printf(" %.3f, %.3f, %.3f\n", aware.noise(),
                color_of(light, drawn_as(light, {1, 1, 1}, kMany)).noise(),
                color_of(light, drawn_as(light, {0, 1, 0}, kMany)).noise());
  }
}

TEST(WavelengthDistributions, OfNothingAndOfWhatCannotBe) {
  const Spectrum black = ConstantSpectrum(0);
  EXPECT_FALSE(WavelengthDistribution::proportional_to(black));
  EXPECT_TRUE(WavelengthDistribution::proportional_to(black, 1));
  const Spectrum one = ConstantSpectrum(1);
  EXPECT_FALSE(WavelengthDistribution::proportional_to(one, -0.1));
  EXPECT_FALSE(WavelengthDistribution::proportional_to(one, 1.1));
  EXPECT_FALSE(WavelengthDistribution::proportional_to(one, 0, 700, 400));
  EXPECT_FALSE(WavelengthDistribution::proportional_to(one, 0, 0, 400));
  EXPECT_FALSE(WavelengthDistribution::proportional_to(Spectrum(ConstantSpectrum(HUGE_VAL))));
  // One nanometre alone, and what is below 0.
  const auto narrow = *PiecewiseLinearSpectrum::from_samples(std::vector<double>{500, 500, 501, 501},
                                                             std::vector<double>{-1, 2, 2, -1});
  const auto of = *WavelengthDistribution::proportional_to(narrow, 0);
  EXPECT_EQ(of.density(500.5), 1);
  const auto w = drawn(of, 100, 3);
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_GE(w.lambda_nm.at(i / 3, i % 3), 500);
    EXPECT_LT(w.lambda_nm.at(i / 3, i % 3), 501);
  }
  auto u = *ScalarLanes::create(3);
  u[0] = kNan;
  u[1] = -kInf;
  u[2] = kInf;
  auto out = *SampledWavelengths::create(3, 2);
  ASSERT_TRUE(sample_wavelengths(of, u, out));
  EXPECT_TRUE(std::isnan(out.lambda_nm.at(0, 1)));
  EXPECT_EQ(out.lambda_nm.at(1, 0), 500);
  EXPECT_NEAR(out.lambda_nm.at(2, 0), 501, 1e-4);
  auto more = *SampledWavelengths::create(4, 2);
  EXPECT_EQ(sample_wavelengths(of, u, more).error().code, ErrorCode::kSizeMismatch);
}

TEST(BalanceHeuristic, WeighsThePathThatWasMadeForTheFirst) {
  auto w = drawn_wavelengths(WavelengthSampling::kUniform, 4, 4, 3);
  ASSERT_TRUE(terminate_secondary(w, LaneMask{0b1000}));
  auto density = own_batch(4, 4);
  for (std::size_t k = 0; k < 4; ++k) density.at(0, k) = 0.25F;
  density.at(1, 0) = 6;
  density.at(1, 2) = 2;
  density.at(3, 0) = 5;
  auto weight = *ScalarLanes::create(4);
  ASSERT_TRUE(balance_heuristic(density, w, weight));
  EXPECT_EQ(weight[0], 1);
  EXPECT_EQ(weight[1], 3);
  EXPECT_EQ(weight[2], 0);
  EXPECT_EQ(weight[3], 1);
  auto other = *ScalarLanes::create(5);
  EXPECT_FALSE(balance_heuristic(density, w, other));
  EXPECT_FALSE(balance_heuristic(own_batch(4, 3), w, weight));
  EXPECT_FALSE(balance_heuristic(*SampledSpectra::create(Bands(), 4), w, weight));
}

/// A direction x below the first wavelength, which the others may lie beyond: without the weight the estimate
/// is too low, with it it is right.
TEST(BalanceHeuristic, KeepsTheMeanOfAnEstimate) {
  constexpr std::size_t kMany = 100000;
  constexpr std::size_t kCount = 4;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  // For lambda in (0, 1): x has the density 1 / lambda below lambda; integrand 1 there; integral 1/2.
  const auto w = drawn_wavelengths(WavelengthSampling::kUniform, kMany, kCount, 6, 1, 2);
  auto path = own_batch(kMany, kCount);
  std::vector<double> seen(kMany);
  for (std::size_t i = 0; i < kMany; ++i) {
    const auto lambda = [&](std::size_t k) { return static_cast<double>(w.lambda_nm.at(i, k)) - 1 + 1e-9; };
    const double x = unit(random) * lambda(0);
    for (std::size_t k = 0; k < kCount; ++k) {
      path.at(i, k) = x < lambda(k) ? static_cast<float>(1 / lambda(k)) : 0.0F;
      seen[i] += x < lambda(k) ? 1.0 / kCount : 0;
    }
  }
  auto weight = *ScalarLanes::create(kMany);
  ASSERT_TRUE(balance_heuristic(path, w, weight));
  double sum = 0;
  double squares = 0;
  double plain = 0;
  for (std::size_t i = 0; i < kMany; ++i) {
    const double single = seen[i] / static_cast<double>(path.at(i, 0));
    const double estimate = single * static_cast<double>(weight[i]);
    plain += single / kMany;
    sum += estimate / kMany;
    squares += estimate * estimate / kMany;
  }
  EXPECT_NEAR(sum, 0.5, 4 * std::sqrt((squares - sum * sum) / kMany));
  EXPECT_LT(plain, 0.45);
}

TEST(WavelengthDistributions, NumbersThatFloatLoses) {
  // All but the middle's shares are beyond the smallest float's inverse.
  const auto lobe = *GaussianSumSpectrum::from_lobes({{1, 600, 5, 5}});
  const auto of = *WavelengthDistribution::proportional_to(lobe, 0);
  auto u = *ScalarLanes::create(2);
  u[1] = 0.75F;
  auto w = *SampledWavelengths::create(2, 4);
  ASSERT_TRUE(sample_wavelengths(of, u, w));
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_TRUE(std::isfinite(w.lambda_nm.at(i % 2, i / 2)));
    EXPECT_GT(w.density.at(i % 2, i / 2), 0);
  }
  const auto refused = WavelengthDistribution::proportional_to(lobe, 1e-6);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("too small for float"), std::string::npos);
  EXPECT_FALSE(WavelengthDistribution::proportional_to(ConstantSpectrum(1e307)));
  // Densities of other lanes or another K are no room for draws.
  w.density = own_batch(2, 3);
  EXPECT_FALSE(sample_wavelengths(of, u, w));
  EXPECT_FALSE(sample_wavelengths(WavelengthSampling::kUniform, u, w));
  EXPECT_FALSE(terminate_secondary(w));
}

}  // namespace
}  // namespace spectile::test
