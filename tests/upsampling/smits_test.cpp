// Smits upsampling: its bases and spectra against the oracle, and the laws that its colours and spectra keep.
#include <gmock/gmock.h>

#include <spectile/color/colorimetry.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "src/reference/oracle/oracle.hpp"
#include "src/upsampling/method_rows.hpp"
#include "tests/support/lanes.hpp"
#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

constexpr Method kSmitsMethods[] = {Method::kSmits, Method::kSmits1999};
constexpr Quantity kSmitsQuantities[] = {Quantity::kReflectance, Quantity::kIlluminant};

/// Calls f for every method and quantity, over the default bands.
template <class F>
void for_every_kind(F f, NegativeSamples negative = NegativeSamples::kClampToZero) {
  for (const Method method : kSmitsMethods) {
    for (const Quantity quantity : kSmitsQuantities) {
      SCOPED_TRACE(std::string(to_string(method)) + " " + std::string(to_string(quantity)));
      f(*Upsampler::create(method, quantity, Bands(), negative));
    }
  }
}

SampledSpectra upsampled(const Upsampler& upsampler, const ColorLanes& rgb) {
  auto spectra = *SampledSpectra::create(upsampler.bands(), rgb.lanes());
  EXPECT_TRUE(upsample_srgb(upsampler, rgb.view(), spectra.span()));
  return spectra;
}

std::vector<std::array<double, 7>> basis_of(const Upsampler& upsampler) {
  return {upsampler.basis().begin(), upsampler.basis().end()};
}

double largest_basis_value(const Upsampler& upsampler) {
  double largest = 0;
  for (const auto& row : upsampler.basis()) {
    for (const double v : row) largest = std::max(largest, std::abs(v));
  }
  return largest;
}

TEST(Upsampler, BasesAgreeWithTheOracle) {
  for (const Bands& bands : {Bands(), *Bands::uniform(380, 780, 5), *Bands::uniform(350, 850, 10),
                             *Bands::parse("380.3,395.1,401,450.7,455,530,620,622")}) {
    for (const Method method : kSmitsMethods) {
      for (const Quantity quantity : kSmitsQuantities) {
        const auto upsampler = *Upsampler::create(method, quantity, bands);
        const auto exact = oracle::smits_basis(method, quantity, bands);
        // Both integrate exactly, in double; but for the ten samples times D65, which the oracle sums at 0.01
        // nm, with steps of 1e-6 nm for the basis: 3.5e-8 measured.
        const bool summed = method == Method::kSmits1999 && quantity == Quantity::kIlluminant;
        const double bound = summed ? 1e-7 : 1e-13;
        for (std::size_t b = 0; b < bands.count(); ++b) {
          for (std::size_t k = 0; k < 7; ++k) {
            ASSERT_NEAR(upsampler.basis()[b][k], exact[b][k], bound)
                << bands.description() << " " << b << " " << k;
            ASSERT_EQ(UpsamplerAccess::table(upsampler)[8 * b + k],
                      static_cast<float>(upsampler.basis()[b][k]));
          }
          ASSERT_EQ(UpsamplerAccess::table(upsampler)[8 * b + 7], 0.0F);
        }
      }
    }
  }
}

TEST(Upsampler, RemembersWhatItIsFor) {
  const Bands bands = *Bands::uniform(400, 700, 10);
  const auto a = *Upsampler::create(Method::kSmits1999, Quantity::kIlluminant, bands, NegativeSamples::kKeep);
  EXPECT_EQ(a.method(), Method::kSmits1999);
  EXPECT_EQ(a.quantity(), Quantity::kIlluminant);
  EXPECT_TRUE(a.bands() == bands);
  EXPECT_EQ(a.lowest(), -kInf);
  EXPECT_EQ(Upsampler::create(Method::kSmits, Quantity::kReflectance, bands)->lowest(), 0.0F);
}

TEST(Upsampler, NamesGoThereAndBack) {
  for (const Method method : kSmitsMethods) EXPECT_EQ(*parse_method(to_string(method)), method);
  for (const Quantity quantity : kSmitsQuantities) EXPECT_EQ(*parse_quantity(to_string(quantity)), quantity);
  EXPECT_EQ(*parse_method("smits"), Method::kSmits);
  EXPECT_EQ(*parse_method("smits1999"), Method::kSmits1999);
  EXPECT_EQ(*parse_quantity("reflectance"), Quantity::kReflectance);
  EXPECT_EQ(*parse_quantity("illuminant"), Quantity::kIlluminant);
  EXPECT_EQ(code_of(parse_method("smit")), code(ErrorCode::kUnknownName));
  EXPECT_EQ(code_of(parse_quantity("")), code(ErrorCode::kUnknownName));
  EXPECT_THAT(parse_method("x").error().message, testing::HasSubstr("smits1999"));
  EXPECT_THAT(parse_quantity("x").error().message, testing::HasSubstr("illuminant"));
}

TEST(Upsampler, LightOfTheTenSamplesIsD65OfLuminanceOne) {
  const Bands bands = *Bands::uniform(360, 830, 1);
  const auto upsampler = *Upsampler::create(Method::kSmits1999, Quantity::kIlluminant, bands);
  auto rgb = *ColorLanes::create(1);
  for (std::size_t k = 0; k < 3; ++k) rgb.at(0, k) = 1;
  const auto white = upsampled(upsampler, rgb);
  auto xyz = *ColorLanes::create(1);
  ASSERT_TRUE(project(*Projector::emissive(bands), white.view(), xyz.span()));
  // The printed white is 1 to within 8e-4.
  EXPECT_NEAR(xyz.at(0, 1), 1, 8e-4);
  EXPECT_NEAR(xyz.at(0, 0), 0.9505, 1e-3);
  EXPECT_NEAR(xyz.at(0, 2), 1.0891, 1e-3);
}

TEST(Smits, SpectraAreWithinTheirBoundOfTheOracle) {
  for (const NegativeSamples negative : {NegativeSamples::kClampToZero, NegativeSamples::kKeep}) {
    for_every_kind(
        [](const Upsampler& upsampler) {
          const auto basis = basis_of(upsampler);
          const double largest = largest_basis_value(upsampler);
          for (const float low : {0.0F, -1.0F}) {
            const auto rgb = colors(1500, plain_floats(4500, 1, low, 1.0F));
            const auto spectra = upsampled(upsampler, rgb);
            for (std::size_t i = 0; i < rgb.lanes(); ++i) {
              const std::array<double, 3> c = {rgb.at(i, 0), rgb.at(i, 1), rgb.at(i, 2)};
              const auto exact = oracle::smits_spectrum(basis, c, static_cast<double>(upsampler.lowest()));
              const double size = std::max({std::abs(c[0]), std::abs(c[1]), std::abs(c[2])}) * largest;
              // With components of both signs a difference of two may be twice the largest component.
              const double bound = (low < 0 ? 2 : 1) * 6 * 0x1p-24 * size;
              for (std::size_t b = 0; b < 60; ++b)
                ASSERT_NEAR(spectra.at(i, b), exact[b], bound) << i << " " << b;
            }
          }
        },
        negative);
  }
}

TEST(Smits, StatedBoundHoldsForComponentsOfBothSigns) {
  // Colours with a large difference of components, found by search among 400,000 for each kind.
  const float found[4][3] = {{0x1.0a536ap-1F, 0x1.fb5094p-2F, -0x1.0a8158p-1F},
                             {-0x1.0e68a8p-1F, 0x1.0e05c6p-1F, 0x1.0e2e34p-1F},
                             {-0x1.0ba64ep-1F, 0x1.0b7258p-1F, 0x1.0317ap-1F},
                             {-0x1.0a2338p-1F, 0x1.09f376p-1F, 0x1.05cfb6p-1F}};
  for_every_kind(
      [&](const Upsampler& upsampler) {
        auto rgb = *ColorLanes::create(4);
        for (std::size_t i = 0; i < 4; ++i) {
          for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = found[i][k];
        }
        const auto spectra = upsampled(upsampler, rgb);
        for (std::size_t i = 0; i < 4; ++i) {
          const std::array<double, 3> c = {rgb.at(i, 0), rgb.at(i, 1), rgb.at(i, 2)};
          const auto exact = oracle::smits_spectrum(basis_of(upsampler), c, -INFINITY);
          const auto [least, greatest] = std::minmax({c[0], c[1], c[2]});
          const double size = std::abs(least) + (greatest - least);  // of the weights' magnitudes
          const double unit = 0x1p-24 * size * largest_basis_value(upsampler);
          for (std::size_t b = 0; b < 60; ++b)
            EXPECT_LE(std::abs(spectra.at(i, b) - exact[b]) / unit, 6) << i << " " << b;
        }
      },
      NegativeSamples::kKeep);
}

TEST(Smits, GreyStaysFlat) {
  for_every_kind([](const Upsampler& upsampler) {
    for (const float grey : {0.0F, kTiny, 0.18F, 0.5F, 1.0F, 7.5F}) {
      auto rgb = *ColorLanes::create(1);
      for (std::size_t k = 0; k < 3; ++k) rgb.at(0, k) = grey;
      const auto spectrum = upsampled(upsampler, rgb);
      for (std::size_t b = 0; b < 60; ++b)
        ASSERT_EQ(spectrum.at(0, b), grey * UpsamplerAccess::table(upsampler)[8 * b]) << grey;
    }
  });
}

TEST(Smits, CornersOfTheCubeAreTheBasesThemselves) {
  const std::size_t row_of[8] = {0, 4, 5, 3, 6, 2, 1, 0};  // bit 0 red, bit 1 green, bit 2 blue
  for_every_kind(
      [&](const Upsampler& upsampler) {
        auto rgb = *ColorLanes::create(8);
        for (std::size_t i = 0; i < 8; ++i) {
          for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = static_cast<float>(i >> k & 1U);
        }
        const auto spectra = upsampled(upsampler, rgb);
        for (std::size_t b = 0; b < 60; ++b) {
          ASSERT_EQ(spectra.at(0, b), 0.0F);
          for (std::size_t i = 1; i < 8; ++i)
            ASSERT_EQ(spectra.at(i, b), UpsamplerAccess::table(upsampler)[8 * b + row_of[i]]) << i;
        }
      },
      NegativeSamples::kKeep);
}

TEST(Smits, TwiceTheColourIsExactlyTwiceTheSpectrum) {
  for_every_kind([](const Upsampler& upsampler) {
    const auto rgb = colors(65, plain_floats(195, 2));
    auto twice = *ColorLanes::create(65);
    for (std::size_t i = 0; i < 65; ++i) {
      for (std::size_t k = 0; k < 3; ++k) twice.at(i, k) = 2 * rgb.at(i, k);
    }
    const auto one = upsampled(upsampler, rgb);
    const auto two = upsampled(upsampler, twice);
    for (std::size_t i = 0; i < 65; ++i) {
      for (std::size_t b = 0; b < 60; ++b) ASSERT_EQ(two.at(i, b), 2 * one.at(i, b));
    }
  });
}

TEST(Smits, ClampedSamplesAreNeverBelowZeroAndKeptOnesSometimesAre) {
  const auto rgb = colors(4099, plain_floats(12297, 3, -0.5F, 1.0F));
  const auto least_of = [&](const Upsampler& upsampler) {
    const auto spectra = upsampled(upsampler, rgb);
    float least = kInf;
    for (std::size_t i = 0; i < rgb.lanes(); ++i) {
      for (std::size_t b = 0; b < 60; ++b) least = std::min(least, spectra.at(i, b));
    }
    return least;
  };
  for_every_kind([&](const Upsampler& upsampler) { EXPECT_EQ(least_of(upsampler), 0.0F); });
  for_every_kind([&](const Upsampler& upsampler) { EXPECT_LT(least_of(upsampler), -0.1F); },
                 NegativeSamples::kKeep);
}

TEST(Smits, CornersOfTheCubeRoundTripAsWellAsTheMethodCan) {
  // Measured over 380:780:5, reflectances under D65, lights as they are; bounds 1 % above. The first is of
  // the chromatic corners, the second of white.
  struct ReturnCase {
    Method method;
    Quantity quantity;
    double chromatic, white;
  };
  const ReturnCase cases[] = {{Method::kSmits, Quantity::kReflectance, 0.03321, 0.00189},
                              {Method::kSmits, Quantity::kIlluminant, 0.12307, 0.08267},
                              {Method::kSmits1999, Quantity::kReflectance, 0.09778, 0.00069},
                              {Method::kSmits1999, Quantity::kIlluminant, 0.09793, 0.00085}};
  const Bands bands = *Bands::uniform(380, 780, 5);
  for (const ReturnCase& c : cases) {
    const auto upsampler = *Upsampler::create(c.method, c.quantity, bands);
    const auto projector = c.quantity == Quantity::kReflectance
                               ? *Projector::reflective(bands, *illuminant("D65"))
                               : *Projector::emissive(bands);
    auto rgb = *ColorLanes::create(8);
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = static_cast<float>(i >> k & 1U);
    }
    const auto spectra = upsampled(upsampler, rgb);
    auto back = *ColorLanes::create(8);
    ASSERT_TRUE(project(projector, spectra.view(), back.span()));
    ASSERT_TRUE(xyz_to_srgb(back.view(), back.span()));
    double worst[8] = {};
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        worst[i] = std::max(worst[i], std::abs(double(back.at(i, k)) - rgb.at(i, k)));
    }
    SCOPED_TRACE(std::string(to_string(c.method)) + " " + std::string(to_string(c.quantity)));
    EXPECT_LE(*std::max_element(worst + 1, worst + 7), 1.01 * c.chromatic);
    EXPECT_GE(*std::max_element(worst + 1, worst + 7), 0.99 * c.chromatic) << "better: measure again";
    EXPECT_LE(worst[7], 1.01 * c.white);
    EXPECT_EQ(worst[0], 0.0);
  }
}

}  // namespace
}  // namespace spectile::test
