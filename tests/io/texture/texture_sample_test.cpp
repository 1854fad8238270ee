// Lookups at points: the texels' own samples, filtered as spectra, whatever the method and the form.
#include <cmath>

#include "tests/io/texture/texture_lookups.hpp"

namespace spectile::test {
namespace {

constexpr int kWidth = 130;
constexpr int kHeight = 70;
constexpr std::size_t kTexels = std::size_t{kWidth} * kHeight;

class TextureSample : public testing::TestWithParam<Kind> {
 protected:
  TextureSample() {
    UpsampleImageOptions options = options_of(GetParam());
    options.pixel = SampleType::kFloat;
    // Without colours below 0: see TextureLookups for those.
    Picture picture = blank(kWidth, kHeight);
    add_rgb_noise(picture, Imf::FLOAT, 1.2);
    write_scanlines(folder_ / "in.exr", picture);
    upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "compact.exr", options);
    upsample_to(Store::kSpectra, folder_ / "in.exr", folder_ / "full.exr", options);
  }
  const TempFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Kinds, TextureSample, testing::ValuesIn(all_kinds()), kind_name);

/// All texels of a file at wavelengths that float holds.
SampledSpectra all_texels(const SpectralTexture& texture, const std::vector<double>& nm) {
  auto out = texture.evaluate({0, 0, texture.width(), texture.height()}, nm);
  EXPECT_TRUE(out) << out.error().message;
  return *std::move(out);
}

TEST_P(TextureSample, NearestIsTheTexelsOwnSample) {
  // Centres, and beyond the outer ones: sigmoids are not straight between.
  const std::vector<double> nm = {380, 409.375, 428.125, 521.875, 690.625, 800};
  const Points points = centres_of_texels(kWidth, kHeight);
  // `smits` clamps at the centres of bands, before interpolating: so does the full image.
  const SampledSpectra want = all_texels(opened(folder_ / "full.exr"), nm);
  for (const char* name : {"full.exr", "compact.exr"}) {
    const SpectralTexture texture = opened(folder_ / name);
    const SampledSpectra got =
        sampled(texture, points.at(), wavelengths_of(kTexels, nm), {.filter = TextureFilter::kNearest});
    for (std::size_t i = 0; i < kTexels; ++i) {
      for (std::size_t k = 0; k < nm.size(); ++k)
        ASSERT_NEAR(got.at(i, k), want.at(i, k), 2e-6 * std::max(1.0F, std::abs(want.at(i, k))))
            << name << " texel " << i << ", " << nm[k] << " nm";
    }
  }
}

TEST_P(TextureSample, BilinearIsTheMeanOfTheTexelsSpectra) {
  const std::vector<double> nm = {409.375, 596.875};
  const std::size_t lanes = 1000;
  Points points(lanes);
  const Floats drawn = plain_floats(blocks_for(2 * lanes) * kLanesPerBlock, 3, 0.02F, 0.98F);
  for (std::size_t i = 0; i < lanes; ++i) {
    points.u[i] = drawn[2 * i];
    points.v[i] = drawn[2 * i + 1];
  }
  for (const char* name : {"full.exr", "compact.exr"}) {
    const SpectralTexture texture = opened(folder_ / name);
    const SampledSpectra texels = all_texels(texture, nm);
    const SampledSpectra got =
        sampled(texture, points.at(), wavelengths_of(lanes, nm), {.filter = TextureFilter::kBilinear});
    for (std::size_t i = 0; i < lanes; ++i) {
      const double x = static_cast<double>(points.u[i]) * kWidth - 0.5;
      const double y = static_cast<double>(points.v[i]) * kHeight - 0.5;
      for (std::size_t k = 0; k < nm.size(); ++k) {
        double want = 0;
        double most = 0;
        for (int tap = 0; tap < 4; ++tap) {
          const double column = std::floor(x) + tap % 2;
          const double line = std::floor(y) + tap / 2;
          const double weight = (1 - std::abs(x - column)) * (1 - std::abs(y - line));
          const auto at = static_cast<std::size_t>(line * kWidth + column);
          want += weight * static_cast<double>(texels.at(at, k));
          most = std::max(most, std::abs(static_cast<double>(texels.at(at, k))));
        }
        // The coordinates' parts are good to 130 * 2^-23.
        ASSERT_NEAR(got.at(i, k), want, 2e-5 * most) << name << " lane " << i;
      }
    }
  }
}

TEST_P(TextureSample, BothFormsAgreeOnBandsAndAtOwnWavelengths) {
  const Points points = points_about(500, 5);
  const SpectralTexture full = opened(folder_ / "full.exr");
  const SpectralTexture compact = opened(folder_ / "compact.exr");
  auto on_bands = *SampledSpectra::create(full.bands(), 500);
  std::vector<double> centres;
  for (const Band& band : full.bands().list()) centres.push_back(band.centre_nm);
  for (const SpectralTexture& texture : {full, compact}) {
    ASSERT_TRUE(texture.sample(points.at(), on_bands));
    const SampledSpectra own = sampled(texture, points.at(), wavelengths_of(500, centres), {});
    const SampledSpectra other = sampled(full, points.at(), wavelengths_of(500, centres), {});
    for (std::size_t i = 0; i < 500; ++i) {
      for (std::size_t k = 0; k < centres.size(); ++k) {
        ASSERT_NEAR(on_bands.at(i, k), own.at(i, k), 3e-6 * std::max(1.0F, std::abs(own.at(i, k)))) << i;
        ASSERT_NEAR(own.at(i, k), other.at(i, k), 3e-6 * std::max(1.0F, std::abs(own.at(i, k)))) << i;
      }
    }
  }
}

TEST_P(TextureSample, OnItsOwnBandsNearestIsWhatIsStored) {
  const Points points = centres_of_texels(kWidth, kHeight);
  const SpectralTexture full = opened(folder_ / "full.exr");
  const SpectralTexture compact = opened(folder_ / "compact.exr");
  std::vector<double> centres;
  for (const Band& band : full.bands().list()) centres.push_back(band.centre_nm);
  const SampledSpectra want = all_texels(full, centres);
  auto got = *SampledSpectra::create(full.bands(), kTexels);
  // The weights of basis spectra are mixed in another order.
  const bool exact = is_sigmoid(GetParam().method) || GetParam().method == Method::kTetrahedral ||
                     GetParam().method == Method::kMallett || GetParam().method == Method::kSmits;
  for (const SpectralTexture& texture : {full, compact}) {
    ASSERT_TRUE(texture.sample(points.at(), got, {.filter = TextureFilter::kNearest}));
    // A centre may be a last bit off its place between two in float.
    const double allowed = exact && texture.compact() ? 0 : 1e-6;
    for (std::size_t i = 0; i < kTexels; ++i) {
      for (std::size_t k = 0; k < centres.size(); ++k)
        ASSERT_NEAR(got.at(i, k), want.at(i, k), allowed * std::max(1.0F, std::abs(want.at(i, k)))) << i;
    }
  }
}

TEST_P(TextureSample, AnyInstructionSetThreadCountAndTileGivesTheSameBits) {
  const Points points = points_about(3000, 7);
  const SampledSpectra lambda = wavelengths_of(3000, {405, 500, 555.5, 700});
  const SpectralTexture texture = opened(folder_ / "compact.exr");
  const std::string before(*active_isa());
  ASSERT_TRUE(force_isa("scalar"));
  const SampledSpectra want = sampled(texture, points.at(), lambda, {});
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(force_isa(isa));
    for (const Execution& execution : {Execution{1, 64}, Execution{3, 128}, Execution{8, 1024}})
      EXPECT_TRUE(same_lanes(sampled(texture, points.at(), lambda, {}, execution), want)) << isa;
  }
  ASSERT_TRUE(force_isa(before));
}

}  // namespace
}  // namespace spectile::test
