// One shading loop on two representations: equal where they must be, apart where three numbers do not
// suffice.
#include <spectile/color/color_difference.hpp>
#include <spectile/upsampling/representation.hpp>
#include <spectile/upsampling/rgb_spectrum.hpp>

#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

/// Light that bounced so often off a surface, plus what one in a hundred misses: written once.
template <class Representation>
std::array<double, 3> xyz_after(const Representation& r, const Spectrum& light, const Spectrum& reflectance,
                                int bounces) {
  auto radiance = *r.light(light, 1);
  const auto albedo = *r.reflectance(reflectance, 1);
  for (int i = 0; i < bounces; ++i) EXPECT_TRUE(multiply(radiance.view(), albedo.view(), radiance.span()));
  auto xyz = *ColorLanes::create(1);
  EXPECT_TRUE(r.to_xyz(radiance.view(), xyz.span()));
  auto y = *ScalarLanes::create(1);
  EXPECT_TRUE(r.luminance(radiance.view(), y.span()));
  EXPECT_NEAR(y[0], xyz.at(0, 1), 1e-5 * std::abs(y[0]));
  return {xyz.at(0, 0), xyz.at(0, 1), xyz.at(0, 2)};
}

PiecewiseLinearSpectrum fluorescent() {
  return PiecewiseLinearSpectrum(*illuminant("FL11"));
}

TEST(Representation, GreyIsGreyInBoth) {
  const auto rgb = *RgbRepresentation::create();
  const auto sampled = *SampledRepresentation::create(*Bands::parse("360:830:1"));
  for (const int bounces : {0, 1, 5}) {
    const auto a = xyz_after(rgb, fluorescent(), ConstantSpectrum(0.5), bounces);
    const auto b = xyz_after(sampled, fluorescent(), ConstantSpectrum(0.5), bounces);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(a[k] / b[k], 1, 1e-4) << bounces;  // averages over bands of 1 nm
  }
}

TEST(Representation, SaturatedBouncesUnderLineSpectraNeedSpectra) {
  const auto rgb = *RgbRepresentation::create();
  const auto sampled = *SampledRepresentation::create(*Bands::parse("380:780:5"));
  const auto reference = *SampledRepresentation::create(*Bands::parse("360:830:1"));
  const auto upsampler =
      *Upsampler::create(Method::kSigmoid, Quantity::kReflectance, *Bands::parse("360:830:5"));
  const Spectrum orange = *rgb_albedo_spectrum(upsampler, {0.7, 0.3, 0.05});
  const auto white = xyz_after(reference, fluorescent(), ConstantSpectrum(1), 0);
  const auto off = [&](const std::array<double, 3>& xyz, const std::array<double, 3>& want) {
    return ciede2000(xyz_to_lab(xyz, white), xyz_to_lab(want, white));
  };
  for (const int bounces : {1, 2, 3}) {
    const auto want = xyz_after(reference, fluorescent(), orange, bounces);
    const double of_rgb = off(xyz_after(rgb, fluorescent(), orange, bounces), want);
    const double of_sampled = off(xyz_after(sampled, fluorescent(), orange, bounces), want);
    EXPECT_LT(of_sampled, 0.7) << bounces;
    EXPECT_GT(of_rgb, 1.0) << bounces;
    EXPECT_GT(of_rgb, 3 * of_sampled) << bounces;
  }
}

TEST(Representation, ColoursGoThereAndBack) {
  const auto rgb = *RgbRepresentation::create();
  const auto sampled = *SampledRepresentation::create();
  const auto grid = cube_grid(9);
  auto three = *rgb.constant(grid.lanes(), 0);
  ASSERT_TRUE(rgb.light_from_rgb(grid.view(), three.span()));
  auto sixty = *sampled.constant(grid.lanes(), 0);
  ASSERT_TRUE(rgb.to_sampled(sampled, three.view(), sixty.span()));
  auto back = *rgb.constant(grid.lanes(), 7);
  ASSERT_TRUE(rgb.from_sampled(sampled, sixty.view(), back.span()));
  for (std::size_t i = 0; i < grid.lanes(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(three.at(i, k), grid.at(i, k));
      ASSERT_NEAR(back.at(i, k), grid.at(i, k), 2e-6);
    }
  }
}

TEST(Representation, TheTwoCannotBeMixed) {
  const auto rgb = *RgbRepresentation::create();
  const auto sampled = *SampledRepresentation::create();
  auto three = *rgb.constant(64, 1);
  auto sixty = *sampled.constant(64, 1);
  auto xyz = *ColorLanes::create(64);
  EXPECT_EQ(code_of(multiply(three.view(), sixty.view(), sixty.span())), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(rgb.to_xyz(sixty.view(), xyz.span())), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(sampled.to_rgb(three.view(), xyz.span())), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(rgb.light_from_rgb(xyz.view(), sixty.span())), code(ErrorCode::kBandsMismatch));
}

}  // namespace
}  // namespace spectile::test
