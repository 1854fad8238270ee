// Projection to XYZ, luminance and the sRGB matrices against the double oracle and published values.
#include <gmock/gmock.h>

#include <spectile/color/colorimetry.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "src/color/kernel_tables.hpp"
#include "src/reference/oracle/oracle.hpp"
#include "tests/support/lanes.hpp"

namespace spectile::test {
namespace {

const Bands& whole_range() {
  static const Bands bands = *Bands::uniform(360, 830, 1);
  return bands;
}

// The oracle sums at 0.01 nm; the largest difference measured is 6e-8 (FL11, whose lines bend most).
constexpr double kWeightBound = 1e-7;

/// Largest difference of a projector's weights from the oracle's, relative to the largest weight of the
/// component.
double weight_error(const Projector& projector, const MeasuredSpectrum* light) {
  const auto exact = oracle::projection_weights(projector.bands(), *projector.observer(), light);
  double worst = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    double largest = 0;
    for (const auto& w : exact) largest = std::max(largest, w[k]);
    for (std::size_t b = 0; b < exact.size(); ++b) {
      worst = std::max(worst, std::abs(projector.weights()[b][k] - exact[b][k]) / largest);
    }
  }
  return worst;
}

std::vector<Bands> several_bands() {
  return {Bands(), *Bands::uniform(380, 780, 5), *Bands::uniform(350, 850, 10),
          *Bands::uniform(360, 830, 0.5), *Bands::parse("380.3,395.1,401,450.7,455,530,620,622")};
}

TEST(Projector, EmissiveWeightsAgreeWithTheOracle) {
  for (const Bands& bands : several_bands()) {
    for (const Observer observer : {Observer::kCie1931, Observer::kCie1964}) {
      const auto projector = Projector::emissive(bands, observer);
      ASSERT_TRUE(projector);
      EXPECT_EQ(projector->observer(), observer);
      EXPECT_LE(weight_error(*projector, nullptr), kWeightBound) << bands.description();
    }
  }
}

TEST(Projector, ReflectiveWeightsAgreeWithTheOracle) {
  for (const Bands& bands : several_bands()) {
    for (const char* name : {"D65", "A", "FL11"}) {
      const MeasuredSpectrum light = *illuminant(name);
      for (const Observer observer : {Observer::kCie1931, Observer::kCie1964}) {
        const auto projector = Projector::reflective(bands, light, observer);
        ASSERT_TRUE(projector);
        EXPECT_LE(weight_error(*projector, &light), kWeightBound) << name << ", " << bands.description();
      }
    }
  }
}

TEST(Projector, FloatWeightsAreTheDoubleOnesRounded) {
  const auto projector = *Projector::reflective(Bands(), *illuminant("D50"));
  ASSERT_EQ(projector.weights().size(), 60U);
  for (std::size_t b = 0; b < 60; ++b) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(ProjectorAccess::weights(projector)[4 * b + k],
                static_cast<float>(projector.weights()[b][k]));
    }
    EXPECT_EQ(ProjectorAccess::weights(projector)[4 * b + 3], 0.0F);
    EXPECT_EQ(ProjectorAccess::luminance_weights(projector)[b],
              ProjectorAccess::weights(projector)[4 * b + 1]);
  }
}

TEST(Projector, WhiteHasLuminanceOne) {
  for (const Bands& bands : several_bands()) {
    EXPECT_NEAR(Projector::emissive(bands)->white()[1], 1, 1e-14);
    EXPECT_NEAR(Projector::reflective(bands, *illuminant("A"))->white()[1], 1, 1e-14);
  }
}

TEST(Projector, WhitesAreThePublished) {
  struct White {
    const char* name;
    Observer observer;
    double x, z, tolerance;
  };
  // Five digits, by sums at 5 nm; ours are exact integrals of straight pieces between the 5 nm samples, which
  // differ most where the light bends most (C below 450 nm).
  const White whites[] = {
      {"D65", Observer::kCie1931, 0.95047, 1.08883, 1e-4}, {"A", Observer::kCie1931, 1.09850, 0.35585, 1e-4},
      {"D50", Observer::kCie1931, 0.96422, 0.82521, 1e-4}, {"C", Observer::kCie1931, 0.98074, 1.18232, 7e-4},
      {"D65", Observer::kCie1964, 0.94811, 1.07304, 1e-4}, {"A", Observer::kCie1964, 1.11144, 0.35200, 1e-4}};
  for (const White& w : whites) {
    const auto white = Projector::reflective(whole_range(), *illuminant(w.name), w.observer)->white();
    EXPECT_NEAR(white[0], w.x, w.tolerance) << w.name;
    EXPECT_NEAR(white[2], w.z, w.tolerance) << w.name;
  }
  for (const Observer observer : {Observer::kCie1931, Observer::kCie1964}) {
    const auto equal_energy = Projector::emissive(whole_range(), observer)->white();
    // Sums of the bars differ by up to 3.3e-4 (1931); 2.2e-4 (1964).
    EXPECT_NEAR(equal_energy[0], 1, 4e-4);
    EXPECT_NEAR(equal_energy[2], 1, 4e-4);
  }
}

TEST(Projector, WhiteOfCutOffBandsMovesWithoutAStep) {
  const MeasuredSpectrum d65 = *illuminant("D65");
  std::array<double, 3> before{};
  bool all = false;
  bool part = false;
  bool none = false;
  for (double first = 400; first <= 500; first += 0.25) {
    const auto projector = *Projector::reflective(*Bands::uniform(first, first + 280, 20), d65);
    const std::array<double, 3> white = times(projector.xyz_to_srgb(), projector.white());
    const double share = projector.white_compensation();
    if (share == 1) {
      for (const double v : white) EXPECT_NEAR(v, 1, 1e-12) << first;
    }
    EXPECT_TRUE(share > 0 || projector.xyz_to_srgb() == xyz_to_srgb_matrix()) << first;
    all = all || share == 1;
    part = part || (share > 0 && share < 1);
    none = none || share == 0;
    for (std::size_t k = 0; first > 400 && k < 3; ++k) EXPECT_NEAR(white[k], before[k], 0.01) << first;
    before = white;
  }
  EXPECT_TRUE(all && part && none);
}

TEST(Projector, ObserversDiffer) {
  const auto two = Projector::emissive(Bands(), Observer::kCie1931)->white();
  const auto ten = Projector::emissive(Bands(), Observer::kCie1964)->white();
  EXPECT_GT(std::abs(two[0] - ten[0]) + std::abs(two[2] - ten[2]), 1e-3);
}

TEST(Projector, ScaleOfTheLightDoesNotMatter) {
  const MeasuredSpectrum light = *illuminant("FL2");
  const auto a = *Projector::reflective(Bands(), light);
  const auto b = *Projector::reflective(Bands(), light.scaled(12345.678));
  for (std::size_t i = 0; i < 60; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a.weights()[i][k], b.weights()[i][k], 1e-14);
  }
}

TEST(Projector, ConstantLightIsLikeEmission) {
  const auto constant = *MeasuredSpectrum::from_samples(std::vector{500.0}, std::vector{3.0});
  const auto a = *Projector::reflective(Bands(), constant);
  const auto b = *Projector::emissive(Bands());
  for (std::size_t i = 0; i < 60; ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a.weights()[i][k], b.weights()[i][k], 1e-14);
  }
}

TEST(Projector, TakesALightOfAnyDistribution) {
  const Bands bands;
  const auto table = *Projector::reflective(bands, *illuminant("FL11"));
  const auto named = *Projector::reflective(bands, *named_spectrum("FL11"));
  const auto body = *Projector::reflective(bands, *BlackbodySpectrum::create(2856));
  const auto a = *Projector::reflective(bands, *illuminant("A"));
  for (std::size_t b = 0; b < bands.count(); ++b) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(named.weights()[b][k], table.weights()[b][k]);
      EXPECT_NEAR(body.weights()[b][k], a.weights()[b][k], 2e-5);  // illuminant A is a black body of 2856 K
    }
  }
  EXPECT_FALSE(Projector::reflective(bands, Spectrum(ConstantSpectrum(0))));
}

TEST(Projector, BandsNobodySeesAreAnError) {
  for (const char* text : {"900:1000:10", "200:360:10", "830:840:10"}) {
    const auto projector = Projector::emissive(*Bands::parse(text));
    EXPECT_EQ(code_of(projector), code(ErrorCode::kBadArgument)) << text;
  }
  EXPECT_TRUE(Projector::emissive(*Bands::parse("829:900:1")));
  EXPECT_TRUE(Projector::emissive(*Bands::parse("300:361:1")));
}

TEST(Projector, LightWithoutLuminanceIsAnError) {
  const auto light = [](std::vector<double> w, std::vector<double> v) {
    return *MeasuredSpectrum::from_samples(w, v);
  };
  const auto code_for = [](const MeasuredSpectrum& l) { return code_of(Projector::reflective(Bands(), l)); };
  EXPECT_EQ(code_for(light({500}, {0})), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_for(light({500}, {-1})), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_for(light({800, 800}, {0, 1})), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_for(light({500, 500}, {0, 1})), -1);
}

TEST(Project, IsWithinItsBoundOfTheDoubleSum) {
  for (const Bands& bands : several_bands()) {
    const auto projector = *Projector::reflective(bands, *illuminant("D65"));
    const double bound = static_cast<double>(bands.count() + 2) * 0x1p-24;
    for (const std::size_t lanes : kSizes) {
      const auto spectra = batch_from(bands, lanes, plain_floats(50021, 1, -0.5F, 2.0F));
      auto xyz = *ColorLanes::create(lanes);
      ASSERT_TRUE(project(projector, spectra.view(), xyz.span()));
      for (std::size_t lane = 0; lane<lanes; lane += lanes> 100 ? 13 : 1) {
        for (std::size_t k = 0; k < 3; ++k) {
          double exact = 0;
          double magnitudes = 0;
          for (std::size_t b = 0; b < bands.count(); ++b) {
            const double term = projector.weights()[b][k] * spectra.at(lane, b);
            exact += term;
            magnitudes += std::abs(term);
          }
          ASSERT_LE(std::abs(xyz.at(lane, k) - exact), bound * magnitudes)
              << bands.description() << " " << lane;
        }
      }
    }
  }
}

TEST(Project, AgreesWithTheOracle) {
  const MeasuredSpectrum light = *illuminant("A");
  const Bands bands;
  const auto projector = *Projector::reflective(bands, light, Observer::kCie1964);
  const auto weights = oracle::projection_weights(bands, Observer::kCie1964, &light);
  const auto spectra = batch_from(bands, 65, plain_floats(5003, 2));
  auto xyz = *ColorLanes::create(65);
  ASSERT_TRUE(project(projector, spectra.view(), xyz.span()));
  for (std::size_t lane = 0; lane < 65; ++lane) {
    std::vector<double> spectrum(60);
    for (std::size_t b = 0; b < 60; ++b) spectrum[b] = spectra.at(lane, b);
    const auto exact = oracle::project(weights, spectrum);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(xyz.at(lane, k), exact[k], (62 * 0x1p-24 + kWeightBound) * exact[k]);
  }
}

TEST(Project, LuminanceHasTheBitsOfY) {
  for (const std::size_t lanes : kSizes) {
    const auto spectra = batch_from(Bands(), lanes, arbitrary_floats(20011, 3));
    const auto projector = *Projector::emissive(Bands());
    auto xyz = *ColorLanes::create(lanes);
    auto y = *ScalarLanes::create(lanes);
    ASSERT_TRUE(project(projector, spectra.view(), xyz.span()));
    ASSERT_TRUE(luminance(projector, spectra.view(), y.span()));
    EXPECT_TRUE(same_bits(y.view().data, xyz.view().c[1], lanes));
  }
}

TEST(Project, LuminanceOfOneIsOne) {
  for (const Bands& bands : several_bands()) {
    const auto projector = *Projector::emissive(bands);
    const auto ones = *SampledSpectra::constant(bands, 3, 1.0F);
    auto y = *ScalarLanes::create(3);
    ASSERT_TRUE(luminance(projector, ones.view(), y.span()));
    EXPECT_NEAR(y[2], 1, static_cast<double>(bands.count() + 2) * 0x1p-24);
  }
}

TEST(Project, LetsNanAndInfinitiesThrough) {
  auto spectra = *SampledSpectra::constant(Bands(), 3, 1.0F);
  spectra.at(0, 30) = kNan;
  spectra.at(1, 30) = kInf;
  auto xyz = *ColorLanes::create(3);
  ASSERT_TRUE(project(*Projector::emissive(Bands()), spectra.view(), xyz.span()));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_TRUE(std::isnan(xyz.at(0, k)));
    EXPECT_EQ(xyz.at(1, k), kInf);
    EXPECT_TRUE(std::isfinite(xyz.at(2, k)));
  }
}

TEST(Project, ThreadsAndTilesDoNotChangeBits) {
  constexpr std::size_t kLanes = 70001;
  const Bands bands = *Bands::uniform(400, 700, 50);
  const auto spectra = batch_from(bands, kLanes, arbitrary_floats(20011, 4));
  const auto projector = *Projector::emissive(bands);
  auto want = *ColorLanes::create(kLanes);
  ASSERT_TRUE(project(projector, spectra.view(), want.span(), {1, kLanes}));
  for (const Execution& execution :
       {Execution{1, 64}, Execution{2, 64}, Execution{3, 100}, Execution{2, 65536}, Execution{}}) {
    auto got = *ColorLanes::create(kLanes);
    auto y = *ScalarLanes::create(kLanes);
    ASSERT_TRUE(project(projector, spectra.view(), got.span(), execution));
    ASSERT_TRUE(luminance(projector, spectra.view(), y.span(), execution));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(same_bits(got.view().c[k], want.view().c[k], kLanes));
    EXPECT_TRUE(same_bits(y.view().data, want.view().c[1], kLanes));
  }
}

TEST(Project, OtherBandsOrLanesAreAnError) {
  const auto projector = *Projector::emissive(Bands());
  auto xyz = *ColorLanes::create(17);
  auto y = *ScalarLanes::create(17);
  const auto other_bands = *SampledSpectra::create(*Bands::uniform(400, 700, 10), 17);
  const auto other_lanes = *SampledSpectra::create(Bands(), 18);
  EXPECT_EQ(code_of(project(projector, other_bands.view(), xyz.span())), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(luminance(projector, other_bands.view(), y.span())), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(project(projector, other_lanes.view(), xyz.span())), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(luminance(projector, other_lanes.view(), y.span())), code(ErrorCode::kSizeMismatch));
  EXPECT_THAT(project(projector, other_bands.view(), xyz.span()).error().message,
              testing::HasSubstr("400:700:10"));
}

}  // namespace
}  // namespace spectile::test
