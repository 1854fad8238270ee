// Colours at each lane's own wavelengths: the spectrum of the colour there, by every method.
#include <spectile/lanes/spectrum_sampler.hpp>
#include <spectile/upsampling/rgb_spectrum.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

constexpr Method kAllMethods[] = {Method::kSmits,      Method::kSmits1999, Method::kSmitsExact,
                                  Method::kMallett,    Method::kSigmoid,   Method::kSigmoidObserver,
                                  Method::kTetrahedral};

/// Even bands, uneven ones, points, and a single band.
std::vector<Bands> all_bands() {
  const std::vector<double> uneven = {385, 402, 411.5, 430, 447, 460, 481, 500.25, 521, 540, 561,
                                      580, 599, 618,   641, 660, 685, 700, 721,    745, 760, 779};
  return {Bands(), *Bands::parse("380:780:10"), *Bands::from_centres(uneven), *Bands::uniform(550, 560, 10)};
}

std::vector<std::array<float, 3>> colors() {
  std::vector<std::array<float, 3>> out = {{0, 0, 0}, {1, 1, 1}, {0.5F, 0.5F, 0.5F}, {1, 0, 0}, {0, 1, 0},
                                           {0, 0, 1}, {1, 1, 0}, {0, 1, 1},          {1, 0, 1}};
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  while (out.size() < 70) out.push_back({unit(random), unit(random), unit(random)});
  return out;
}

/// Colours in lanes and four wavelengths of their own in each: at random, at centres of bands, beyond them.
struct Shaded {
  Shaded(const Upsampler& upsampler, const std::vector<std::array<float, 3>>& of)
      : rgb(*ColorLanes::create(of.size())),
        lambda(own_batch(of.size(), 4)),
        samples(own_batch(of.size(), 4)) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(350, 850);
    const Bands& bands = upsampler.bands();
    for (std::size_t i = 0; i < of.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = of[i][k];
      for (std::size_t k = 0; k < 4; ++k) lambda.at(i, k) = any(random);
      lambda.at(i, 1) = static_cast<float>(bands[i % bands.count()].centre_nm);
    }
  }
  ColorLanes rgb;
  SampledSpectra lambda, samples;
};

TEST(OwnWavelengthSamples, AreTheSpectrumOfTheColour) {
  int made = 0;
  for (const Bands& bands : all_bands()) {
    for (const Method method : kAllMethods) {
      for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
        const auto upsampler = Upsampler::create(method, quantity, bands);
        if (!upsampler) continue;
        ++made;
        const auto list = colors();
        Shaded s(*upsampler, list);
        ASSERT_TRUE(upsample_srgb(*upsampler, s.rgb, s.lambda, s.samples));
        for (std::size_t i = 0; i < list.size(); ++i) {
          const auto spectrum = rgb_spectrum(*upsampler, {list[i][0], list[i][1], list[i][2]});
          if (!spectrum) continue;
          const double scale = std::max(
              spectrum->max_value(), static_cast<double>(*std::max_element(list[i].begin(), list[i].end())));
          for (std::size_t k = 0; k < 4; ++k) {
            const double want = (*spectrum)(static_cast<double>(s.lambda.at(i, k)));
            ASSERT_NEAR(s.samples.at(i, k), want, 1e-6 * scale + 1e-20)
                << spectrum->to_text() << " at " << s.lambda.at(i, k);
          }
        }
      }
    }
  }
  EXPECT_GT(made, 60);
}

TEST(OwnWavelengthSamples, OfSigmoidsAreTheSamplersBits) {
  for (const Method method : {Method::kSigmoid, Method::kSigmoidObserver}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
      const auto upsampler = *Upsampler::create(method, quantity, Bands());
      const auto list = colors();
      Shaded s(upsampler, list);
      ASSERT_TRUE(upsample_srgb(upsampler, s.rgb, s.lambda, s.samples));
      auto want = own_batch(list.size(), 4);
      for (std::size_t i = 0; i < list.size(); ++i) {
        const auto spectrum = *rgb_spectrum(upsampler, {list[i][0], list[i][1], list[i][2]});
        ASSERT_TRUE(sample(spectrum, s.lambda, want));
        for (std::size_t k = 0; k < 4; ++k) ASSERT_TRUE(same_bits(s.samples.at(i, k), want.at(i, k))) << i;
      }
    }
  }
}

TEST(OwnWavelengthSamples, AtTheCentresOfBandsAreThoseOfTheBatch) {
  int made = 0;
  for (const Bands& bands : all_bands()) {
    for (const Method method :
         {Method::kSmits, Method::kSmitsExact, Method::kMallett, Method::kTetrahedral}) {
      const auto upsampler = Upsampler::create(method, Quantity::kReflectance, bands);
      if (!upsampler) continue;
      ++made;
      const auto list = colors();
      Shaded s(*upsampler, list);
      ASSERT_TRUE(upsample_srgb(*upsampler, s.rgb, s.lambda, s.samples));
      auto batch = *SampledSpectra::create(bands, list.size());
      ASSERT_TRUE(upsample_srgb(*upsampler, s.rgb, batch));
      for (std::size_t i = 0; i < list.size(); ++i)
        ASSERT_NEAR(s.samples.at(i, 1), batch.at(i, i % bands.count()), 3e-7) << i;
    }
  }
  EXPECT_GE(made, 12);
}

TEST(OwnWavelengthSamples, DoNotDependOnHowTheyAreComputed) {
  for (const Method method : {Method::kSmitsExact, Method::kSigmoidObserver, Method::kTetrahedral}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
      const auto upsampler = *Upsampler::create(method, quantity, Bands());
      std::vector<std::array<float, 3>> list = colors();
      while (list.size() < 1500) list.push_back(list[list.size() % 70]);
      Shaded s(upsampler, list);
      ASSERT_TRUE(upsample_srgb(upsampler, s.rgb, s.lambda, s.samples, {1}));
      auto other = own_batch(list.size(), 4);
      ASSERT_TRUE(upsample_srgb(upsampler, s.rgb, s.lambda, other, {4, 64}));
      EXPECT_TRUE(same_lanes(other, s.samples));
      auto in_place = *s.lambda.clone();
      ASSERT_TRUE(upsample_srgb(upsampler, s.rgb, in_place, in_place));
      EXPECT_TRUE(same_lanes(in_place, s.samples));
      auto found = *CoefficientLanes::create(upsampler, list.size());
      ASSERT_TRUE(coefficients(upsampler, s.rgb, found));
      ASSERT_TRUE(expand(upsampler, found, s.lambda, other, {2, 64}));
      EXPECT_TRUE(same_lanes(other, s.samples));
    }
  }
}

TEST(OwnWavelengthSamples, NumbersThatAreNoneAndBatchesThatDoNotFit) {
  for (const Method method : kAllMethods) {
    const auto upsampler = *Upsampler::create(method, Quantity::kReflectance, Bands());
    Shaded s(upsampler, {{0.5F, 0.25F, 0.75F}, {kNan, 0.5F, 0.5F}, {0.5F, 0.25F, 0.75F}});
    s.lambda.at(0, 2) = kNan;
    s.lambda.at(2, 0) = -kInf;
    s.lambda.at(2, 1) = kInf;
    ASSERT_TRUE(upsample_srgb(upsampler, s.rgb, s.lambda, s.samples));
    EXPECT_TRUE(std::isnan(s.samples.at(0, 2)));
    EXPECT_FALSE(std::isnan(s.samples.at(0, 3)));
    for (std::size_t k = 0; k < 4; ++k) EXPECT_TRUE(std::isnan(s.samples.at(1, k))) << to_string(method);
    const auto spectrum = *rgb_spectrum(upsampler, {0.5, 0.25, 0.75});
    EXPECT_NEAR(s.samples.at(2, 0), spectrum(402.5), 1e-6);
    EXPECT_NEAR(s.samples.at(2, 1), spectrum(697.5), 1e-6);

    auto five = own_batch(3, 5);
    EXPECT_EQ(upsample_srgb(upsampler, s.rgb, s.lambda, five).error().code, ErrorCode::kBandsMismatch);
    auto more = own_batch(4, 4);
    EXPECT_EQ(upsample_srgb(upsampler, s.rgb, s.lambda, more).error().code, ErrorCode::kSizeMismatch);
    EXPECT_EQ(upsample_srgb(upsampler, s.rgb, more, more).error().code, ErrorCode::kSizeMismatch);
    auto on_bands = *SampledSpectra::create(Bands(), 3);
    EXPECT_EQ(upsample_srgb(upsampler, s.rgb, on_bands, on_bands, Execution()).error().message,
              "wavelengths are each lane's own, the batch has bands 400:700:5");
  }
}

}  // namespace
}  // namespace spectile::test
