// Lookups at points: edges, mip levels, files of every layout, and what cannot be looked up.
#include "tests/io/texture/texture_lookups.hpp"

#include <cmath>
#include <filesystem>

namespace spectile::test {
namespace {

using testing::HasSubstr;

/// A texture of one band, x + 1000 y, which float and filters keep exactly.
Picture counting(int width, int height, Imath::V2i origin = {0, 0}) {
  Picture picture = blank(width, height, origin);
  picture.add("T.500nm", Imf::FLOAT, [](int x, int y) { return x + 1000 * y; });
  return picture;
}

class TextureLookups : public testing::Test {
 protected:
  float one(const SpectralTexture& texture, float u, float v, const TextureLookup& lookup = {}) const {
    Points points(1);
    points.u[0] = u;
    points.v[0] = v;
    return sampled(texture, points.at(), wavelengths_of(1, {500}), lookup).at(0, 0);
  }
  const TempFolder folder_;
};

TEST_F(TextureLookups, BeyondTheEdgesEachWrapHasItsTexels) {
  Picture picture = counting(8, 4);
  write_scanlines(folder_ / "t.exr", picture);
  const SpectralTexture texture = opened(folder_ / "t.exr");
  const auto at = [&](TextureWrap wrap, float texel_x) {
    return one(texture, (texel_x + 0.5F) / 8, 0.125F, {TextureFilter::kNearest, wrap, TextureWrap::kClamp});
  };
  const float repeat[] = {6, 7, 0, 7, 0, 1};
  const float mirror[] = {1, 0, 0, 7, 7, 6};
  const float clamp[] = {0, 0, 0, 7, 7, 7};
  const float black[] = {0, 0, 0, 7, 0, 0};
  const float texels[] = {-2, -1, 0, 7, 8, 9};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(at(TextureWrap::kRepeat, texels[i]), repeat[i]) << texels[i];
    EXPECT_EQ(at(TextureWrap::kMirror, texels[i]), mirror[i]) << texels[i];
    EXPECT_EQ(at(TextureWrap::kClamp, texels[i]), clamp[i]) << texels[i];
    EXPECT_EQ(at(TextureWrap::kBlack, texels[i]), black[i]) << texels[i];
  }
  // Half of the seam's texels each.
  const TextureLookup linear = {TextureFilter::kBilinear, TextureWrap::kRepeat, TextureWrap::kRepeat};
  EXPECT_EQ(one(texture, 0, 0.125F, linear), 3.5F);
  EXPECT_EQ(one(texture, 1, 0.125F, linear), 3.5F);
  EXPECT_EQ(one(texture, 0.0625F, 0, linear), 1500);
  EXPECT_EQ(one(texture, 0, 0.125F, {TextureFilter::kBilinear, TextureWrap::kBlack, TextureWrap::kClamp}), 0);
  EXPECT_EQ(one(texture, 1, 0.125F, {TextureFilter::kBilinear, TextureWrap::kBlack, TextureWrap::kClamp}),
            3.5F);
}

TEST_F(TextureLookups, BeyondABlackEdgeEveryMethodIsZero) {
  for (const Kind& kind : all_kinds()) {
    Picture picture = blank(4, 4);
    add_rgb_noise(picture, Imf::FLOAT);
    write_scanlines(folder_ / "in.exr", picture);
    upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "t.exr", options_of(kind));
    const SpectralTexture texture = opened(folder_ / "t.exr");
    const TextureLookup black = {TextureFilter::kBilinear, TextureWrap::kBlack, TextureWrap::kBlack};
    EXPECT_EQ(one(texture, -1, 0.5F, black), 0) << kind;
    EXPECT_EQ(one(texture, 0.5F, 3, black), 0) << kind;
    EXPECT_NE(one(texture, 0.5F, 0.5F, black), 0) << kind;
    std::filesystem::remove(folder_ / "t.exr");
  }
}

TEST_F(TextureLookups, ACoordinateThatIsNoNumberGivesNaN) {
  Picture picture = counting(8, 4);
  write_scanlines(folder_ / "t.exr", picture);
  const SpectralTexture texture = opened(folder_ / "t.exr");
  for (const float strange : {kNan, kInf, -kInf}) {
    EXPECT_TRUE(std::isnan(one(texture, strange, 0.5F)));
    EXPECT_TRUE(std::isnan(one(texture, 0.5F, strange)));
  }
  EXPECT_FALSE(std::isnan(one(texture, 1e30F, -1e30F)));
  Points points(1);
  points.level[0] = kNan;
  EXPECT_TRUE(std::isnan(sampled(texture, points.at_level(), wavelengths_of(1, {500}), {}).at(0, 0)));
  SampledSpectra lambda = wavelengths_of(1, {500});
  lambda.at(0, 0) = kNan;
  EXPECT_TRUE(std::isnan(sampled(texture, points.at(), lambda, {}).at(0, 0)));
}

TEST_F(TextureLookups, EveryLayoutOfAFileGivesTheSameTexels) {
  Picture picture = counting(300, 150, {-7, 12});
  const Points points = centres_of_texels(300, 150);
  const SampledSpectra lambda = wavelengths_of(300 * 150, {500});
  const auto expect_all = [&](const std::string& name) {
    const SampledSpectra got =
        sampled(opened(folder_ / name), points.at(), lambda, {.filter = TextureFilter::kNearest});
    for (std::size_t i = 0; i < got.lanes(); ++i)
      ASSERT_EQ(got.at(i, 0), static_cast<float>(i % 300 + 1000 * (i / 300))) << name;
  };
  for (const auto compression : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
                                 Imf::PIZ_COMPRESSION, Imf::DWAB_COMPRESSION}) {
    picture.header.compression() = compression == Imf::DWAB_COMPRESSION ? Imf::RLE_COMPRESSION : compression;
    write_scanlines(folder_ / "t.exr", picture);
    expect_all("t.exr");
  }
  for (const unsigned side : {16U, 48U, 64U, 100U, 256U, 512U}) {
    write_tiles(folder_ / "t.exr", picture, side, side == 48);
    expect_all("t.exr");
  }
}

TEST_F(TextureLookups, LevelsAreThoseOfTheFile) {
  // Every pixel of level l is 100 l: of one texture each.
  Picture picture = blank(200, 100);
  picture.add("R", Imf::FLOAT, [](int, int) { return 0.5; });
  picture.add("G", Imf::FLOAT, [](int x, int) { return x < 100 ? 0.25 : 0.75; });
  picture.add("B", Imf::FLOAT, [](int, int) { return 0.5; });
  write_scanlines(folder_ / "in.exr", picture);
  UpsampleImageOptions options = options_of({Method::kMallett, Quantity::kReflectance});
  options.pixel = SampleType::kFloat;
  options.mipmap = true;
  options.tile = {{32, 32}};
  upsample_to(Store::kSpectra, folder_ / "in.exr", folder_ / "t.exr", options);
  const SpectralTexture texture = opened(folder_ / "t.exr");
  EXPECT_EQ(*texture.levels(), 8);
  Points points(4);
  const std::size_t lanes = 4;
  for (std::size_t i = 0; i < lanes; ++i) points.v[i] = 0.5F;
  points.u[0] = 0.25F;
  points.u[1] = 0.75F;
  points.u[2] = points.u[3] = 0.5F;
  const SampledSpectra lambda = wavelengths_of(lanes, {550});
  const auto at_level = [&](float level, TextureFilter filter) {
    for (std::size_t i = 0; i < lanes; ++i) points.level[i] = level;
    return sampled(texture, points.at_level(), lambda, {.filter = filter});
  };
  const SampledSpectra level0 = at_level(0, TextureFilter::kNearest);
  const float left = level0.at(0, 0);
  const float right = level0.at(1, 0);
  EXPECT_GT(right, left + 0.1F);
  // The last level is one pixel: the mean of all.
  const SampledSpectra last = at_level(7, TextureFilter::kNearest);
  EXPECT_NEAR(last.at(0, 0), (left + right) / 2, 1e-6);
  EXPECT_TRUE(same_lanes(at_level(40, TextureFilter::kNearest), last));
  EXPECT_TRUE(same_lanes(at_level(-3, TextureFilter::kNearest), level0));
  // Between two levels both count by the level's part.
  const SampledSpectra six = at_level(6, TextureFilter::kTrilinear);
  const SampledSpectra seven = at_level(7, TextureFilter::kTrilinear);
  const SampledSpectra between = at_level(6.25F, TextureFilter::kTrilinear);
  for (std::size_t i = 0; i < lanes; ++i)
    EXPECT_NEAR(between.at(i, 0), 0.75F * six.at(i, 0) + 0.25F * seven.at(i, 0), 1e-6);
  // A footprint of 2^l texels is level l: 200 texels wide.
  for (std::size_t i = 0; i < lanes; ++i) points.level[i] = 64.0F / 200;
  EXPECT_TRUE(same_lanes(sampled(texture, points.with_footprint(), lambda, {}), six));
  for (std::size_t i = 0; i < lanes; ++i) points.level[i] = 80.0F / 200;  // a quarter between 64 and 128
  const SampledSpectra footprint = sampled(texture, points.with_footprint(), lambda, {});
  for (std::size_t i = 0; i < lanes; ++i) EXPECT_NEAR(footprint.at(i, 0), between.at(i, 0), 1e-6);
}

TEST_F(TextureLookups, SamplesMayReplaceTheirWavelengths) {
  for (const Kind& kind : {Kind{Method::kSigmoid, Quantity::kIlluminant}, Kind{}}) {
    Picture picture = blank(40, 40);
    add_rgb_noise(picture, Imf::FLOAT);
    write_scanlines(folder_ / "in.exr", picture);
    upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "t.exr", options_of(kind));
    const SpectralTexture texture = opened(folder_ / "t.exr");
    const Points points = points_about(200, 9);
    SampledSpectra batch = wavelengths_of(200, {450, 600});
    const SampledSpectra want = sampled(texture, points.at(), batch, {});
    ASSERT_TRUE(texture.sample(points.at(), batch, batch));
    EXPECT_TRUE(same_lanes(batch, want));
    std::filesystem::remove(folder_ / "t.exr");
  }
}

TEST_F(TextureLookups, BatchesThatDoNotFitAreRefused) {
  Picture picture = counting(8, 4);
  write_scanlines(folder_ / "t.exr", picture);
  const SpectralTexture texture = opened(folder_ / "t.exr");
  const Points points(5);
  const SampledSpectra lambda = wavelengths_of(5, {500});
  SampledSpectra samples = own_batch(5, 1);
  SampledSpectra two = own_batch(5, 2);
  SampledSpectra six = own_batch(6, 1);
  auto on_bands = *SampledSpectra::create(texture.bands(), 5);
  EXPECT_EQ(code_of(texture.sample(points.at(), lambda, two)), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(texture.sample(points.at(), lambda, six)), code(ErrorCode::kSizeMismatch));
  EXPECT_EQ(code_of(texture.sample(points.at(), lambda, on_bands)), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(code_of(texture.sample(points.at(), samples)), code(ErrorCode::kBandsMismatch));
  EXPECT_EQ(
      code_of(texture.sample({.u = points.u, .v = points.v, .level = points.level, .footprint = points.level},
                             lambda, samples)),
      code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(texture.sample({}, lambda, samples)), code(ErrorCode::kSizeMismatch));
}

TEST_F(TextureLookups, ADataWindowThatIsNotTheDisplayWindowIsRefusedWithBoth) {
  Picture picture = counting(8, 4);
  picture.header.displayWindow() = Imath::Box2i({0, 0}, {15, 3});
  write_scanlines(folder_ / "t.exr", picture);
  const Points points(5);
  SampledSpectra samples = own_batch(5, 1);
  const auto result = opened(folder_ / "t.exr").sample(points.at(), wavelengths_of(5, {500}), samples);
  ASSERT_EQ(code_of(result), code(ErrorCode::kBadFile));
  EXPECT_THAT(result.error().message, HasSubstr("8 x 4 at 0,0, is not its display window, 16 x 4 at 0,0"));
}

TEST_F(TextureLookups, DamagedAndChangedFilesAreErrors) {
  Picture picture = counting(300, 300);
  picture.header.compression() = Imf::NO_COMPRESSION;
  write_scanlines(folder_ / "t.exr", picture);
  const std::string bytes = file_bytes(folder_ / "t.exr");
  write_text(folder_ / "cut.exr", bytes.substr(0, bytes.size() / 2));
  const SpectralTexture cut = opened(folder_ / "cut.exr");
  Points points(2);
  points.v[0] = 0.1F;
  points.v[1] = 0.9F;
  SampledSpectra samples = own_batch(2, 1);
  EXPECT_EQ(code_of(cut.sample(points.at(), wavelengths_of(2, {500}), samples)), code(ErrorCode::kBadFile));

  const SpectralTexture texture = opened(folder_ / "t.exr");
  write_text(folder_ / "t.exr", bytes + "more");
  const auto changed = texture.sample(points.at(), wavelengths_of(2, {500}), samples);
  ASSERT_EQ(code_of(changed), code(ErrorCode::kBadFile));
  EXPECT_THAT(changed.error().message, HasSubstr("was changed"));
}

}  // namespace
}  // namespace spectile::test
