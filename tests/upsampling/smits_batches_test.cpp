// Smits upsampling of batches: special values, XYZ, tilings, stores, and errors.
#include <gmock/gmock.h>

#include <spectile/color/colorimetry.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "src/reference/oracle/oracle.hpp"
#include "src/upsampling/method_rows.hpp"
#include "tests/support/lanes.hpp"
#include "tests/upsampling/round_trip.hpp"

namespace spectile::test {
namespace {

Upsampler smits(NegativeSamples negative = NegativeSamples::kClampToZero, const Bands& bands = Bands()) {
  return *Upsampler::create(Method::kSmits, Quantity::kReflectance, bands, negative);
}

TEST(SmitsBatches, NanInAnyComponentIsNanInEveryBand) {
  const float others[] = {0.0F, 0.5F, 1.0F, -1.0F, kInf, -kInf, kNan};
  for (const Method method : {Method::kSmits, Method::kSmits1999}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
      for (const NegativeSamples negative : {NegativeSamples::kClampToZero, NegativeSamples::kKeep}) {
        const auto upsampler = *Upsampler::create(method, quantity, Bands(), negative);
        auto rgb = *ColorLanes::create(3 * 49);
        for (std::size_t i = 0; i < rgb.lanes(); ++i) {
          rgb.at(i, i % 3) = kNan;
          rgb.at(i, (i + 1) % 3) = others[i / 3 % 7];
          rgb.at(i, (i + 2) % 3) = others[i / 21];
        }
        auto spectra = *SampledSpectra::create(Bands(), rgb.lanes());
        ASSERT_TRUE(upsample_srgb(upsampler, rgb.view(), spectra.span()));
        for (std::size_t i = 0; i < rgb.lanes(); ++i) {
          for (std::size_t b = 0; b < 60; ++b) ASSERT_TRUE(std::isnan(spectra.at(i, b))) << i << " " << b;
        }
      }
    }
  }
}

TEST(SmitsBatches, InfinitiesGiveInfinitiesOrNanAndClampedOnesZero) {
  const float values[] = {0.0F, 0.5F, -1.0F, kInf, -kInf};
  auto rgb = *ColorLanes::create(125);
  for (std::size_t i = 0; i < 125; ++i) {
    rgb.at(i, 0) = values[i % 5];
    rgb.at(i, 1) = values[i / 5 % 5];
    rgb.at(i, 2) = values[i / 25];
  }
  auto spectra = *SampledSpectra::create(Bands(), 125);
  auto clamped = *SampledSpectra::create(Bands(), 125);
  ASSERT_TRUE(upsample_srgb(smits(NegativeSamples::kKeep), rgb.view(), spectra.span()));
  ASSERT_TRUE(upsample_srgb(smits(), rgb.view(), clamped.span()));
  for (std::size_t i = 0; i < 125; ++i) {
    const bool finite =
        std::isfinite(rgb.at(i, 0)) && std::isfinite(rgb.at(i, 1)) && std::isfinite(rgb.at(i, 2));
    for (std::size_t b = 0; b < 60; ++b) {
      const float kept = spectra.at(i, b);
      ASSERT_EQ(std::isfinite(kept), finite) << i << " " << b;
      ASSERT_TRUE(same_bits(clamped.at(i, b), kept < 0 ? 0.0F : kept)) << i << " " << b;
    }
  }
}

TEST(SmitsBatches, LargeColoursHaveNoUpperLimit) {
  const auto upsampler = smits();
  auto rgb = *ColorLanes::create(1);
  for (std::size_t k = 0; k < 3; ++k) rgb.at(0, k) = 1e30F;
  auto spectra = *SampledSpectra::create(Bands(), 1);
  ASSERT_TRUE(upsample_srgb(upsampler, rgb.view(), spectra.span()));
  EXPECT_EQ(spectra.at(0, 0), 1e30F * UpsamplerAccess::table(upsampler)[0]);
}

TEST(SmitsBatches, EveryLaneIsItsOwnForEverySize) {
  const auto upsampler = smits();
  const Floats values = plain_floats(3 * 4099, 5, -0.2F, 1.0F);
  auto one_lane = *SampledSpectra::create(Bands(), 1);
  for (const std::size_t lanes : kSizes) {
    const auto rgb = colors(lanes, values);
    auto spectra = *SampledSpectra::create(Bands(), lanes);
    ASSERT_TRUE(upsample_srgb(upsampler, rgb.view(), spectra.span()));
    for (std::size_t i = 0; i<lanes; i += lanes> 100 ? 7 : 1) {
      auto one = *ColorLanes::create(1);
      for (std::size_t k = 0; k < 3; ++k) one.at(0, k) = rgb.at(i, k);
      ASSERT_TRUE(upsample_srgb(upsampler, one.view(), one_lane.span()));
      for (std::size_t b = 0; b < 60; ++b)
        ASSERT_EQ(spectra.at(i, b), one_lane.at(0, b)) << i << " of " << lanes;
    }
  }
}

TEST(SmitsBatches, XyzGoesByWayOfTheUpsamplersRgb) {
  for (const NegativeSamples negative : {NegativeSamples::kClampToZero, NegativeSamples::kKeep}) {
    const auto upsampler = smits(negative);
    for (const std::size_t lanes : kSizes) {
      const auto xyz = colors(lanes, arbitrary_floats(10007, 6));
      auto rgb = *ColorLanes::create(lanes);
      ASSERT_TRUE(transform(inverse(upsampler.rgb_to_xyz()), xyz, rgb));
      auto want = *SampledSpectra::create(Bands(), lanes);
      auto got = *SampledSpectra::create(Bands(), lanes);
      ASSERT_TRUE(upsample_srgb(upsampler, rgb.view(), want.span()));
      ASSERT_TRUE(upsample_xyz(upsampler, xyz.view(), got.span()));
      EXPECT_TRUE(same_lanes(got, want)) << lanes;
    }
  }
}

TEST(SmitsBatches, XyzIsWithinItsBoundOfTheOracle) {
  const auto upsampler = smits();
  const std::vector<std::array<double, 7>> basis(upsampler.basis().begin(), upsampler.basis().end());
  const auto xyz = colors(1500, plain_floats(4500, 7));
  auto spectra = *SampledSpectra::create(Bands(), 1500);
  ASSERT_TRUE(upsample_xyz(upsampler, xyz.view(), spectra.span()));
  const Matrix3 matrix = inverse(upsampler.rgb_to_xyz());
  double row = 0;
  for (std::size_t k = 0; k < 9; k += 3)
    row = std::max(row, std::abs(matrix[k]) + std::abs(matrix[k + 1]) + std::abs(matrix[k + 2]));
  for (std::size_t i = 0; i < 1500; ++i) {
    const std::array<double, 3> v = {xyz.at(i, 0), xyz.at(i, 1), xyz.at(i, 2)};
    const auto rgb = times(matrix, v);
    const auto exact = oracle::smits_spectrum(basis, rgb, 0);
    const double largest = std::max({std::abs(rgb[0]), std::abs(rgb[1]), std::abs(rgb[2])});
    // 6 units, twice for components of both signs, of the largest component; and 4 units of the matrix's
    // rows' largest sum of magnitudes in each component, which reach the spectrum with weights of at
    // most 5 in all.
    const double bound = (12 * largest + 4 * row * 5) * 0x1p-24 * 1.01;
    for (std::size_t b = 0; b < 60; ++b) ASSERT_NEAR(spectra.at(i, b), exact[b], bound) << i << " " << b;
  }
}

TEST(SmitsBatches, ThreadsTilesAndStoresDoNotChangeBits) {
  constexpr std::size_t kLanes = 70001;
  const Bands bands = *Bands::uniform(400, 700, 50);
  for (const Method method : {Method::kSmits, Method::kSmits1999}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kIlluminant}) {
      const auto upsampler = *Upsampler::create(method, quantity, bands);
      const auto rgb = colors(kLanes, arbitrary_floats(100003, 8));
      auto want = *SampledSpectra::create(bands, kLanes);
      auto want_xyz = *SampledSpectra::create(bands, kLanes);
      ASSERT_TRUE(upsample_srgb(upsampler, rgb.view(), want.span(), StoreHint::kCached, {1, kLanes}));
      ASSERT_TRUE(upsample_xyz(upsampler, rgb.view(), want_xyz.span(), StoreHint::kCached, {1, kLanes}));
      for (const StoreHint stores : {StoreHint::kAuto, StoreHint::kCached, StoreHint::kStreaming}) {
        for (const Execution& execution :
             {Execution{1, 64}, Execution{2, 64}, Execution{3, 100}, Execution{2, 65536}, Execution{}}) {
          auto got = *SampledSpectra::create(bands, kLanes);
          ASSERT_TRUE(upsample_srgb(upsampler, rgb.view(), got.span(), stores, execution));
          ASSERT_TRUE(same_bits(got.view().data, want.view().data, want.view().floats()));
          ASSERT_TRUE(upsample_xyz(upsampler, rgb.view(), got.span(), stores, execution));
          ASSERT_TRUE(same_bits(got.view().data, want_xyz.view().data, want.view().floats()));
        }
      }
    }
  }
}

TEST(SmitsBatches, BatchesBeyondTheCachesHaveTheSameBits) {
  constexpr std::size_t kLanes = 300001;  // 69 MiB, which kAuto stores non-temporally
  const auto upsampler = smits();
  const auto rgb = colors(kLanes, plain_floats(900007, 9, -0.1F, 1.0F));
  auto want = *SampledSpectra::create(Bands(), kLanes);
  auto got = *SampledSpectra::create(Bands(), kLanes);
  ASSERT_TRUE(upsample_srgb(upsampler, rgb.view(), want.span(), StoreHint::kCached));
  ASSERT_TRUE(upsample_srgb(upsampler, rgb.view(), got.span(), StoreHint::kAuto));
  EXPECT_TRUE(same_bits(got.view().data, want.view().data, want.view().floats()));
}

TEST(SmitsBatches, OtherBandsOrLanesAreAnError) {
  const auto upsampler = smits();
  const auto rgb = *ColorLanes::create(17);
  auto other_bands = *SampledSpectra::constant(*Bands::uniform(400, 700, 10), 17, 3.0F);
  auto other_lanes = *SampledSpectra::constant(Bands(), 16, 3.0F);
  EXPECT_EQ(code_of(upsample_srgb(upsampler, rgb.view(), other_bands.span())),
            code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(upsample_xyz(upsampler, rgb.view(), other_bands.span())),
            code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(upsample_srgb(upsampler, rgb.view(), other_lanes.span())),
            code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(upsample_xyz(upsampler, rgb.view(), other_lanes.span())), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(other_bands.at(16, 29), 3.0F);
  EXPECT_EQ(other_lanes.at(15, 59), 3.0F);
  EXPECT_THAT(upsample_srgb(upsampler, rgb.view(), other_bands.span()).error().message,
              testing::HasSubstr("400:700:10"));
}

TEST(SmitsBatches, EmptyBatchIsNoError) {
  const auto rgb = *ColorLanes::create(0);
  auto spectra = *SampledSpectra::create(Bands(), 0);
  EXPECT_TRUE(upsample_srgb(smits(), rgb.view(), spectra.span()));
}

}  // namespace
}  // namespace spectile::test
