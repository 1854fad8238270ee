// Sampled wavelengths: samplers against their distributions, and estimates that are right on average.
#include <spectile/lanes/wavelengths.hpp>

#include "src/data/tables.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

/// Lanes with wavelengths from low to high in random order, and the values that a spectrum has there.
struct Looked {
  WavelengthLanes lambda, values;
};

Looked look_up(const Spectrum& spectrum, double low, double high, std::size_t lanes = 4099,
               std::size_t count = 4) {
  Looked out{*WavelengthLanes::create(lanes, count), *WavelengthLanes::create(lanes, count)};
  std::mt19937 random(11);
  std::uniform_real_distribution<float> nm(static_cast<float>(low), static_cast<float>(high));
  for (std::size_t i = 0; i < lanes * count; ++i) out.lambda.at(i % lanes, i / lanes) = nm(random);
  EXPECT_TRUE(sample(spectrum, out.lambda.view(), out.values.span()));
  return out;
}

void expect_within(const Spectrum& spectrum, double low, double high, double relative, double absolute) {
  const Looked got = look_up(spectrum, low, high);
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < 4099; ++i) {
      const double nm = got.lambda.at(i, k);
      const double want = spectrum(nm);
      ASSERT_NEAR(got.values.at(i, k), want, relative * std::abs(want) + absolute)
          << spectrum.to_text() << " at " << nm;
    }
  }
}

TEST(SpectrumSampler, IsTheDistributionWithinItsBound) {
  constexpr double kU = 0x1p-24;
  expect_within(ConstantSpectrum(0.3), 300, 900, kU, 0);
  for (const double t : {1.0, 300.0, 2856.0, 6504.0, 1e5, 1e9}) {
    expect_within(*BlackbodySpectrum::create(t), 1, 20000, 6 * kU, 1e-44);
    expect_within(*BlackbodySpectrum::create(t, BlackbodySpectrum::Scale::kNormalized), 200, 2000, 6 * kU,
                  1e-44);
  }
  expect_within(*GaussianSumSpectrum::from_lobes({{2, 500, 20, 30}, {1, 620, 3, 1}}), 300, 900, 1.01 * kU,
                1e-44);
  const auto dense = *DenselySampledSpectrum::from(*BlackbodySpectrum::create(4000));
  expect_within(dense, 300, 900, 4 * kU, 0);
  const auto light = PiecewiseLinearSpectrum(*illuminant("FL11"));
  expect_within(light, 300, 900, 4 * kU, 4 * kU * light.max_value());
}

TEST(SpectrumSampler, UpsampledOnesAreWhatTheirFormulasSay) {
  for (const Method method : {Method::kSmitsExact, Method::kMallett, Method::kSigmoid}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
      const auto upsampler = *Upsampler::create(method, quantity, Bands());
      const auto s = *UpsampledSpectrum::from_rgb(upsampler, {0.9, 0.4, 0.05});
      expect_within(s, 300, 900, 0, 3e-7 * s.max_value() + 3e-7);
    }
  }
}

TEST(SpectrumSampler, AnyPiecewiseLinearTableIsFound) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int table = 0; table < 300; ++table) {
    std::vector<double> nm;
    std::vector<double> v;
    double at = 300 + 200 * unit(random);
    const std::size_t count = 1 + random() % 60;
    for (std::size_t i = 0; i < count; ++i) {
      // Bunched and far apart; as floats, so that the knots are where they were.
      nm.push_back(static_cast<float>(at));
      v.push_back(unit(random));
      at += random() % 4 == 0 ? 0 : std::pow(10.0, 4 * unit(random) - 2);
    }
    const auto s = *PiecewiseLinearSpectrum::from_samples(nm, v);
    const auto sampler = *SpectrumSampler::create(s);
    auto lambda = *WavelengthLanes::create(256, 1);
    auto values = *WavelengthLanes::create(256, 1);
    for (std::size_t i = 0; i < 256; ++i) {
      lambda.at(i, 0) = i < nm.size()
                            ? static_cast<float>(nm[i])
                            : static_cast<float>(nm.front() - 5 + (at - nm.front() + 10) * unit(random));
    }
    ASSERT_TRUE(sampler.sample(lambda.view(), values.span()));
    for (std::size_t i = 0; i < 256; ++i) {
      ASSERT_NEAR(values.at(i, 0), s(static_cast<double>(lambda.at(i, 0))), 3e-7) << table << " " << i;
    }
  }
}

TEST(SpectrumSampler, ResultsDependOnNeitherThreadsNorTiles) {
  const Spectrum s = PiecewiseLinearSpectrum(*illuminant("FL11"));
  const Looked want = look_up(s, 300, 900);
  auto values = *WavelengthLanes::create(4099, 4);
  for (const int threads : {1, 2, 5}) {
    ASSERT_TRUE(sample(s, want.lambda.view(), values.span(), {threads, 64}));
    for (std::size_t i = 0; i < 4 * 4099; ++i) {
      ASSERT_TRUE(same_bits(values.at(i % 4099, i / 4099), want.values.at(i % 4099, i / 4099)));
    }
  }
}

TEST(SpectrumSampler, BatchesThatDoNotFitAreErrors) {
  const auto sampler = *SpectrumSampler::create(ConstantSpectrum(1));
  auto four = *WavelengthLanes::create(64, 4);
  auto five = *WavelengthLanes::create(64, 5);
  auto more = *WavelengthLanes::create(65, 4);
  EXPECT_FALSE(sampler.sample(four.view(), five.span()));
  EXPECT_FALSE(sampler.sample(four.view(), more.span()));
  EXPECT_FALSE(WavelengthLanes::create(64, 0));
  EXPECT_FALSE(WavelengthLanes::create(64, 65));
}

// --- Drawing

SampledWavelengths drawn(WavelengthSampling sampling, std::size_t lanes, std::size_t count,
                         std::uint32_t seed, double first = 360, double last = 830) {
  auto u = *ScalarLanes::create(lanes);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  for (std::size_t i = 0; i < lanes; ++i) u[i] = unit(random);
  auto out = *SampledWavelengths::create(lanes, count);
  EXPECT_TRUE(sample_wavelengths(sampling, u.view(), out, first, last));
  return out;
}

TEST(SampleWavelengths, UniformOnesAreStratifiedAndWrapAround) {
  const auto w = drawn(WavelengthSampling::kUniform, 999, 8, 1, 400, 720);
  for (std::size_t i = 0; i < 999; ++i) {
    std::vector<float> sorted;
    for (std::size_t k = 0; k < 8; ++k) {
      sorted.push_back(w.lambda_nm.at(i, k));
      ASSERT_EQ(w.density.at(i, k), 1.0F / 320);
    }
    std::sort(sorted.begin(), sorted.end());
    ASSERT_GE(sorted.front(), 400);
    ASSERT_LE(sorted.back(), 720);
    for (std::size_t k = 1; k < 8; ++k) ASSERT_NEAR(sorted[k] - sorted[k - 1], 40, 1e-3);
  }
}

TEST(SampleWavelengths, VisibleOnesFollowTheirDensity) {
  const auto w = drawn(WavelengthSampling::kVisible, 200000, 1, 2);
  // Shares of 47 intervals of 10 nm against the density's integral; five standard deviations.
  std::vector<double> counts(47);
  for (std::size_t i = 0; i < w.lanes(); ++i) {
    const double nm = w.lambda_nm.at(i, 0);
    ASSERT_GE(nm, 359.999);
    ASSERT_LE(nm, 830.001);
    counts[std::min<std::size_t>(46, static_cast<std::size_t>((std::max(nm, 360.0) - 360) / 10))] += 1;
    const double c = std::cosh(0.0072 * (nm - 538));
    ASSERT_NEAR(w.density.at(i, 0) * c * c, 0.0039398042, 3e-9);  // the published peak
  }
  const auto share = [](double nm) { return std::tanh(0.0072 * (nm - 538)) / 1.82750197; };
  for (std::size_t b = 0; b < 47; ++b) {
    const double p = share(370 + 10.0 * static_cast<double>(b)) - share(360 + 10.0 * static_cast<double>(b));
    const double n = static_cast<double>(w.lanes());
    EXPECT_NEAR(counts[b], p * n, 5 * std::sqrt(p * n)) << b;
  }
}

TEST(SampleWavelengths, NumbersThatAreNoneGiveNoneAndOthersAreLimited) {
  auto u = *ScalarLanes::create(4);
  u[0] = kNan;
  u[1] = -3;
  u[2] = 1;
  u[3] = kInf;
  auto out = *SampledWavelengths::create(4, 2);
  for (const auto sampling : {WavelengthSampling::kUniform, WavelengthSampling::kVisible}) {
    ASSERT_TRUE(sample_wavelengths(sampling, u.view(), out));
    EXPECT_TRUE(std::isnan(out.lambda_nm.at(0, 0)));
    EXPECT_NEAR(out.lambda_nm.at(1, 0), 360, 1e-3);
    for (std::size_t i = 1; i < 4; ++i) {
      EXPECT_LE(out.lambda_nm.at(i, 0), 830.001F);
      EXPECT_GT(out.density.at(i, 0), 0);
    }
  }
  EXPECT_FALSE(sample_wavelengths(WavelengthSampling::kUniform, u.view(), out, 700, 400));
  EXPECT_FALSE(sample_wavelengths(WavelengthSampling::kUniform, u.view(), out, 400, kInf));
  auto more = *SampledWavelengths::create(5, 2);
  EXPECT_FALSE(sample_wavelengths(WavelengthSampling::kUniform, u.view(), more));
}

// --- Projecting

struct Estimate {
  std::array<double, 3> mean{}, variance{};  // of one lane; the mean's own is that over the lanes
};

Estimate estimate(const Spectrum& light, WavelengthSampling sampling, std::size_t count, bool terminate,
                  std::size_t lanes = 100000) {
  auto w = drawn(sampling, lanes, count, 21);
  if (terminate) {
    std::vector<std::uint8_t> hit(lanes);
    for (std::size_t i = 0; i < lanes; ++i) hit[i] = i % 3 != 0;
    EXPECT_TRUE(terminate_secondary(w, hit));
  }
  auto radiance = *WavelengthLanes::create(lanes, count);
  EXPECT_TRUE(sample(light, w.lambda_nm.view(), radiance.span()));
  auto xyz = *ColorLanes::create(lanes);
  EXPECT_TRUE(project(*ResponseCurves::of_observer(), radiance.view(), w, xyz.span()));
  Estimate out;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < lanes; ++i) {
      sum += xyz.at(i, c);
      squares += static_cast<double>(xyz.at(i, c)) * xyz.at(i, c);
    }
    const double n = static_cast<double>(lanes);
    out.mean[c] = sum / n;
    out.variance[c] = squares / n - out.mean[c] * out.mean[c];
  }
  return out;
}

std::array<double, 3> truth(const Spectrum& light) {
  const data::MatchingFunctions& cie = data::kCie1931;
  const std::span<const double> bars[3] = {cie.x_bar, cie.y_bar, cie.z_bar};
  std::array<double, 3> out{};
  double whole = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto curve = *DenselySampledSpectrum::from_values(360, {bars[c].begin(), bars[c].end()});
    out[c] = inner_product(curve, light);
    if (c == 1) whole = curve.integral(360, 830);
  }
  for (double& v : out) v /= whole;
  return out;
}

TEST(ProjectWavelengths, EstimatesAreUnbiased) {
  // 99.99 % of all means lie within four standard errors; the seeds are fixed. Stratified lanes of the
  // smoothest light have almost no variance: rounding is allowed for.
  const Spectrum lights[] = {ConstantSpectrum(1),
                             *BlackbodySpectrum::create(2856, BlackbodySpectrum::Scale::kNormalized),
                             PiecewiseLinearSpectrum(*illuminant("FL11")).scaled(0.01)};
  for (const Spectrum& light : lights) {
    const auto want = truth(light);
    for (const auto sampling : {WavelengthSampling::kUniform, WavelengthSampling::kVisible}) {
      for (const std::size_t count : {1, 4, 8}) {
        for (const bool terminate : {false, true}) {
          const Estimate got = estimate(light, sampling, count, terminate);
          for (std::size_t c = 0; c < 3; ++c) {
            const double error = std::sqrt(got.variance[c] / 100000);
            EXPECT_NEAR(got.mean[c], want[c], 4 * error + 1e-6 * want[c])
                << light.to_text() << " " << count << " component " << c;
          }
        }
      }
    }
  }
}

TEST(ProjectWavelengths, VisibleOnesHaveTheLowerVariance) {
  for (const Spectrum& light :
       {Spectrum(ConstantSpectrum(1)), Spectrum(PiecewiseLinearSpectrum(*illuminant("D65")))}) {
    for (const std::size_t count : {1, 4}) {
      const Estimate uniform = estimate(light, WavelengthSampling::kUniform, count, false);
      const Estimate visible = estimate(light, WavelengthSampling::kVisible, count, false);
      EXPECT_LT(visible.variance[1], uniform.variance[1]) << count;
    }
    // Of single wavelengths, in luminance, to less than half.
    EXPECT_LT(estimate(light, WavelengthSampling::kVisible, 1, false).variance[1],
              0.5 * estimate(light, WavelengthSampling::kUniform, 1, false).variance[1]);
  }
}

TEST(TerminateSecondary, OnlyTheFirstCountsAndOnce) {
  auto w = drawn(WavelengthSampling::kUniform, 3, 4, 5);
  const float density = w.density.at(0, 0);
  const std::uint8_t hit[] = {1, 0, 1};
  ASSERT_TRUE(terminate_secondary(w, hit));
  EXPECT_EQ(w.density.at(0, 0), density / 4);
  EXPECT_EQ(w.density.at(0, 3), 0);
  EXPECT_EQ(w.density.at(1, 0), density);
  ASSERT_TRUE(terminate_secondary(w));
  EXPECT_EQ(w.density.at(0, 0), density / 4);
  EXPECT_EQ(w.density.at(1, 0), density / 4);
  EXPECT_FALSE(terminate_secondary(w, std::span(hit, 2)));
  // A terminated wavelength's radiance does not matter, not even when it is none.
  auto radiance = *WavelengthLanes::create(3, 4);
  for (std::size_t i = 0; i < 12; ++i) radiance.at(i % 3, i / 3) = i < 3 ? 2.0F : kNan;
  auto xyz = *ColorLanes::create(3);
  ASSERT_TRUE(project(*ResponseCurves::of_observer(), radiance.view(), w, xyz.span()));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(xyz.at(i, 1)));
}

TEST(ResponseCurves, AnyThreeWillDo) {
  const auto box = *PiecewiseLinearSpectrum::from_samples(std::array{500.0, 600.0}, std::array{1.0, 1.0});
  const auto curves =
      *ResponseCurves::create({box, ConstantSpectrum(1), *BlackbodySpectrum::create(5000)}, {2, 0.5, 1e-9});
  auto w = drawn(WavelengthSampling::kUniform, 10000, 8, 6);
  auto radiance = *WavelengthLanes::create(10000, 8);
  ASSERT_TRUE(sample(ConstantSpectrum(3), w.lambda_nm.view(), radiance.span()));
  auto rgb = *ColorLanes::create(10000);
  ASSERT_TRUE(project(curves, radiance.view(), w, rgb.span()));
  double sums[2] = {};
  for (std::size_t i = 0; i < 10000; ++i) {
    sums[0] += rgb.at(i, 0) / 10000.0;
    sums[1] += rgb.at(i, 1) / 10000.0;
  }
  // The box's own edges are a nanometre wide in the table.
  EXPECT_NEAR(sums[0], 2 * 3 * 101, 12);
  EXPECT_NEAR(sums[1], 0.5 * 3 * 470, 1e-2);
}

}  // namespace
}  // namespace spectile::test
