// Sigmoid spectra of sRGB reflectances: they have the colours asked for, in the whole cube and at its dark,
// bright and grey ends, and their samples are the formula's.
#include "src/reference/upsampling/sigmoid.hpp"

#include <gmock/gmock.h>

#include "src/upsampling/sigmoid_model.hpp"
#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

/// Every test runs for both kinds of sigmoid.
class Sigmoid : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Methods, Sigmoid, testing::Values(Method::kSigmoid, Method::kSigmoidObserver),
                         sigmoid_method_name);

const Upsampler& sigmoid() {
  static const auto quadratic = *Upsampler::create(Method::kSigmoid, Quantity::kReflectance, Bands());
  static const auto observer = *Upsampler::create(Method::kSigmoidObserver, Quantity::kReflectance, Bands());
  return Sigmoid::GetParam() == Method::kSigmoid ? quadratic : observer;
}

/// The cube's grid brought near black, or near white.
ColorLanes near_black(std::size_t n, float part) {
  auto rgb = cube_grid(n);
  for (std::size_t i = 0; i < 3 * rgb.lanes(); ++i) rgb.at(i / 3, i % 3) *= part;
  return rgb;
}
ColorLanes near_white(std::size_t n, float part) {
  auto rgb = near_black(n, part);
  for (std::size_t i = 0; i < 3 * rgb.lanes(); ++i) rgb.at(i / 3, i % 3) = 1 - rgb.at(i / 3, i % 3);
  return rgb;
}

void expect_exact(const ColorLanes& rgb, const std::string& what, double difference = 1e-4) {
  SCOPED_TRACE(what);
  const RoundTrip result = round_trip(sigmoid(), rgb);
  // Required: 1e-5 and 1e-4. Float projection and matrix account for nearly all of what is measured.
  EXPECT_LE(result.rgb, 1e-6) << rgb.at(result.worst, 0) << " " << rgb.at(result.worst, 1) << " "
                              << rgb.at(result.worst, 2);
  EXPECT_LE(result.ciede2000, difference);
  EXPECT_GE(result.least, 0);
  EXPECT_LE(result.greatest, 1);
  EXPECT_EQ(coefficients_of(sigmoid(), rgb).unsolved.outside, 0U);
}

TEST_P(Sigmoid, TheCubesColoursReturn) {
  expect_exact(cube_grid(17), "17^3");
}

TEST_P(Sigmoid, TheCubesColoursReturnOnAFineGrid) {
  expect_exact(cube_grid(65), "65^3");
  expect_exact(random_colors(200000, 1), "random");
}

TEST_P(Sigmoid, ColoursNearBlackAndNearWhiteReturn) {
  for (const float part : {0.3F, 0.1F, 0.01F, 1e-3F, 1e-4F, 1e-5F, 1e-6F, 1e-7F, 1e-9F}) {
    expect_exact(near_black(17, part), "black + " + std::to_string(part));
    expect_exact(near_white(17, part), "white - " + std::to_string(part));
  }
}

TEST_P(Sigmoid, SaturatedColoursNextToBlackAndWhiteReturnOverOtherBands) {
  const auto rgb = lanes_of({{3.75e-6F, 0, 1.6875e-5F},
                             {3.75e-6F, 0, 1.25e-6F},
                             {5.625e-7F, 0, 1.875e-7F},
                             {0, 0, 3.125e-7F},
                             {2.5e-5F, 0, 3.125e-5F},
                             {1, 1, 0.999999642F},
                             {0.999989986F, 1, 0.999998748F},
                             {6.11139628e-9F, 0, 6.82325396e-9F}});
  for (const char* bands : {"380:780:5", "360:830:5", "400:700:10"}) {
    const auto upsampler = *Upsampler::create(GetParam(), Quantity::kReflectance, *Bands::parse(bands));
    const RoundTrip result = round_trip(upsampler, rgb);
    // Colours darker than the place of a sample's half come back as the nearest that there is.
    EXPECT_LE(result.rgb, 2e-6) << bands << ", lane " << result.worst;
    EXPECT_LE(result.ciede2000, 3e-3) << bands;
    EXPECT_EQ(coefficients_of(upsampler, rgb).unsolved.outside, 0U) << bands;
  }
}

TEST_P(Sigmoid, EveryCodeOfEightBitsReturns) {
  // Each code with each of a few others, in all orders.
  const auto linear = [](std::uint32_t code) {
    const double v = code / 255.0;
    return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  };
  std::vector<Rgb> colors;
  for (std::uint32_t code = 0; code < 256; ++code) {
    for (const std::uint32_t a : {0U, 1U, 2U, 17U, 128U, 254U, 255U}) {
      for (const std::uint32_t b : {0U, 1U, 254U, 255U}) {
        for (std::size_t k = 0; k < 3; ++k) {
          Rgb rgb;
          rgb[k] = linear(code);
          rgb[(k + 1) % 3] = linear(a);
          rgb[(k + 2) % 3] = linear(b);
          colors.push_back(rgb);
        }
      }
    }
  }
  expect_exact(lanes_of(colors), "codes");
}

TEST_P(Sigmoid, ColoursWithinAUlpOfEachOtherReturn) {
  // On the axes' diagonals and the middle plane, where the search changes its ways.
  std::vector<Rgb> colors;
  for (const float base : {0.01F, 0.25F, 0.5F, 0.75F, 0.99F}) {
    const float values[] = {std::nextafter(base, 0.0F), base, std::nextafter(base, 1.0F), 1 - base,
                            std::nextafter(1 - base, 1.0F)};
    for (const float r : values) {
      for (const float g : values) {
        for (const float b : values) colors.push_back({r, g, b});
      }
    }
  }
  // A place of 0.5, in which the samples are computed, is worth 1e-4 at 0.01.
  expect_exact(lanes_of(colors), "neighbours", GetParam() == Method::kSigmoid ? 1.2e-4 : 1.5e-4);
}

TEST_P(Sigmoid, GreysAreFlat) {
  std::vector<Rgb> colors;
  for (int i = 0; i <= 4096; ++i) {
    const float v = static_cast<float>(i) / 4096;
    colors.push_back({v, v, v});
  }
  for (const float v : {1e-12F, 1e-9F, 1e-6F, 1e-4F, 1 - 0x1p-24F, 1 - 1e-6F, 1 - 1e-4F})
    colors.push_back({v, v, v});
  const auto rgb = lanes_of(colors);
  const auto spectra = spectra_of(sigmoid(), rgb);
  const auto c = coefficients_of(sigmoid(), rgb);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    ASSERT_EQ(c.c.at(i, 0), 0) << i;
    ASSERT_EQ(c.c.at(i, 1), 0) << i;
    for (std::size_t b = 1; b < 60; ++b) {
      ASSERT_TRUE(same_bits(spectra.at(i, b), spectra.at(i, 0))) << rgb.at(i, 0) << " band " << b;
    }
    // The level is a root of the grey, and its sample one of the level: 4 places of 1.
    ASSERT_NEAR(spectra.at(i, 0), rgb.at(i, 0), 4 * 0x1p-24) << i;
  }
}

TEST_P(Sigmoid, BlackIsExactlyZeroAndWhiteExactlyOne) {
  const auto spectra =
      spectra_of(sigmoid(), lanes_of({{0, 0, 0}, {-0.0F, 0, -0.0F}, {1, 1, 1}, {kTiny, 0, kTiny}}));
  for (std::size_t b = 0; b < 60; ++b) {
    EXPECT_TRUE(same_bits(spectra.at(0, b), 0.0F));
    EXPECT_TRUE(same_bits(spectra.at(1, b), 0.0F));
    EXPECT_EQ(spectra.at(2, b), 1.0F);
    EXPECT_TRUE(same_bits(spectra.at(3, b), 0.0F));
  }
}

TEST_P(Sigmoid, OnlyRedsAndPurplesRiseAtTheEndsOfTheRange) {
  // Measured of quadratics: the largest sample over the brightest component: 3.6, and for the others 574,
  // always at the first or the last band, where the eye sees next to nothing.
  for (const float part : {1.0F, 0.1F, 0.01F, 1e-3F}) {
    const auto rgb = near_black(17, part);
    const auto spectra = spectra_of(sigmoid(), rgb);
    for (std::size_t i = 1; i < rgb.lanes(); ++i) {
      const float r = rgb.at(i, 0);
      const float g = rgb.at(i, 1);
      const float b = rgb.at(i, 2);
      const float brightest = std::max({r, g, b});
      std::size_t top = 0;
      for (std::size_t band = 1; band < 60; ++band) {
        if (spectra.at(i, band) > spectra.at(i, top)) top = band;
      }
      const float most = spectra.at(i, top);
      const bool red_or_purple = (r >= g && r >= b) || (g <= r && g <= b);
      ASSERT_TRUE(red_or_purple || most <= 4 * brightest) << r << " " << g << " " << b;
      ASSERT_TRUE(most <= 4 * brightest || top == 0 || top == 59)
          << r << " " << g << " " << b << " at " << top;
    }
  }
}

TEST_P(Sigmoid, SamplesAreTheFormulasWithinTheirBound) {
  const auto rgb = cube_grid(17);
  const auto c = coefficients_of(sigmoid(), rgb);
  const auto spectra = spectra_of(sigmoid(), rgb);
  const SigmoidFunctions& functions =
      SigmoidFunctions::of(GetParam() == Method::kSigmoid ? std::nullopt : std::optional(Observer::kCie1931));
  double worst = 0;
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    for (std::size_t b = 0; b < 60; ++b) {
      const auto [p, q] = functions.at_float(Bands()[b].centre_nm);
      // The first of two fused sums, as the second takes it.
      const double inner = functions.are_quadratic() ? (double{c.c.at(i, 0)} * q + c.c.at(i, 1)) * q
                                                     : double{c.c.at(i, 1)} * q + c.c.at(i, 2);
      const double x = functions.are_quadratic() ? inner + c.c.at(i, 2) : double{c.c.at(i, 0)} * p + inner;
      const double exact = 0.5 + 0.5 * x / std::sqrt(1 + x * x);
      // Of 2^-24: the inner sum, times lambda, and the outer one through the sigmoid's slope; 2.5 for the
      // root and 0.5 for 1 + x * x under it, times the 0.5 that x * root comes near; 0.5 for the sample
      // itself.
      const double slope = 0.5 / std::pow(1 + x * x, 1.5);
      const double bound = 0x1p-24 * (slope * (std::abs(inner) + std::abs(x)) + 0.5 * 3 + 0.5);
      worst = std::max(worst, std::abs(spectra.at(i, b) - exact) / bound);
    }
  }
  EXPECT_LE(worst, 1);
  EXPECT_GE(worst, 0.5) << "the bound is far too wide";
}

TEST(SigmoidRoot, HalfInverseRootIsWithinItsBound) {
  double worst = 0;
  const auto check = [&](std::uint32_t bits) {
    const auto t = std::bit_cast<float>(bits);
    const double exact = 0.5 / std::sqrt(static_cast<double>(t));
    worst = std::max(worst, std::abs(static_cast<double>(reference::half_inverse_root(t)) / exact - 1));
  };
  for (std::uint32_t bits = 0x3F800000U; bits < 0x40800000U; bits += 3)
    check(bits);  // 1 to 4: all there is to it
  for (std::uint32_t bits = 0x40800000U; bits < 0x7D800000U; bits += 997) check(bits);  // to 2^124
  EXPECT_LE(worst, 2.5 * 0x1p-24);
  for (std::uint32_t bits = 0x7D800000U; bits <= 0x7E800000U; bits += 997) check(bits);  // to 2^126
  EXPECT_LE(worst, 3.1 * 0x1p-24);
}

TEST_P(Sigmoid, WhatIsNotFiniteIsNanInEveryBandAndItsNeighboursStay) {
  auto rgb = random_colors(4099, 2);
  const auto clean = spectra_of(sigmoid(), rgb);
  for (std::size_t i = 0; i < rgb.lanes(); i += 3)
    rgb.at(i, i / 3 % 3) = i % 2 == 0 ? kNan : i % 4 == 1 ? kInf : -kInf;
  const auto spectra = spectra_of(sigmoid(), rgb);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    for (std::size_t b = 0; b < 60; ++b) {
      if (i % 3 == 0) {
        ASSERT_TRUE(std::isnan(spectra.at(i, b))) << i;
      } else {
        ASSERT_TRUE(same_bits(spectra.at(i, b), clean.at(i, b))) << i;
      }
    }
  }
}

TEST_P(Sigmoid, ResultsDependNeitherOnThreadsNorOnTilesNorOnStores) {
  auto rgb = random_colors(4099, 3, -0.1F, 1.1F);
  const auto want = spectra_of(sigmoid(), rgb, {1, 16384});
  const auto coefficients_want = coefficients_of(sigmoid(), rgb, {1, 16384});
  for (const int threads : {1, 2, 5}) {
    for (const std::size_t tile : {1, 64, 65, 500, 1000, 100000}) {
      const Execution execution = {threads, tile};
      EXPECT_TRUE(same_lanes(spectra_of(sigmoid(), rgb, execution), want)) << threads << " " << tile;
      const auto c = coefficients_of(sigmoid(), rgb, execution);
      EXPECT_TRUE(same_bits(c.c.view().c[0], coefficients_want.c.view().c[0], 4099));
      EXPECT_TRUE(same_bits(c.c.view().c[2], coefficients_want.c.view().c[2], 4099));
      EXPECT_EQ(c.unsolved.outside, coefficients_want.unsolved.outside);
      EXPECT_EQ(c.unsolved.first, coefficients_want.unsolved.first);
    }
  }
  for (const StoreHint stores : {StoreHint::kCached, StoreHint::kStreaming}) {
    auto expanded = *SampledSpectra::create(Bands(), rgb.lanes());
    ASSERT_TRUE(expand(sigmoid(), coefficients_want, expanded.span(), stores));
    EXPECT_TRUE(same_lanes(expanded, want));
  }
}

TEST_P(Sigmoid, EveryLaneIsItsOwnForEverySize) {
  for (const std::size_t lanes : kSizes) {
    const auto rgb = random_colors(lanes, 4, -0.2F, 1.2F);
    const auto spectra = spectra_of(sigmoid(), rgb);
    for (std::size_t i = 0; i<lanes; i += lanes> 100 ? 61 : 1) {
      const auto one = spectra_of(sigmoid(), lanes_of({{rgb.at(i, 0), rgb.at(i, 1), rgb.at(i, 2)}}));
      for (std::size_t b = 0; b < 60; ++b) ASSERT_TRUE(same_bits(spectra.at(i, b), one.at(0, b))) << i;
    }
  }
}

TEST_P(Sigmoid, BatchesThatDoNotFitAreErrors) {
  const auto rgb = random_colors(17, 5);
  auto c = *CoefficientLanes::create(sigmoid(), 16);
  EXPECT_EQ(code_of(coefficients(sigmoid(), rgb.view(), c)), code(ErrorCode::kSizeMismatch));
  auto spectra = *SampledSpectra::create(Bands(), 17);
  EXPECT_EQ(code_of(expand(sigmoid(), c, spectra.span())), code(ErrorCode::kSizeMismatch));
  auto others = *SampledSpectra::create(*Bands::uniform(400, 700, 10), 17);
  EXPECT_EQ(code_of(upsample_srgb(sigmoid(), rgb.view(), others.span())), code(ErrorCode::kBandsMismatch));
}

}  // namespace
}  // namespace spectile::test
