// Upsampled spectra: every method and quantity, at single wavelengths and in batches.
#include <cmath>
#include <numbers>
#include <spectile/color/response_curves.hpp>
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/radiometry/radiometry.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <spectile/upsampling/rgb_spectrum.hpp>

#include "tests/spectra/spectra_support.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

TEST(UpsampledSpectrum, EveryMethodAndQuantityOfEveryKindOfColor) {
  const std::array<double, 3> colors[] = {
      {0, 0, 0},   {1, 1, 1},   {0.5, 0.5, 0.5},    {1, 0, 0},        {0, 1, 0},
      {0, 0, 1},   {1, 1, 0},   {0, 1, 1},          {1, 0, 1},        {0.999, 1e-4, 0.5},
      {5, 2, 0.1}, {1e4, 0, 0}, {1e30, 1e30, 1e30}, {1e-30, 0, 1e-30}};
  const Bands bands = *Bands::parse("380:780:10");
  int made = 0;
  for (const Method method : {Method::kSmits, Method::kSmits1999, Method::kSmitsExact, Method::kMallett,
                              Method::kSigmoid, Method::kSigmoidObserver, Method::kTetrahedral}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
      const auto upsampler = Upsampler::create(method, quantity, bands);
      if (!upsampler) continue;
      for (const auto& rgb : colors) {
        const auto s = rgb_spectrum(*upsampler, rgb);
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
        auto lambda = own_batch(256, 1);
        auto values = own_batch(256, 1);
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

TEST(UpsampledSpectrum, AtTheCentresItIsWhatTheBatchMakes) {
  for (const Method method : {Method::kSmitsExact, Method::kMallett, Method::kSigmoid,
                              Method::kSigmoidObserver, Method::kTetrahedral}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
      const auto upsampler = *Upsampler::create(method, quantity, Bands());
      const std::array<double, 3> rgb = {0.8, 0.35, 0.1};
      const auto s = *rgb_spectrum(upsampler, rgb);
      auto lanes = *ColorLanes::create(1);
      for (std::size_t k = 0; k < 3; ++k) lanes.at(0, k) = static_cast<float>(rgb[k]);
      auto batch = *SampledSpectra::create(Bands(), 1);
      ASSERT_TRUE(upsample_srgb(upsampler, lanes.view(), batch.span()));
      for (std::size_t b = 0; b < 60; ++b) {
        const double want = batch.at(0, b);
        ASSERT_NEAR(s(Bands()[b].centre_nm), want, 2e-6 * std::max(1.0, want)) << to_string(method) << b;
      }
      EXPECT_EQ(s(0), s(402.5));
      EXPECT_EQ(s(5000), s(697.5));
      EXPECT_NEAR(s.integral(380, 750), riemann(s, 380, 750), 1e-5 * s.integral(380, 750));
      double most = 0;
      for (double nm = 402.5; nm <= 697.5; nm += 0.01) most = std::max(most, s(nm));
      EXPECT_NEAR(s.max_value() / most, 1, 1e-6);
      EXPECT_FALSE(s.to_text().empty());
    }
  }
}

TEST(UpsampledSpectrum, QuantitiesAreNotConfused) {
  const auto reflectances = *Upsampler::create(Method::kSigmoid, Quantity::kReflectance, Bands());
  const auto unbounded = *Upsampler::create(Method::kSigmoid, Quantity::kUnbounded, Bands());
  const auto lights = *Upsampler::create(Method::kSigmoid, Quantity::kIlluminant, Bands());
  EXPECT_TRUE(rgb_albedo_spectrum(reflectances, {0.5, 0.2, 1}));
  EXPECT_TRUE(rgb_unbounded_spectrum(unbounded, {5, 0.2, 1}));
  EXPECT_TRUE(rgb_illuminant_spectrum(lights, {5, 0.2, 1}));
  EXPECT_FALSE(rgb_albedo_spectrum(reflectances, {1.5, 0.2, 1}));
  EXPECT_FALSE(rgb_albedo_spectrum(lights, {0.5, 0.2, 1}));
  EXPECT_FALSE(rgb_unbounded_spectrum(reflectances, {0.5, 0.2, 1}));
  EXPECT_FALSE(rgb_illuminant_spectrum(unbounded, {0.5, 0.2, 1}));
  EXPECT_FALSE(rgb_unbounded_spectrum(unbounded, {5, -3, 1}));
  EXPECT_FALSE(rgb_illuminant_spectrum(lights, {5, std::nan(""), 1}));
  EXPECT_FALSE(rgb_illuminant_spectrum(lights, {1e300, 0, 1}));
}

TEST(UpsampledSpectrum, WhiteLightIsItsIlluminantWithLuminanceOne) {
  const auto lights = *Upsampler::create(Method::kSigmoid, Quantity::kIlluminant, *Bands::parse("360:830:5"));
  const auto white = *rgb_illuminant_spectrum(lights, {1, 1, 1});
  const auto d65 = *illuminant("D65");
  for (const double nm : {400.0, 450.0, 555.0, 620.0}) {
    EXPECT_NEAR(white(nm) / white(560), d65.at(nm) / d65.at(560), 0.03) << nm;  // averages over 5 nm
  }
}

}  // namespace
}  // namespace spectile::test
