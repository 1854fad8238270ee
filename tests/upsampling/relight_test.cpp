// Relighting without spectra against the long way, and against the double sums of its definition.
#include <spectile/upsampling/relight.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

constexpr Method kRelitMethods[] = {Method::kSmits,      Method::kSmits1999, Method::kSmitsExact,
                                    Method::kMallett,    Method::kSigmoid,   Method::kSigmoidObserver,
                                    Method::kTetrahedral};

ColorLanes colors(std::size_t lanes, float low, float high, std::uint32_t seed) {
  auto rgb = *ColorLanes::create(lanes);
  const Floats values = plain_floats(3 * lanes, seed, low, high);
  for (std::size_t i = 0; i < 3 * lanes; ++i) rgb.at(i / 3, i % 3) = values[i];
  return rgb;
}

/// Upsampled, projected, transformed: the long way.
ColorLanes through_spectra(const Upsampler& upsampler, const Projector& under, const Matrix3& to,
                           ColorView rgb) {
  auto spectra = *SampledSpectra::create(upsampler.bands(), rgb.lanes);
  auto xyz = *ColorLanes::create(rgb.lanes);
  EXPECT_TRUE(upsample_srgb(upsampler, rgb, spectra.span()));
  EXPECT_TRUE(project(under, spectra.view(), xyz.span()));
  EXPECT_TRUE(transform(to, xyz.view(), xyz.span()));
  return xyz;
}

class Relighting : public testing::TestWithParam<Method> {};

TEST_P(Relighting, ComesWithinItsBoundOfTheLongWay) {
  for (const char* light : {"A", "D65", "FL11"}) {
    for (const char* bands_text : {"400:700:5", "380:780:20"}) {
      const Bands bands = *Bands::parse(bands_text);
      const auto upsampler = *Upsampler::create(GetParam(), Quantity::kReflectance, bands);
      const auto under = *Projector::reflective(bands, *illuminant(light), Observer::kCie1964);
      const auto relighter = *Relighter::create(upsampler, under, under.xyz_to_srgb());
      for (const std::size_t lanes : kSizes) {
        const ColorLanes rgb = colors(lanes, 0.0F, 1.0F, static_cast<std::uint32_t>(lanes));
        const ColorLanes expected = through_spectra(upsampler, under, under.xyz_to_srgb(), rgb.view());
        auto got = *ColorLanes::create(lanes);
        ASSERT_TRUE(relight(relighter, rgb.view(), got.span()));
        for (std::size_t i = 0; i < lanes; ++i) {
          const double size = std::max({rgb.at(i, 0), rgb.at(i, 1), rgb.at(i, 2)});
          for (std::size_t k = 0; k < 3; ++k) {
            if (is_sigmoid(GetParam())) {
              ASSERT_EQ(got.at(i, k), expected.at(i, k)) << light << " lane " << i;
            } else {
              ASSERT_LE(std::abs(static_cast<double>(got.at(i, k)) - expected.at(i, k)),
                        relighter.bound()[k] * size)
                  << light << " " << bands_text << " lane " << i;
            }
          }
        }
      }
    }
  }
}

TEST_P(Relighting, WhiteBecomesTheColorOfTheLight) {
  const Bands bands;
  const auto upsampler = *Upsampler::create(GetParam(), Quantity::kReflectance, bands);
  const auto under = *Projector::reflective(bands, *illuminant("A"));
  const auto relighter = *Relighter::create(upsampler, under, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  auto rgb = *ColorLanes::create(1);
  for (std::size_t k = 0; k < 3; ++k) rgb.at(0, k) = 1;
  ASSERT_TRUE(relight(relighter, rgb.view(), rgb.span())) << "in place";
  const bool exact = GetParam() != Method::kSmits && GetParam() != Method::kSmits1999;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(rgb.at(0, k), under.white()[k], exact ? 5e-7 : 0.02);
}

TEST_P(Relighting, DoesNotDependOnThreadsOrTiles) {
  const Bands bands;
  const auto upsampler = *Upsampler::create(GetParam(), Quantity::kReflectance, bands);
  const auto under = *Projector::reflective(bands, *illuminant("FL2"));
  const auto relighter = *Relighter::create(upsampler, under, under.xyz_to_srgb());
  const ColorLanes rgb = colors(4099, -0.2F, 1.3F, 3);
  auto once = *ColorLanes::create(4099);
  ASSERT_TRUE(relight(relighter, rgb.view(), once.span(), {1, 1 << 20}));
  for (const Execution execution : {Execution{2, 64}, Execution{3, 640}, Execution{1, 1}}) {
    auto again = *ColorLanes::create(4099);
    ASSERT_TRUE(relight(relighter, rgb.view(), again.span(), execution));
    for (std::size_t i = 0; i < 4099; ++i) {
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(once.at(i, k), again.at(i, k));
    }
  }
}

/// The upsampler and projector that it was made of are gone when it is used.
Result<Relighter> made_elsewhere(Method method) {
  SPECTILE_ASSIGN(const auto upsampler, Upsampler::create(method, Quantity::kReflectance, Bands()));
  SPECTILE_ASSIGN(const auto under, Projector::reflective(Bands(), *illuminant("A")));
  return Relighter::create(upsampler, under, under.xyz_to_srgb());
}

TEST_P(Relighting, KeepsWhatItWasMadeOf) {
  const auto upsampler = *Upsampler::create(GetParam(), Quantity::kReflectance, Bands());
  const auto under = *Projector::reflective(Bands(), *illuminant("A"));
  const auto here = *Relighter::create(upsampler, under, under.xyz_to_srgb());
  const Relighter copy = *made_elsewhere(GetParam());
  const Relighter& elsewhere = copy;
  const ColorLanes rgb = colors(200, 0, 1, 9);
  auto want = *ColorLanes::create(200);
  auto got = *ColorLanes::create(200);
  ASSERT_TRUE(relight(here, rgb, want));
  ASSERT_TRUE(relight(elsewhere, rgb, got));
  for (std::size_t i = 0; i < 600; ++i) EXPECT_EQ(got.at(i / 3, i % 3), want.at(i / 3, i % 3)) << i;
  EXPECT_EQ(elsewhere.upsampler().method(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(EveryMethod, Relighting, testing::ValuesIn(kRelitMethods), [](const auto& one) {
  std::string name(to_string(one.param));
  std::erase(name, '-');
  return name;
});

TEST(Relighter, ExactBasesHaveABoundOfRoundingOnly) {
  const Bands bands;
  const auto under = *Projector::reflective(bands, *illuminant("A"));
  for (const Method method : {Method::kSmitsExact, Method::kMallett}) {
    const auto upsampler = *Upsampler::create(method, Quantity::kReflectance, bands);
    const auto relighter = *Relighter::create(upsampler, under, under.xyz_to_srgb());
    for (const double bound : relighter.bound()) EXPECT_LT(bound, 2e-5);
  }
  const auto smits = *Upsampler::create(Method::kSmits, Quantity::kReflectance, bands);
  const auto relighter = *Relighter::create(smits, under, under.xyz_to_srgb());
  for (const double bound : relighter.bound()) EXPECT_GT(bound, 1e-4);
}

TEST(Relighter, NeitherLightNorOtherBandsNorOtherSizesAreTaken) {
  const Bands bands;
  const Bands other = *Bands::uniform(380, 780, 5);
  const auto under = *Projector::reflective(bands, *illuminant("A"));
  const auto light = *Upsampler::create(Method::kSmitsExact, Quantity::kIlluminant, bands);
  EXPECT_EQ(Relighter::create(light, under, under.xyz_to_srgb()).error().code, ErrorCode::kBadArgument);
  const auto wide = *Upsampler::create(Method::kSmitsExact, Quantity::kReflectance, other);
  EXPECT_EQ(Relighter::create(wide, under, under.xyz_to_srgb()).error().code, ErrorCode::kBandsMismatch);
  const auto good = *Upsampler::create(Method::kSmitsExact, Quantity::kReflectance, bands);
  const auto relighter = *Relighter::create(good, under, under.xyz_to_srgb());
  const ColorLanes rgb = colors(16, 0, 1, 1);
  auto out = *ColorLanes::create(17);
  EXPECT_EQ(relight(relighter, rgb.view(), out.span()).error().code, ErrorCode::kSizeMismatch);
}

TEST(Relighter, NanStaysNan) {
  const Bands bands;
  const auto under = *Projector::reflective(bands, *illuminant("A"));
  for (const Method method : kRelitMethods) {
    const auto upsampler = *Upsampler::create(method, Quantity::kReflectance, bands);
    const auto relighter = *Relighter::create(upsampler, under, under.xyz_to_srgb());
    auto rgb = colors(2, 0.1F, 0.9F, 5);
    rgb.at(0, 1) = NAN;
    ASSERT_TRUE(relight(relighter, rgb.view(), rgb.span()));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_TRUE(std::isnan(rgb.at(0, k))) << to_string(method);
      EXPECT_TRUE(std::isfinite(rgb.at(1, k))) << to_string(method);
    }
  }
}

}  // namespace
}  // namespace spectile::test
