// Sigmoid spectra of other quantities, bands, lights, observers and primaries have the colours asked for, and
// the colours that none has are reported.
#include <gmock/gmock.h>

#include "src/upsampling/sigmoid_model.hpp"
#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

/// Every test runs for both kinds of sigmoid.
class SigmoidSpaces : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Methods, SigmoidSpaces, testing::Values(Method::kSigmoid, Method::kSigmoidObserver),
                         sigmoid_method_name);

Upsampler sigmoid_of(Quantity quantity, const Bands& bands = Bands(), const UpsamplerOptions& options = {}) {
  return *Upsampler::create(SigmoidSpaces::GetParam(), quantity, bands, options);
}

void expect_return(const Upsampler& upsampler, const ColorLanes& rgb) {
  const RoundTrip result = round_trip(upsampler, rgb);
  EXPECT_LE(result.rgb, 1e-6) << rgb.at(result.worst, 0) << " " << rgb.at(result.worst, 1) << " "
                              << rgb.at(result.worst, 2);
  EXPECT_LE(result.ciede2000, 1e-4);
  EXPECT_GE(result.least, 0);
  EXPECT_TRUE(upsampler.quantity() != Quantity::kReflectance || result.greatest <= 1) << result.greatest;
  EXPECT_EQ(coefficients_of(upsampler, rgb).unsolved.outside, 0U);
}

/// Colours of sigmoids in double: a band or a gap between two wavelengths, how steep its flanks are.
ColorLanes colors_of_sigmoids(const Upsampler& upsampler, std::size_t lanes, double steepness) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const Projector projector = projector_of(upsampler);
  const Matrix3 to_rgb = inverse(upsampler.rgb_to_xyz());
  auto rgb = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    const double first = sigmoid_lambda(360 + 480 * unit(random));
    const double second = sigmoid_lambda(360 + 480 * unit(random));
    const double size = steepness * (0.5 + unit(random)) * (random() % 2 == 0 ? 1 : -1);
    std::array<double, 3> xyz{};
    for (std::size_t b = 0; b < upsampler.bands().count(); ++b) {
      const double lambda = sigmoid_lambda(upsampler.bands()[b].centre_nm);
      const double x = size * (lambda - first) * (lambda - second);
      const double sample = 0.5 + 0.5 * x / std::sqrt(1 + x * x);
      for (std::size_t k = 0; k < 3; ++k) xyz[k] += sample * projector.weights()[b][k];
    }
    const auto color = times(to_rgb, xyz);
    for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = static_cast<float>(color[k]);
  }
  return rgb;
}

TEST_P(SigmoidSpaces, CubesReturnForEveryQuantityAndObserver) {
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
    for (const Observer observer : {Observer::kCie1931, Observer::kCie1964}) {
      UpsamplerOptions options;
      options.observer = observer;
      SCOPED_TRACE(std::string(to_string(quantity)) + (observer == Observer::kCie1931 ? " 2" : " 10"));
      expect_return(sigmoid_of(quantity, Bands(), options), cube_grid(17));
    }
  }
}

TEST_P(SigmoidSpaces, CubesReturnForOtherBands) {
  for (const char* text :
       {"380:780:5", "400:700:10", "360:830:10", "390:710:20",
        "400,409,421,434,447,460,473,487,500,512,525,540,552,565,580,595,607,622,640,660,690"}) {
    SCOPED_TRACE(text);
    expect_return(sigmoid_of(Quantity::kReflectance, *Bands::parse(text)), cube_grid(17));
  }
}

TEST_P(SigmoidSpaces, CubesReturnUnderOtherLights) {
  for (const char* light : {"A", "D50", "E", "FL11"}) {
    UpsamplerOptions options;
    options.light = *illuminant(light);
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
      SCOPED_TRACE(std::string(light) + " " + std::string(to_string(quantity)));
      expect_return(sigmoid_of(quantity, *Bands::parse("380:780:5"), options), cube_grid(17));
    }
  }
}

TEST_P(SigmoidSpaces, TheLightsScaleDoesNotCount) {
  UpsamplerOptions one;
  UpsamplerOptions other;
  one.light = *illuminant("A");
  other.light = one.light->scaled(1024);
  const auto rgb = random_colors(65, 1);
  for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
    EXPECT_TRUE(same_lanes(spectra_of(sigmoid_of(quantity, Bands(), other), rgb),
                           spectra_of(sigmoid_of(quantity, Bands(), one), rgb)));
  }
}

TEST_P(SigmoidSpaces, WhatMayExceedOneIsExactlyHomogeneous) {
  for (const Quantity quantity : {Quantity::kUnbounded, Quantity::kIlluminant}) {
    const auto upsampler = sigmoid_of(quantity);
    const auto rgb = random_colors(4099, 2);
    const auto spectra = spectra_of(upsampler, rgb);
    for (const float factor : {2.0F, 0x1p-30F, 0x1p60F}) {
      auto scaled = random_colors(4099, 2);
      for (std::size_t i = 0; i < 3 * scaled.lanes(); ++i) scaled.at(i / 3, i % 3) *= factor;
      const auto got = spectra_of(upsampler, scaled);
      for (std::size_t i = 0; i < rgb.lanes(); ++i) {
        for (std::size_t b = 0; b < 60; ++b)
          ASSERT_EQ(got.at(i, b), factor * spectra.at(i, b)) << i << " " << b;
      }
    }
  }
}

TEST_P(SigmoidSpaces, DarkColoursOfUnboundedOnesAreAsGoodAsBrightOnes) {
  for (const Quantity quantity : {Quantity::kUnbounded, Quantity::kIlluminant}) {
    const auto upsampler = sigmoid_of(quantity);
    for (const float part : {1e-3F, 1e-6F, 1e-12F, 1e-30F}) {
      auto rgb = cube_grid(9);
      for (std::size_t i = 0; i < 3 * rgb.lanes(); ++i) rgb.at(i / 3, i % 3) *= part;
      EXPECT_LE(round_trip(upsampler, rgb, false).rgb, 1e-6 * static_cast<double>(part)) << part;
      EXPECT_EQ(coefficients_of(upsampler, rgb).unsolved.outside, 0U);
    }
  }
}

TEST_P(SigmoidSpaces, GreyIsFlatOrTheLightsShapeExactly) {
  const auto rgb = lanes_of({{0, 0, 0}, {0.18F, 0.18F, 0.18F}, {1, 1, 1}, {7.5F, 7.5F, 7.5F}});
  const auto flat = spectra_of(sigmoid_of(Quantity::kUnbounded), rgb);
  for (const char* name : {"D65", "A"}) {
    UpsamplerOptions options;
    options.light = *illuminant(name);
    const auto upsampler = sigmoid_of(Quantity::kIlluminant, Bands(), options);
    const auto light = spectra_of(upsampler, rgb);
    const Projector projector = projector_of(upsampler);
    double luminance = 0;
    for (std::size_t b = 0; b < 60; ++b) {
      luminance +=
          projector.weights()[b][1] * options.light->integral(Bands()[b].lower_nm, Bands()[b].upper_nm) / 5;
    }
    for (std::size_t i = 0; i < rgb.lanes(); ++i) {
      for (std::size_t b = 0; b < 60; ++b) {
        ASSERT_EQ(flat.at(i, b), rgb.at(i, 0));
        const double average = options.light->integral(Bands()[b].lower_nm, Bands()[b].upper_nm) / 5;
        const double want = rgb.at(i, 0) * average / luminance;
        ASSERT_NEAR(light.at(i, b), want, 2 * 0x1p-24 * want) << name << " " << b;
      }
    }
  }
}

/// Colours that are surely those of reflectances return from spectra made for other primaries.
void expect_wide_gamut_returns(const char* space) {
  SCOPED_TRACE(space);
  UpsamplerOptions options;
  options.primaries = rgb_space(space)->chromaticities;
  const auto upsampler = sigmoid_of(Quantity::kReflectance, *Bands::parse("380:780:5"), options);
  const auto gentle = colors_of_sigmoids(upsampler, 1000, 1.0);
  expect_return(upsampler, gentle);
  expect_return(upsampler, lanes_of({{0, 0, 0}, {0.5F, 0.5F, 0.5F}, {1, 1, 1}}));
  // The cube of sRGB in other coordinates; without its dark and bright ends, which float coordinates blur.
  const auto srgb = sigmoid_of(Quantity::kReflectance, *Bands::parse("380:780:5"));
  const Matrix3 matrix = product(inverse(upsampler.rgb_to_xyz()), srgb.rgb_to_xyz());
  auto rgb = random_colors(2000, 3, 0.02F, 0.98F);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    const auto v = times(matrix, {rgb.at(i, 0), rgb.at(i, 1), rgb.at(i, 2)});
    for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = static_cast<float>(v[k]);
  }
  expect_return(upsampler, rgb);
}

TEST_P(SigmoidSpaces, WideGamutColoursReturn) {
  for (const char* space : {"display-p3", "adobe-rgb"}) expect_wide_gamut_returns(space);
  // Colours outside the cube of sRGB itself.
  const auto srgb = sigmoid_of(Quantity::kReflectance);
  const auto gentle = colors_of_sigmoids(srgb, 4099, 2.0);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < gentle.lanes(); ++i) {
    const auto [least, greatest] = std::minmax({gentle.at(i, 0), gentle.at(i, 1), gentle.at(i, 2)});
    outside += least < 0 || greatest > 1 ? 1 : 0;
  }
  EXPECT_GT(outside, 1000U);
  expect_return(srgb, gentle);
}

TEST_P(SigmoidSpaces, ColoursOfTheWidestGamutsReturn) {
  for (const char* space : {"rec2020", "acescg"}) expect_wide_gamut_returns(space);
}

TEST_P(SigmoidSpaces, ColoursThatNoReflectanceHasAreReported) {
  const auto upsampler = sigmoid_of(Quantity::kReflectance);
  const auto rgb =
      lanes_of({{0.5F, 0.5F, 0.5F}, {2, 2, 2}, {0.2F, 0.3F, 0.4F}, {-1, -1, -1}, {-1, 2, -1}, {1, 0, 0}});
  const auto c = coefficients_of(upsampler, rgb);
  EXPECT_EQ(c.unsolved.outside, 3U);
  EXPECT_EQ(c.unsolved.first, 1);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) ASSERT_TRUE(std::isfinite(c.c.at(i, k))) << i;
  }
  const auto spectra = spectra_of(upsampler, rgb);
  for (std::size_t b = 0; b < 60; ++b) {
    ASSERT_NEAR(spectra.at(1, b), 1, 1e-4);
    ASSERT_NEAR(spectra.at(3, b), 0, 1e-4);
  }
}

TEST_P(SigmoidSpaces, ColoursOutsideTheCubeReturnOrAreReported) {
  const auto upsampler = sigmoid_of(Quantity::kReflectance);
  const auto rgb = random_colors(2000, 4, -0.2F, 1.2F);
  std::size_t missed = 0;
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    const auto one = lanes_of({{rgb.at(i, 0), rgb.at(i, 1), rgb.at(i, 2)}});
    const bool returns = round_trip(upsampler, one, false).rgb <= 1.2e-5;
    ASSERT_TRUE(returns || coefficients_of(upsampler, one).unsolved.outside == 1)
        << one.at(0, 0) << " " << one.at(0, 1) << " " << one.at(0, 2);
    missed += returns ? 0 : 1;
  }
  EXPECT_GT(missed, 100U);
}

TEST_P(SigmoidSpaces, LightWithoutAnyPositiveComponentIsReportedAndBlack) {
  for (const Quantity quantity : {Quantity::kUnbounded, Quantity::kIlluminant}) {
    const auto upsampler = sigmoid_of(quantity);
    const auto rgb = lanes_of({{0, 0, 0}, {-1, -2, -3}});
    const auto c = coefficients_of(upsampler, rgb);
    EXPECT_EQ(c.unsolved.outside, 1U);
    EXPECT_EQ(c.unsolved.first, 1);
    const auto spectra = spectra_of(upsampler, rgb);
    for (std::size_t b = 0; b < 60; ++b) ASSERT_EQ(spectra.at(1, b), 0) << b;
  }
}

TEST_P(SigmoidSpaces, PrimariesThatSpanNothingAndBandsWithoutLightAreErrors) {
  UpsamplerOptions options;
  options.primaries = {{0.3, 0.3}, {0.4, 0.4}, {0.5, 0.5}, {0.3127, 0.3290}};
  EXPECT_EQ(code_of(Upsampler::create(GetParam(), Quantity::kReflectance, Bands(), options)),
            code(ErrorCode::kBadArgument));
  EXPECT_EQ(
      code_of(Upsampler::create(GetParam(), Quantity::kReflectance, *Bands::uniform(900, 1000, 10), {})),
      code(ErrorCode::kBadArgument));
}

}  // namespace
}  // namespace spectile::test
