// The methods smits-exact and mallett: the colours of the whole cube return from spectra between 0 and 1,
// lights have their white's shape, and where there is no such method the error names another.
#include <gmock/gmock.h>

#include "src/upsampling/exact_basis.hpp"
#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

constexpr Method kExactMethods[] = {Method::kSmitsExact, Method::kMallett};
constexpr Quantity kQuantities[] = {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant};

/// Calls f for both methods, every quantity, several bands, lights and observers.
template <class F>
void for_many(F f) {
  struct Setting {
    const char* bands;
    const char* light;
    Observer observer;
  };
  const Setting settings[] = {
      {"400:700:5", "D65", Observer::kCie1931},  {"380:780:5", "D65", Observer::kCie1931},
      {"400:700:10", "D65", Observer::kCie1931}, {"380:780:5", "A", Observer::kCie1931},
      {"400:700:5", "D50", Observer::kCie1931},  {"400:700:5", "D65", Observer::kCie1964}};
  for (const Method method : kExactMethods) {
    for (const Quantity quantity : kQuantities) {
      for (const Setting& setting : settings) {
        UpsamplerOptions options;
        options.observer = setting.observer;
        if (std::string(setting.light) != "D65") options.light = *illuminant(setting.light);
        SCOPED_TRACE(std::string(to_string(method)) + " " + std::string(to_string(quantity)) + " " +
                     setting.bands + " " + setting.light);
        f(*Upsampler::create(method, quantity, *Bands::parse(setting.bands), options));
      }
    }
  }
}

void expect_exact(const Upsampler& upsampler, const ColorLanes& rgb) {
  const RoundTrip result = round_trip(upsampler, rgb);
  EXPECT_LE(result.rgb, 1e-6);  // 2e-6 is what is asked for
  EXPECT_LE(result.ciede2000, 1e-4);
  EXPECT_GE(result.least, 0);
  EXPECT_TRUE(upsampler.quantity() == Quantity::kIlluminant || result.greatest <= 1) << result.greatest;
}

TEST(ExactMethods, TheCubesColoursReturn) {
  for_many([](const Upsampler& upsampler) { expect_exact(upsampler, cube_grid(17)); });
}

TEST(ExactMethods, TheCubesColoursReturnOnAFineGrid) {
  for (const Method method : kExactMethods) {
    const auto upsampler = *Upsampler::create(method, Quantity::kReflectance, Bands());
    expect_exact(upsampler, cube_grid(65));
  }
}

TEST(ExactMethods, ColoursNearBlackAndAboveOneReturnAsWell) {
  for (const Method method : kExactMethods) {
    const auto upsampler = *Upsampler::create(method, Quantity::kUnbounded, Bands());
    for (const float scale : {1e-30F, 1e-6F, 1e-3F, 10.0F, 1e6F, 1e30F}) {
      auto rgb = cube_grid(9);
      for (std::size_t i = 0; i < 3 * rgb.lanes(); ++i) rgb.at(i / 3, i % 3) *= scale;
      EXPECT_LE(round_trip(upsampler, rgb, false).rgb, 1e-6 * static_cast<double>(scale)) << scale;
    }
  }
}

TEST(ExactMethods, WhiteIsThePerfectDiffuserOrTheLightItself) {
  for_many([](const Upsampler& upsampler) {
    const Bands& bands = upsampler.bands();
    const auto spectra = spectra_of(upsampler, lanes_of({{1, 1, 1}, {0, 0, 0}, {0.25F, 0.25F, 0.25F}}));
    const MeasuredSpectrum light =
        upsampler.options().light ? *upsampler.options().light : *illuminant("D65");
    const Projector projector = projector_of(upsampler);
    double luminance = 0;
    for (std::size_t b = 0; b < bands.count(); ++b) {
      luminance += projector.weights()[b][1] * light.integral(bands[b].lower_nm, bands[b].upper_nm) /
                   bands[b].width_nm();
    }
    for (std::size_t b = 0; b < bands.count(); ++b) {
      const double average = light.integral(bands[b].lower_nm, bands[b].upper_nm) / bands[b].width_nm();
      const bool emits = upsampler.quantity() == Quantity::kIlluminant;
      const double want = emits ? average / luminance : 1.0;
      ASSERT_NEAR(spectra.at(0, b), want, (emits ? 0x1p-24 : 0) * want) << b;
      ASSERT_EQ(spectra.at(1, b), 0) << b;
      ASSERT_EQ(spectra.at(2, b), 0.25F * spectra.at(0, b)) << b;
    }
  });
}

TEST(ExactMethods, XyzReturnsUnderTheirOwnLight) {
  const auto tried = [](const Upsampler& upsampler) {
    const ColorLanes rgb = cube_grid(5);
    auto xyz = *ColorLanes::create(rgb.lanes());
    auto back = *ColorLanes::create(rgb.lanes());
    auto spectra = *SampledSpectra::create(upsampler.bands(), rgb.lanes());
    ASSERT_TRUE(transform(upsampler.rgb_to_xyz(), rgb, xyz));
    ASSERT_TRUE(upsample_xyz(upsampler, xyz, spectra));
    const UpsamplerOptions& o = upsampler.options();
    const bool emits = upsampler.quantity() == Quantity::kIlluminant;
    const MeasuredSpectrum light = o.light ? *o.light : *illuminant("D65");
    const auto projector = emits ? *Projector::emissive(upsampler.bands(), o.observer)
                                 : *Projector::reflective(upsampler.bands(), light, o.observer);
    ASSERT_TRUE(project(projector, spectra, back));
    for (std::size_t i = 0; i < rgb.lanes(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(back.at(i, k), xyz.at(i, k), 4e-6) << i << " " << k;
    }
  };
  for_many(tried);
  UpsamplerOptions narrow;
  narrow.primaries = {{0.60, 0.33}, {0.31, 0.55}, {0.16, 0.10}, {0.3127, 0.3290}};
  tried(*Upsampler::create(Method::kTetrahedral, Quantity::kReflectance, *Bands::parse("380:780:5"), narrow));
}

TEST(ExactMethods, CornersAreTheBasesThemselves) {
  const std::size_t row_of[8] = {0, 4, 5, 3, 6, 2, 1, 0};  // bit 0 red, bit 1 green, bit 2 blue
  for_many([&](const Upsampler& upsampler) {
    const auto spectra = spectra_of(upsampler, cube_corners());
    for (std::size_t b = 0; b < upsampler.bands().count(); ++b) {
      for (std::size_t i = 1; i < 8; ++i) {
        const auto want = static_cast<float>(upsampler.basis()[b][row_of[i]]);
        ASSERT_EQ(spectra.at(i, b), std::max(0.0F, want)) << i << " " << b;
      }
    }
  });
}

TEST(ExactMethods, TheStoredTablesAreWhatTheProgramsFind) {
  const auto space = *working_space(Bands(), false, kRec709, *illuminant("D65"), Observer::kCie1931);
  for (const Method method : kExactMethods) {
    const auto found = method == Method::kSmitsExact ? smoothest_basis(Bands(), space)
                                                     : primary_decomposition(Bands(), space);
    ASSERT_TRUE(found);
    const auto stored = *Upsampler::create(method, Quantity::kReflectance, Bands());
    UpsamplerOptions same_light;  // not the stored case by its words, but by its meaning
    same_light.light = *illuminant("D65");
    const auto asked = *Upsampler::create(method, Quantity::kReflectance, Bands(), same_light);
    ASSERT_EQ(stored.basis().size(), 60U);
    for (std::size_t b = 0; b < 60; ++b) {
      for (std::size_t k = 0; k < 7; ++k) {
        ASSERT_NEAR(stored.basis()[b][k], (*found)[b][k], 1e-9) << b << " " << k;
        ASSERT_NEAR(asked.basis()[b][k], (*found)[b][k], 1e-9) << b << " " << k;
      }
    }
  }
}

TEST(ExactMethods, MallettIsLinearInEachPrimary) {
  // A mixture of three spectra that sum to white: so a filter on the spectrum is the same filter on each of
  // them.
  const auto upsampler = *Upsampler::create(Method::kMallett, Quantity::kReflectance, Bands());
  const auto rgb = random_colors(4099, 1);
  const auto spectra = spectra_of(upsampler, rgb);
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    for (std::size_t b = 0; b < 60; ++b) {
      const auto& basis = upsampler.basis()[b];
      const double want = rgb.at(i, 0) * basis[4] + rgb.at(i, 1) * basis[5] + rgb.at(i, 2) * basis[6];
      ASSERT_NEAR(spectra.at(i, b), want, 6 * 0x1p-24) << i << " " << b;
    }
  }
}

TEST(ExactMethods, SpacesWithoutSuchSpectraAreErrorsThatNameAnotherMethod) {
  using testing::HasSubstr;
  for (const char* space : {"rec2020", "acescg", "display-p3"}) {
    UpsamplerOptions options;
    options.primaries = rgb_space(space)->chromaticities;
    const auto exact = Upsampler::create(Method::kSmitsExact, Quantity::kReflectance, Bands(), options);
    ASSERT_EQ(code_of(exact), code(ErrorCode::kBadArgument)) << space;
    EXPECT_THAT(exact.error().message,
                testing::AllOf(HasSubstr("smits-exact"), HasSubstr("sigmoid"), HasSubstr("400:700:5")));
    const auto mallett = Upsampler::create(Method::kMallett, Quantity::kReflectance, Bands(), options);
    ASSERT_EQ(code_of(mallett), code(ErrorCode::kBadArgument)) << space;
    EXPECT_THAT(mallett.error().message, testing::AllOf(HasSubstr("mallett"), HasSubstr("sigmoid")));
  }
}

TEST(ExactMethods, SpacesWithinSrgbWork) {
  UpsamplerOptions options;
  options.primaries = {{0.60, 0.34}, {0.31, 0.56}, {0.17, 0.10}, {0.3127, 0.3290}};
  expect_exact(*Upsampler::create(Method::kSmitsExact, Quantity::kReflectance, Bands(), options),
               cube_grid(17));
}

TEST(ExactMethods, FewBandsAreErrorsThatNameAnotherMethod) {
  for (const char* text : {"550", "500,600", "450,550,610", "450,500,550,610"}) {
    for (const Method method : kExactMethods) {
      const auto upsampler = Upsampler::create(method, Quantity::kReflectance, *Bands::parse(text));
      ASSERT_EQ(code_of(upsampler), code(ErrorCode::kBadArgument)) << text;
      EXPECT_THAT(upsampler.error().message, testing::HasSubstr("smits takes any bands"));
    }
  }
}

}  // namespace
}  // namespace spectile::test
