// Access to textures: which pixels are read, from many threads, and errors.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <spectile/image/spectral_texture.hpp>
#include <thread>

#include "tests/io/convert/jobs/compact_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

class TextureAccess : public testing::Test {
 protected:
  static constexpr int kWidth = 70;
  static constexpr int kHeight = 40;

  TextureAccess() {
    UpsampleImageOptions options = test::options_of({Method::kSigmoid, Quantity::kUnbounded});
    options.bands = *Bands::uniform(400, 700, 15);
    options.pixel = SampleType::kFloat;
    test::Picture picture = test::every_color(kWidth, kHeight);
    test::write_scanlines(folder_ / "in.exr", picture);
    test::upsample_to(Store::kSpectra, folder_ / "in.exr", folder_ / "full.exr", options);
    test::upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "compact.exr", options);
  }

  SpectralTexture open(const std::string& name) const {
    auto texture = SpectralTexture::open(folder_ / name);
    EXPECT_TRUE(texture) << texture.error().message;
    return *texture;
  }

  const test::TempFolder folder_;
};

TEST_F(TextureAccess, OnlyChannelsNextToTheWavelengthsAreRead) {
  const SpectralTexture texture = open("full.exr");
  std::uint64_t before = 0;
  const auto channels_read = [&](const PixelWindow& region, const std::vector<double>& wavelengths) {
    EXPECT_TRUE(texture.evaluate(region, wavelengths));
    const std::uint64_t samples = texture.samples_read() - before;
    before += samples;
    return static_cast<double>(samples) / (kWidth * region.height());
  };
  EXPECT_EQ(texture.samples_read(), 0U);
  const PixelWindow few = {3, 10, 23, 16};
  EXPECT_EQ(channels_read(few, {407.5}), 1);            // a centre
  EXPECT_EQ(channels_read(few, {408}), 2);              // between two
  EXPECT_EQ(channels_read(few, {408, 409, 421}), 2);    // between the same two
  EXPECT_EQ(channels_read(few, {408, 422.5, 430}), 3);  // three in a row
  EXPECT_EQ(channels_read(few, {300, 390, 407.5}), 1);  // below the first
  EXPECT_EQ(channels_read(few, {692.5, 700, 900}), 1);  // above the last
  EXPECT_EQ(channels_read(few, {410, 600}), 4);
  EXPECT_EQ(channels_read({0, 0, kWidth, kHeight}, {550}), 2);
  EXPECT_EQ(channels_read({0, 0, 1, 1}, {550}), 2);
}

TEST_F(TextureAccess, CompactImagesReadTheirCoefficientsOnly) {
  const SpectralTexture texture = open("compact.exr");
  ASSERT_TRUE(texture.evaluate({0, 5, 10, 8}, std::vector<double>{450, 500, 550, 600}));
  EXPECT_EQ(texture.samples_read(), std::uint64_t{4} * 3 * kWidth);
}

TEST_F(TextureAccess, OtherChannelsDoNotMatter) {
  test::Picture full = test::read_picture(folder_ / "full.exr");
  const auto want = open("full.exr").evaluate({0, 0, kWidth, kHeight}, std::vector<double>{500});
  ASSERT_TRUE(want);
  for (auto& [name, plane] : full.planes) {
    if (name == "T.497,500000nm" || name == "T.512,500000nm") continue;
    for (std::size_t i = 0; i < full.pixels(); ++i) plane.set(i, std::nan(""));
  }
  test::write_scanlines(folder_ / "nan.exr", full);
  const auto got = open("nan.exr").evaluate({0, 0, kWidth, kHeight}, std::vector<double>{500});
  ASSERT_TRUE(got);
  EXPECT_TRUE(test::same_lanes(*got, *want));
}

TEST_F(TextureAccess, OnlyLinesOfTheRegionAreRead) {
  for (const char* name : {"full.exr", "compact.exr"}) {
    // Uncompressed lines lie one after another: the last ten or so are cut off.
    const std::string bytes = test::file_bytes(folder_ / name);
    test::write_text(folder_ / "cut.exr", bytes.substr(0, bytes.size() * 3 / 4));
    const SpectralTexture texture = open("cut.exr");
    const auto upper = texture.evaluate({0, 0, kWidth, kHeight / 2}, std::vector<double>{500});
    EXPECT_TRUE(upper) << name;
    const auto lower = texture.evaluate({0, kHeight - 1, 1, kHeight}, std::vector<double>{500});
    EXPECT_EQ(test::code_of(lower), test::code(ErrorCode::kBadFile)) << name;
    // OpenEXR's stream does not get over the file's end: opened anew, the upper lines are there again.
    EXPECT_TRUE(open("cut.exr").evaluate({5, 5, 10, 10}, std::vector<double>{500})) << name;
  }
}

TEST_F(TextureAccess, HighRegionsComeInSeveralReadings) {
  test::Picture picture = test::blank(3, 700);
  picture.add("T.500nm", Imf::FLOAT, [](int x, int y) { return x + 10 * y; });
  test::write_scanlines(folder_ / "high.exr", picture);
  const auto spectra = open("high.exr").evaluate({1, 20, 3, 700}, std::vector<double>{500});
  ASSERT_TRUE(spectra);
  for (std::size_t i = 0; i < 1360; ++i)
    ASSERT_EQ(spectra->at(i, 0), static_cast<float>(201 + i % 2 + 10 * (i / 2)));
}

TEST_F(TextureAccess, RegionsThatAreNotWithinTheImageAreRefusedWithTheirNumbers) {
  const SpectralTexture texture = open("compact.exr");
  constexpr int kMost = std::numeric_limits<int>::max();
  for (const PixelWindow& r :
       {PixelWindow{0, 0, 0, 1}, PixelWindow{0, 0, 1, 0}, PixelWindow{0, 0, -1, 5}, PixelWindow{-1, 0, 1, 2},
        PixelWindow{0, -1, 2, 1}, PixelWindow{kWidth, 0, kWidth + 1, 1}, PixelWindow{1, 0, kWidth + 1, 1},
        PixelWindow{0, kHeight - 1, 1, kHeight + 1}, PixelWindow{-kMost - 1, 0, kMost, 1},
        PixelWindow{1, 1, kMost, kMost}, PixelWindow{}}) {
    const auto result = texture.evaluate(r, std::vector<double>{500});
    ASSERT_EQ(test::code_of(result), test::code(ErrorCode::kBadArgument));
    EXPECT_THAT(result.error().message,
                HasSubstr(fmt::format("{} x {} pixels at {},{}", std::int64_t{r.x1} - r.x0,
                                      std::int64_t{r.y1} - r.y0, r.x0, r.y0)));
    EXPECT_THAT(result.error().message, HasSubstr("70 x 40"));
  }
  EXPECT_EQ(texture.samples_read(), 0U);
}

TEST_F(TextureAccess, WavelengthsMustAscend) {
  const SpectralTexture texture = open("full.exr");
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<double>> wrong = {{},
                                                  {0},
                                                  {-500},
                                                  {kNan},
                                                  {kInfinity},
                                                  {500, 500},
                                                  {500, 400},
                                                  {400, kNan, 500},
                                                  {400, kInfinity},
                                                  std::vector<double>(Bands::kMaxBands + 1, 500)};
  for (const auto& wavelengths : wrong) {
    const auto result = texture.evaluate({0, 0, 1, 1}, wavelengths);
    EXPECT_EQ(test::code_of(result), test::code(ErrorCode::kBadArgument))
        << testing::PrintToString(wavelengths);
  }
  // Those that no bands with symmetric edges could be made for are fine.
  EXPECT_TRUE(texture.evaluate({0, 0, 1, 1}, std::vector<double>{0.25}));
  EXPECT_TRUE(texture.evaluate({0, 0, 1, 1}, std::vector<double>{380, 1200}));
}

TEST_F(TextureAccess, BatchOfAnotherSizeIsRefused) {
  SampledSpectra batch = *SampledSpectra::create(Bands(), 12);
  EXPECT_EQ(test::code_of(open("full.exr").evaluate({0, 0, 4, 4}, batch.span())),
            test::code(ErrorCode::kSizeMismatch));
}

TEST_F(TextureAccess, CoefficientsThatAreNotFiniteGiveNanInTheirPixelOnly) {
  test::Picture compact = test::read_picture(folder_ / "compact.exr");
  const auto want = open("compact.exr").evaluate({0, 0, kWidth, 2}, std::vector<double>{450, 550});
  ASSERT_TRUE(want);
  compact.planes.at("spectile.c1").set(compact.index(30, 1), HUGE_VAL);
  compact.planes.at("spectile.scale").set(compact.index(0, 0), std::nan(""));
  compact.planes.at("spectile.c2").set(compact.index(65, 0), 1e30);
  test::write_scanlines(folder_ / "nan.exr", compact);
  const auto got = open("nan.exr").evaluate({0, 0, kWidth, 2}, std::vector<double>{450, 550});
  ASSERT_TRUE(got);
  for (std::size_t i = 0; i < got->lanes(); ++i) {
    const bool bad = i == 0 || i == 65 || i == kWidth + 30;
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_TRUE(bad ? std::isnan(got->at(i, b)) : test::same_bits(got->at(i, b), want->at(i, b))) << i;
    }
  }
}

TEST_F(TextureAccess, SeveralThreadsMayAskOneTexture) {
  const std::vector<double> wavelengths = {420, 500, 580.5, 660};
  for (const char* name : {"full.exr", "compact.exr"}) {
    const SpectralTexture texture = open(name);
    const auto whole = texture.evaluate({0, 0, kWidth, kHeight}, wavelengths);
    ASSERT_TRUE(whole);
    std::vector<int> wrong(4, 0);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < wrong.size(); ++t) {
      threads.emplace_back([&, t, copy = texture] {
        for (int line = 0; line < kHeight; ++line) {
          const int y = (line + static_cast<int>(t) * 7) % kHeight;
          const auto part = (t % 2 == 0 ? texture : copy).evaluate({0, y, kWidth, y + 1}, wavelengths);
          for (std::size_t x = 0; part && x < kWidth; ++x) {
            for (std::size_t b = 0; b < wavelengths.size(); ++b) {
              wrong[t] += part->at(x, b) == whole->at(static_cast<std::size_t>(y) * kWidth + x, b) ? 0 : 1;
            }
          }
          wrong[t] += part ? 0 : 1;
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_THAT(wrong, testing::Each(0)) << name;
  }
}

TEST(TextureLayout, NamesTypesAndStorageAreReadLiberally) {
  const test::TempFolder folder;
  test::Picture picture = test::blank(35, 20, {7, -9});
  // 400, 500, 600 nm, and a polarised one that is no business of radiance.
  picture.add("S0.0,6um", Imf::HALF, [](int x, int y) { return x + y; });
  picture.add("S0.4,000E-7m", Imf::FLOAT, [](int x, int) { return 2 * x; });
  picture.add("S0.500.0nm", Imf::UINT, [](int, int y) { return 3 * y; });
  picture.add("S1.500,0nm", Imf::HALF, [](int, int) { return -1; });
  picture.add("Y", Imf::HALF, [](int, int) { return 0.5; });
  test::write_tiles(folder / "light.exr", picture, 16, true);
  const auto texture = SpectralTexture::open(folder / "light.exr");
  ASSERT_TRUE(texture) << texture.error().message;
  EXPECT_EQ(texture->quantity(), Quantity::kIlluminant);
  ASSERT_EQ(texture->bands().count(), 3U);
  const auto spectra = texture->evaluate({30, 10, 35, 12}, std::vector<double>{400, 450, 500, 600});
  ASSERT_TRUE(spectra) << spectra.error().message;
  // The second pixel of the second line is 31, 11.
  EXPECT_EQ(spectra->at(6, 0), 62);
  EXPECT_EQ(spectra->at(6, 1), 0.5F * (62 + 33));
  EXPECT_EQ(spectra->at(6, 2), 33);
  EXPECT_EQ(spectra->at(6, 3), 42);
}

TEST(TextureLayout, ImagesWithoutSpectraAreRefused) {
  const test::TempFolder folder;
  test::Picture picture = test::blank(4, 4);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(folder / "rgb.exr", picture);
  const auto texture = SpectralTexture::open(folder / "rgb.exr");
  ASSERT_EQ(test::code_of(texture), test::code(ErrorCode::kBadFile));
  EXPECT_THAT(texture.error().message, HasSubstr("neither spectral channels"));
  EXPECT_EQ(test::code_of(SpectralTexture::open(folder / "none.exr")), test::code(ErrorCode::kBadFile));
}

TEST(TextureLayout, PublishedImagesOpen) {
  SPECTILE_NEEDS_IMAGES("spectral");
  for (const std::string& path : test::shared_files("spectral")) {
    const auto texture = SpectralTexture::open(path);
    ASSERT_TRUE(texture) << texture.error().message;
    const int x = texture->width() / 2;
    const int y = texture->height() / 2;
    const auto pixel = texture->evaluate({x, y, x + 1, y + 1}, std::vector<double>{450, 550.5, 650});
    EXPECT_TRUE(pixel) << path;
  }
}

}  // namespace
}  // namespace spectile
