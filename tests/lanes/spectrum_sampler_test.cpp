// Spectra sampled at the wavelengths of lanes: every kind within its bound, at the ends of tables and ranges
// too.
#include <cmath>
#include <limits>
#include <numbers>
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <spectile/upsampling/rgb_spectrum.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

constexpr double kU = 0x1p-24;

/// Lanes with wavelengths from low to high in random order, and the values that a spectrum has there.
struct Looked {
  SampledSpectra lambda, values;
};

Looked look_up(const Spectrum& spectrum, double low, double high, std::size_t lanes = 4099,
               std::size_t count = 4) {
  Looked out{own_batch(lanes, count), own_batch(lanes, count)};
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

float looked_up(const Spectrum& spectrum, float nm) {
  auto lambda = own_batch(1, 1);
  auto value = own_batch(1, 1);
  lambda.at(0, 0) = nm;
  EXPECT_TRUE(sample(spectrum, lambda.view(), value.span()));
  return value.at(0, 0);
}

TEST(SpectrumSampler, IsTheDistributionWithinItsBound) {
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
  for (const Method method : {Method::kSmitsExact, Method::kMallett, Method::kSigmoid,
                              Method::kSigmoidObserver, Method::kTetrahedral}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
      const auto upsampler = *Upsampler::create(method, quantity, Bands());
      const auto s = *rgb_spectrum(upsampler, {0.9, 0.4, 0.05});
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
    auto lambda = own_batch(256, 1);
    auto values = own_batch(256, 1);
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
  auto values = own_batch(4099, 4);
  for (const int threads : {1, 2, 5}) {
    ASSERT_TRUE(sample(s, want.lambda.view(), values.span(), {threads, 64}));
    for (std::size_t i = 0; i < 4 * 4099; ++i) {
      ASSERT_TRUE(same_bits(values.at(i % 4099, i / 4099), want.values.at(i % 4099, i / 4099)));
    }
  }
}

TEST(SpectrumSampler, BatchesThatDoNotFitAreErrors) {
  const auto sampler = *SpectrumSampler::create(ConstantSpectrum(1));
  auto four = own_batch(64, 4);
  auto five = own_batch(64, 5);
  auto more = own_batch(65, 4);
  EXPECT_FALSE(sampler.sample(four.view(), five.span()));
  EXPECT_FALSE(sampler.sample(four.view(), more.span()));
  EXPECT_FALSE(SpectralAxis::own_wavelengths(0));
  EXPECT_FALSE(SpectralAxis::own_wavelengths(65));
}

TEST(SpectrumSampler, TablesAtEveryNanometreEndWithTheirLastSample) {
  const auto s = *DenselySampledSpectrum::from_values(500, {1, 2, 4, 8});
  auto lambda = own_batch(6, 1);
  auto values = own_batch(6, 1);
  const float nm[] = {std::nextafter(500.0F, 0.0F), 500, 501, 502.5F, 503, std::nextafter(503.0F, 1000.0F)};
  const float want[] = {0, 1, 2, 6, 8, 0};
  for (std::size_t i = 0; i < 6; ++i) lambda.at(i, 0) = nm[i];
  ASSERT_TRUE(sample(s, lambda.view(), values.span()));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(values.at(i, 0), want[i]) << nm[i];
}

TEST(SpectrumSampler, TablesOfAnyShapeAreWithinFourUnits) {
  // The bound itself, table by table: bunched knots, ten thousand, from 1 to 1e9 nm, values of both signs.
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int shape = 0; shape < 4; ++shape) {
    for (int table = 0; table < 20; ++table) {
      std::vector<double> nm;
      std::vector<double> v;
      const std::size_t count = shape == 1 ? 10000 : 2 + random() % 50;
      double at = shape == 2 ? 1 : 400;
      for (std::size_t i = 0; i < count; ++i) {
        nm.push_back(std::min(1e9, static_cast<double>(static_cast<float>(at))));
        v.push_back(2 * unit(random) - 1);
        const double steps[] = {1e-4 * unit(random), 0.1 * unit(random), std::pow(10, 9 * unit(random) - 1),
                                unit(random)};
        at += steps[shape];
      }
      const auto s = *PiecewiseLinearSpectrum::from_samples(nm, v);
      auto lambda = own_batch(1024, 1);
      auto values = own_batch(1024, 1);
      for (std::size_t i = 0; i < 1024; ++i) {
        const std::size_t k = random() % (count - 1);
        lambda.at(i, 0) = static_cast<float>(nm[k] + (i % 2 == 0 ? 0 : unit(random)) * (nm[k + 1] - nm[k]));
      }
      ASSERT_TRUE(sample(s, lambda.view(), values.span()));
      for (std::size_t i = 0; i < 1024; ++i) {
        const double x = lambda.at(i, 0);
        const auto above = static_cast<std::size_t>(std::ranges::upper_bound(nm, x) - nm.begin());
        const std::size_t hi = std::min(above, count - 1);
        const double larger = std::max(std::abs(v[hi]), std::abs(v[hi == 0 ? 0 : hi - 1]));
        ASSERT_NEAR(values.at(i, 0), s(x), 4 * 0x1p-24 * larger) << shape << " " << table;
      }
    }
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
  auto lambda = own_batch(4096, 1);
  auto values = own_batch(4096, 1);
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

TEST(SpectrumSampler, GaussiansOfExtremeWidthAndHeightAreWhatTheyAre) {
  EXPECT_EQ(looked_up(*GaussianSumSpectrum::from_lobes({{1, 500, 1e-310, 1e-310}}), 500),
            1);  // 0 * (1 / sigma)
  EXPECT_FALSE(SpectrumSampler::create(*GaussianSumSpectrum::from_lobes({{1e300, 500, 1, 1}})));
}

}  // namespace
}  // namespace spectile::test
