// Sampled wavelengths: samplers against their distributions, and estimates that are right on average.
#include <spectile/color/response_curves.hpp>
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/upsampling/rgb_spectrum.hpp>

#include "src/data/tables.hpp"
#include "tests/lanes/wavelengths_support.hpp"

namespace spectile::test {
namespace {

// --- Drawing

TEST(SampleWavelengths, UniformOnesAreStratifiedAndWrapAround) {
  const auto w = drawn_wavelengths(WavelengthSampling::kUniform, 999, 8, 1, 400, 720);
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
  const auto w = drawn_wavelengths(WavelengthSampling::kVisible, 200000, 1, 2);
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

TEST(TerminateSecondary, OnlyTheFirstCountsAndOnce) {
  auto w = drawn_wavelengths(WavelengthSampling::kUniform, 3, 4, 5);
  const float density = w.density.at(0, 0);
  EXPECT_EQ(secondary_terminated(w), LaneMask{0});
  ASSERT_TRUE(terminate_secondary(w, LaneMask{0b101}));
  EXPECT_EQ(secondary_terminated(w), LaneMask{0b101});
  EXPECT_EQ(w.density.at(0, 0), density / 4);
  EXPECT_EQ(w.density.at(0, 3), 0);
  EXPECT_EQ(w.density.at(1, 0), density);
  ASSERT_TRUE(terminate_secondary(w));
  EXPECT_EQ(w.density.at(0, 0), density / 4);
  EXPECT_EQ(w.density.at(1, 0), density / 4);
  EXPECT_EQ(secondary_terminated(w), LaneMask{0b111});
  EXPECT_EQ(terminate_secondary(w, LaneMask{0, 0}).error().code, ErrorCode::kSizeMismatch);
  // A terminated wavelength's radiance does not matter, not even when it is none.
  auto radiance = own_batch(3, 4);
  for (std::size_t i = 0; i < 12; ++i) radiance.at(i % 3, i / 3) = i < 3 ? 2.0F : kNan;
  auto xyz = *ColorLanes::create(3);
  ASSERT_TRUE(project(*ResponseCurves::of_observer(), radiance.view(), w, xyz.span()));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(xyz.at(i, 1)));
}

TEST(SampleWavelengths, WhatReachesExactlyOneStartsAgain) {
  auto u = *ScalarLanes::create(2);
  u[0] = 0.5F;
  u[1] = 0.75F;
  auto w = *SampledWavelengths::create(2, 4);
  ASSERT_TRUE(sample_wavelengths(WavelengthSampling::kUniform, u.view(), w, 400, 720));
  const float want[2][4] = {{560, 640, 400, 480}, {640, 400, 480, 560}};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(w.lambda_nm.at(i, k), want[i][k]) << i << " " << k;
  }
}

TEST(SampleWavelengths, VisibleOnesFollowTheirDensityOverAnyRange) {
  constexpr std::size_t kLanes = 4096;
  auto u = *ScalarLanes::create(kLanes);
  for (std::size_t i = 0; i < kLanes; ++i) u[i] = (static_cast<float>(i) + 0.5F) / kLanes;
  for (const auto& [first, last] :
       {std::pair{400.0, 700.0}, {360.0, 500.0}, {600.0, 1000.0}, {538.0, 538.5}, {1.0, 10.0}}) {
    auto w = *SampledWavelengths::create(kLanes, 1);
    ASSERT_TRUE(sample_wavelengths(WavelengthSampling::kVisible, u.view(), w, first, last));
    const auto share = [](double nm) { return std::tanh(0.0072 * (nm - 538)); };
    const double whole = share(last) - share(first);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double nm = w.lambda_nm.at(i, 0);
      ASSERT_GE(nm, first - 1e-4);
      ASSERT_LE(nm, last + 1e-4);
      const double c = std::cosh(0.0072 * (nm - 538));
      ASSERT_NEAR(w.density.at(i, 0) * whole * c * c / 0.0072, 1, 1e-5) << first << " to " << last;
      // The share below it is the random number; a wavelength's rounding is 2^-15 nm.
      ASSERT_NEAR((share(nm) - share(first)) / whole, u[i], 1e-6 + 6.2e-5 * w.density.at(i, 0))
          << first << " to " << last;
    }
  }
}

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

TEST(SampledWavelengths, AreTheSameBitsOnEveryInstructionSetThroughThePublicCalls) {
  const Spectrum spectra[] = {
      ConstantSpectrum(0.3),
      PiecewiseLinearSpectrum(*illuminant("FL11")),
      *DenselySampledSpectrum::from(*BlackbodySpectrum::create(4000)),
      *BlackbodySpectrum::create(6500),
      *BlackbodySpectrum::create(1e9),
      *GaussianSumSpectrum::from_lobes({{1, 500, 1e-300, 2}, {-3, 600, 1e-3, 1e5}}),
      *rgb_spectrum(*Upsampler::create(Method::kSigmoid, Quantity::kIlluminant, Bands()), {0.9, 0.4, 0.1})};
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
          auto radiance = own_batch(lanes, count);
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
  EXPECT_EQ(secondary_terminated(one), LaneMask{0});
  auto two = *SampledWavelengths::create(1, 2);
  two.density.at(0, 1) = 4;
  ASSERT_TRUE(terminate_secondary(two));
  EXPECT_EQ(two.density.at(0, 0), 0);
  EXPECT_EQ(two.density.at(0, 1), 0);
}

}  // namespace
}  // namespace spectile::test
