// Spectra under attack: closed forms, every method and quantity, every instruction set through the public
// calls.
#include <cmath>
#include <numbers>
#include <spectile/lanes/wavelengths.hpp>
#include <spectile/radiometry/radiometry.hpp>
#include <spectile/spectra/spectrum.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

TEST(InnerProduct, OfTwoGaussiansIsTheClosedForm) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const double s1 = std::pow(10, -3 + 5 * unit(random));
    const double s2 = std::pow(10, -3 + 5 * unit(random));
    const double m1 = 400 + 300 * unit(random);
    // Every third pair is so close that the product lies in both's tails.
    const double m2 =
        i % 3 == 0 ? m1 + (24 * unit(random) - 12) * std::max(s1, s2) : 400 + 300 * unit(random);
    const double square = s1 * s1 + s2 * s2;
    const double sigma = s1 * s2 / std::sqrt(square);
    const double mean = (m1 * s2 * s2 + m2 * s1 * s1) / square;
    const double want =
        std::exp(-0.5 * (m1 - m2) * (m1 - m2) / square) * std::sqrt(2 * std::numbers::pi) * sigma;
    if (want < 1e-280) continue;
    ++compared;
    const auto a = *GaussianSumSpectrum::from_lobes({{1, m1, s1, s1}});
    const auto b = *GaussianSumSpectrum::from_lobes({{1, m2, s2, s2}});
    const double reach = 60 * (s1 + s2) + 100;
    ASSERT_NEAR(inner_product(a, b, mean - reach, mean + reach) / want, 1, 1e-9)
        << a.to_text() << ", " << b.to_text();
  }
  EXPECT_GT(compared, 200);
}

TEST(InnerProduct, SpikesAndLinesAgainstABlackBodyAreItsValueThere) {
  const auto black = *BlackbodySpectrum::create(6500, BlackbodySpectrum::Scale::kNormalized);
  for (const double at : {400.0, 555.5, 829.0}) {
    const double nm[] = {at - 1e-3, at, at + 1e-3};
    const double v[] = {0, 1, 0};
    EXPECT_NEAR(inner_product(*PiecewiseLinearSpectrum::from_samples(nm, v), black) / (1e-3 * black(at)), 1,
                1e-9);
    const auto line = *GaussianSumSpectrum::from_lobes({{1, at, 0.01, 0.01}});
    // To second order: half the square of sigma times the curvature.
    const double curvature = (black(at + 1) - 2 * black(at) + black(at - 1)) / black(at);
    EXPECT_NEAR(inner_product(line, black) / (0.01 * std::sqrt(2 * std::numbers::pi) * black(at)),
                1 + 0.5e-4 * curvature, 1e-9);
    const double one[] = {at};
    EXPECT_EQ(inner_product(*PiecewiseLinearSpectrum::from_samples(one, std::array{5.0}), black), 0);
  }
}

TEST(GaussianSumSpectrum, MaximumOfNarrowLobesOnAWideOne) {
  const auto s = *GaussianSumSpectrum::from_lobes(
      {{1, 500, 1e-3, 1e-3}, {1, 500.0015, 1e-3, 1e-3}, {0.1, 600, 300, 300}});
  double most = 0;
  for (double nm = 499.99; nm < 500.01; nm += 1e-7) most = std::max(most, s(nm));
  EXPECT_NEAR(s.max_value() / most, 1, 1e-6);
}

TEST(UpsampledSpectrum, EveryMethodAndQuantityOfEveryKindOfColor) {
  const std::array<double, 3> colors[] = {
      {0, 0, 0},   {1, 1, 1},   {0.5, 0.5, 0.5},    {1, 0, 0},        {0, 1, 0},
      {0, 0, 1},   {1, 1, 0},   {0, 1, 1},          {1, 0, 1},        {0.999, 1e-4, 0.5},
      {5, 2, 0.1}, {1e4, 0, 0}, {1e30, 1e30, 1e30}, {1e-30, 0, 1e-30}};
  const Bands bands = *Bands::parse("380:780:10");
  int made = 0;
  for (const Method method :
       {Method::kSmits, Method::kSmits1999, Method::kSmitsExact, Method::kMallett, Method::kSigmoid}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
      const auto upsampler = Upsampler::create(method, quantity, bands);
      if (!upsampler) continue;
      for (const auto& rgb : colors) {
        const auto s = UpsampledSpectrum::from_rgb(*upsampler, rgb);
        if (!s) continue;
        ++made;
        const std::string what = s->to_text();
        auto lanes = *ColorLanes::create(1);
        for (std::size_t k = 0; k < 3; ++k) lanes.at(0, k) = static_cast<float>(rgb[k]);
        auto batch = *SampledSpectra::create(bands, 1);
        ASSERT_TRUE(upsample_srgb(*upsampler, lanes.view(), batch.span()));
        const double largest = std::max({rgb[0], rgb[1], rgb[2]});
        double most = -1;
        for (std::size_t b = 0; b < bands.count(); ++b) {
          const double want = batch.at(0, b);
          ASSERT_NEAR((*s)(bands[b].centre_nm), want, 3e-6 * std::max(std::abs(want), largest) + 1e-20)
              << what << b;
        }
        for (double nm = 385; nm <= 775; nm += 0.01) most = std::max(most, (*s)(nm));
        ASSERT_NEAR(s->max_value(), most, 1e-6 * std::abs(most) + 1e-20) << what;
        double sum = 0;
        for (int i = 0; i < 47000; ++i) sum += (*s)(360 + (i + 0.5) / 100) / 100;
        ASSERT_NEAR(s->integral(360, 830), sum, 2e-7 * std::abs(sum) + 1e-20) << what;
        auto lambda = *WavelengthLanes::create(256, 1);
        auto values = *WavelengthLanes::create(256, 1);
        for (std::size_t i = 0; i < 256; ++i) lambda.at(i, 0) = static_cast<float>(350 + 2 * i);
        ASSERT_TRUE(sample(*s, lambda.view(), values.span()));
        for (std::size_t i = 0; i < 256; ++i) {
          const double want = (*s)(static_cast<double>(lambda.at(i, 0)));
          ASSERT_NEAR(values.at(i, 0), want, 1e-6 * std::max(most, largest) + 1e-20) << what;
        }
      }
    }
  }
  EXPECT_GT(made, 100);
}

TEST(SampledWavelengths, AreTheSameBitsOnEveryInstructionSetThroughThePublicCalls) {
  const Spectrum spectra[] = {
      ConstantSpectrum(0.3),
      PiecewiseLinearSpectrum(*illuminant("FL11")),
      *DenselySampledSpectrum::from(*BlackbodySpectrum::create(4000)),
      *BlackbodySpectrum::create(6500),
      *BlackbodySpectrum::create(1e9),
      *GaussianSumSpectrum::from_lobes({{1, 500, 1e-300, 2}, {-3, 600, 1e-3, 1e5}}),
      *UpsampledSpectrum::from_rgb(*Upsampler::create(Method::kSigmoid, Quantity::kIlluminant, Bands()),
                                   {0.9, 0.4, 0.1})};
  const auto curves = *ResponseCurves::of_observer();
  const float odd_u[] = {0, 1 - 0x1p-24F, 1, -1, kNan, kInf, -kInf, kTiny, 0.5F};
  const float odd[] = {0, -0.0F, kInf, -kInf, kNan, -1, kTiny, kMost, 360, 830, 829.99994F};
  for (const std::size_t lanes : {0U, 1U, 63U, 64U, 65U}) {
    for (const std::size_t count : {1U, 3U, 64U}) {
      std::vector<float> want;
      for (const std::string& isa : available_isas()) {
        for (const int threads : {1, 3}) {
          ASSERT_TRUE(force_isa(isa));
          Execution execution;
          execution.threads = threads;
          std::mt19937 random(static_cast<std::uint32_t>(100 * lanes + count));
          std::uniform_real_distribution<float> unit(0, 1);
          auto u = *ScalarLanes::create(lanes);
          for (std::size_t i = 0; i < lanes; ++i)
            u[i] = i % 5 == 0 ? odd_u[random() % std::size(odd_u)] : unit(random);
          std::vector<float> got;
          auto w = *SampledWavelengths::create(lanes, count);
          auto radiance = *WavelengthLanes::create(lanes, count);
          auto color = *ColorLanes::create(lanes);
          for (const auto sampling : {WavelengthSampling::kUniform, WavelengthSampling::kVisible}) {
            ASSERT_TRUE(sample_wavelengths(sampling, u.view(), w, 360, 830, execution));
            for (std::size_t k = 0; k < count; ++k) {
              for (std::size_t i = 0; i < lanes; ++i) {
                got.push_back(w.lambda_nm.at(i, k));
                got.push_back(w.density.at(i, k));
                if (random() % 7 == 0) w.density.at(i, k) = odd[random() % std::size(odd)];
                if (random() % 9 == 0) w.lambda_nm.at(i, k) = odd[random() % std::size(odd)];
              }
            }
            for (const Spectrum& s : spectra) {
              ASSERT_TRUE(sample(s, w.lambda_nm.view(), radiance.span(), execution));
              ASSERT_TRUE(project(curves, radiance.view(), w, color.span(), execution));
              for (std::size_t i = 0; i < lanes; ++i) {
                for (std::size_t k = 0; k < count; ++k) got.push_back(radiance.at(i, k));
                for (std::size_t c = 0; c < 3; ++c) got.push_back(color.at(i, c));
              }
            }
          }
          if (want.empty()) want = got;
          ASSERT_EQ(want.size(), got.size());
          for (std::size_t i = 0; i < want.size(); ++i)
            ASSERT_TRUE(same_bits(want[i], got[i])) << isa << " " << i;
        }
      }
      ASSERT_TRUE(force_isa(""));
    }
  }
}

TEST(TerminateSecondary, OfOneWavelengthOrOfADeadFirstOneChangesNothing) {
  auto one = *SampledWavelengths::create(3, 1);
  for (std::size_t i = 0; i < 3; ++i) one.density.at(i, 0) = 2;
  ASSERT_TRUE(terminate_secondary(one));
  ASSERT_TRUE(terminate_secondary(one));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(one.density.at(i, 0), 2);
  auto two = *SampledWavelengths::create(1, 2);
  two.density.at(0, 1) = 4;
  ASSERT_TRUE(terminate_secondary(two));
  EXPECT_EQ(two.density.at(0, 0), 0);
  EXPECT_EQ(two.density.at(0, 1), 0);
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
      auto lambda = *WavelengthLanes::create(1024, 1);
      auto values = *WavelengthLanes::create(1024, 1);
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

}  // namespace
}  // namespace spectile::test
