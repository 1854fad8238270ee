// Pixels that need a decision: NaN and infinities, negative ones, those beyond half; and conversions that are
// stopped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// 70 x 40 pixels of noise; `change` sets some afterwards.
std::string make_input(const test::TempFolder& folder, Imf::PixelType type,
                       const std::function<void(test::Picture&)>& change) {
  test::Picture picture = test::blank(70, 40, {-5, 100});
  test::add_rgb_noise(picture, type);
  change(picture);
  test::write_scanlines(folder / "in.exr", picture);
  return folder / "in.exr";
}

void set(test::Picture& picture, const char* channel, int x, int y, double v) {
  picture.planes.at(channel).set(picture.index(x, y), v);
}

/// Three bad pixels; the first in reading order is 9,3 from the upper left corner.
std::string nonfinite_input(const test::TempFolder& folder, Imf::PixelType type = Imf::HALF) {
  return make_input(folder, type, [](test::Picture& p) {
    set(p, "G", 12, 39, kNan);
    set(p, "B", 9, 3, kInf);
    set(p, "R", 9, 3, kNan);
    set(p, "R", 3, 4, -kInf);
  });
}

std::vector<std::string> band_names(const test::Picture& picture) {
  std::vector<std::string> out;
  for (const auto& [name, plane] : picture.planes) {
    if (name.starts_with("T.")) out.push_back(name);
  }
  return out;
}

TEST(InvalidPixels, StopNamesTheFirstAndTheNumberWhateverTheThreads) {
  const test::TempFolder folder;
  const std::string input = nonfinite_input(folder);
  for (const int threads : {1, 2, 7}) {
    for (const auto kind : {CompressionKind::kNone, CompressionKind::kZip, CompressionKind::kDwab}) {
      UpsampleImageOptions options;
      options.threads = threads;
      options.compression = {kind, -1};
      const auto report = upsample_image(input, folder / "out.exr", options);
      ASSERT_FALSE(report);
      EXPECT_EQ(report.error().code, ErrorCode::kNonFinite);
      EXPECT_THAT(report.error().message, testing::HasSubstr(input));
      EXPECT_THAT(report.error().message, testing::HasSubstr("3 non-finite pixels"));
      EXPECT_THAT(report.error().message, testing::HasSubstr("first at 9,3;"));
      EXPECT_EQ(folder.names(), std::vector<std::string>{"in.exr"});
    }
  }
}

TEST(InvalidPixels, ZeroMakesThemBlackAndCountsThem) {
  const test::TempFolder folder;
  for (const auto type : {Imf::HALF, Imf::FLOAT}) {
    for (const auto pixel : {SampleType::kHalf, SampleType::kFloat}) {
      UpsampleImageOptions options;
      options.nonfinite = NonFinite::kZero;
      options.pixel = pixel;
      const auto report = upsample_image(nonfinite_input(folder, type), folder / "out.exr", options);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_EQ(report->nonfinite_pixels, 3U);
      EXPECT_EQ(report->clamped_pixels, 0U);
      const test::Picture out = test::read_picture(folder / "out.exr");
      ASSERT_EQ(band_names(out).size(), 60U);
      for (const std::string& name : band_names(out)) {
        for (const auto& [x, y] : {std::pair{9, 3}, {3, 4}, {12, 39}})
          EXPECT_EQ(out.at(name, x, y), 0.0) << name;
        EXPECT_GT(out.at(name, 10, 3), 0.0) << name;
      }
    }
  }
}

TEST(InvalidPixels, ProjectionFollowsTheSameRules) {
  const test::TempFolder folder;
  test::Picture picture = test::blank(70, 40);
  for (const char* name : {"T.450nm", "T.550nm", "T.650nm"}) {
    picture.add(name, Imf::HALF, [](int x, int y) { return 0.25 + 0.5 * test::noise(x, y, 3); });
  }
  set(picture, "T.550nm", 69, 2, kNan);
  set(picture, "T.650nm", 0, 3, kInf);
  test::write_scanlines(folder / "in.exr", picture);
  ProjectImageOptions options;
  const auto stopped = project_image(folder / "in.exr", folder / "out.exr", options);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kNonFinite);
  EXPECT_THAT(stopped.error().message, testing::HasSubstr("2 non-finite pixels, the first at 69,2;"));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"in.exr"});
  options.nonfinite = NonFinite::kZero;
  const auto report = project_image(folder / "in.exr", folder / "out.exr", options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->nonfinite_pixels, 2U);
  const test::Picture out = test::read_picture(folder / "out.exr");
  for (const char* name : {"R", "G", "B"}) {
    EXPECT_EQ(out.at(name, 69, 2), 0.0);
    EXPECT_EQ(out.at(name, 0, 3), 0.0);
  }
  EXPECT_GT(out.at("G", 1, 3), 0.0);
}

TEST(InvalidPixels, NegativeOnesAreClippedKeptOrRefused) {
  const test::TempFolder folder;
  const std::string input = make_input(folder, Imf::HALF, [](test::Picture& p) {
    for (const char* name : {"R", "G", "B"}) set(p, name, 5, 1, -0.5);
    set(p, "R", 6, 1, -0.25);
    set(p, "G", 6, 1, 0);
    set(p, "B", 6, 1, 0);
  });
  UpsampleImageOptions options;
  const auto clipped = upsample_image(input, folder / "clip.exr", options);
  ASSERT_TRUE(clipped) << clipped.error().message;
  EXPECT_EQ(clipped->negative_pixels, 2U);
  const test::Picture clip = test::read_picture(folder / "clip.exr");
  options.negative = NegativeInput::kKeep;
  const auto kept = upsample_image(input, folder / "keep.exr", options);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(kept->negative_pixels, 2U);
  const test::Picture keep = test::read_picture(folder / "keep.exr");
  for (const std::string& name : band_names(clip)) {
    EXPECT_EQ(clip.at(name, 5, 1), 0.0) << name;
    EXPECT_EQ(clip.at(name, 6, 1), 0.0) << name;
    // Grey of -0.5: a flat spectrum, but for the 0.94 and the ripples of the white basis.
    EXPECT_NEAR(keep.at(name, 5, 1), -0.5, 0.06) << name;
    EXPECT_EQ(clip.at(name, 20, 20) >= 0, true) << name;
  }
  options.negative = NegativeInput::kError;
  const auto stopped = upsample_image(input, folder / "stop.exr", options);
  ASSERT_FALSE(stopped);
  EXPECT_THAT(stopped.error().message, testing::HasSubstr("2 negative pixels, the first at 5,1;"));
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"clip.exr", "in.exr", "keep.exr"}));
}

TEST(InvalidPixels, NegativeZeroIsNotNegative) {
  const test::TempFolder folder;
  const std::string input = make_input(folder, Imf::HALF, [](test::Picture& p) { set(p, "R", 5, 1, -0.0); });
  UpsampleImageOptions options;
  options.negative = NegativeInput::kError;
  const auto report = upsample_image(input, folder / "out.exr", options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->negative_pixels, 0U);
}

TEST(InvalidPixels, SamplesBeyondHalfAreLimitedAndCounted) {
  const test::TempFolder folder;
  const std::string input = make_input(folder, Imf::FLOAT, [](test::Picture& p) {
    for (const char* name : {"R", "G", "B"}) {
      set(p, name, 1, 0, 1e6);
      set(p, name, 2, 0, 1e30);
      set(p, name, 3, 0, 6e4);
    }
  });
  UpsampleImageOptions options;
  const auto report = upsample_image(input, folder / "out.exr", options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->clamped_pixels, 2U);
  const test::Picture out = test::read_picture(folder / "out.exr");
  for (const std::string& name : band_names(out)) {
    EXPECT_EQ(out.at(name, 1, 0), 65504.0) << name;
    EXPECT_EQ(out.at(name, 2, 0), 65504.0) << name;
    EXPECT_GT(out.at(name, 3, 0), 5e4) << name;
  }
  options.pixel = SampleType::kFloat;
  const auto whole = upsample_image(input, folder / "out.exr", options);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->clamped_pixels, 0U);
  EXPECT_GT(test::read_picture(folder / "out.exr").at("T.552,500000nm", 2, 0), 9e29);
}

TEST(InvalidPixels, KeptNegativeSamplesBeyondHalfAreLimitedAndCounted) {
  const test::TempFolder folder;
  const std::string input = make_input(folder, Imf::FLOAT, [](test::Picture& p) {
    for (const char* name : {"R", "G", "B"}) set(p, name, 1, 0, -1e6);
  });
  UpsampleImageOptions options;
  options.negative = NegativeInput::kKeep;
  const auto report = upsample_image(input, folder / "out.exr", options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->clamped_pixels, 1U);
  EXPECT_EQ(test::read_picture(folder / "out.exr").at("T.552,500000nm", 1, 0), -65504.0);
}

TEST(InvalidPixels, ProjectedColorsBeyondHalfAreLimitedAndCounted) {
  const test::TempFolder folder;
  test::Picture picture = test::blank(70, 3);
  for (const char* name : {"T.450nm", "T.550nm", "T.650nm"}) {
    picture.add(name, Imf::FLOAT, [](int x, int y) { return x == 4 && y == 1 ? 1e6 : 0.5; });
  }
  test::write_scanlines(folder / "in.exr", picture);
  ProjectImageOptions options;
  options.target = ColorTarget::kLuminance;
  const auto report = project_image(folder / "in.exr", folder / "out.exr", options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->clamped_pixels, 1U);
  EXPECT_EQ(test::read_picture(folder / "out.exr").at("Y", 4, 1), 65504.0);
  options.target = ColorTarget::kSrgb;
  const auto srgb = project_image(folder / "in.exr", folder / "out.exr", options);
  ASSERT_TRUE(srgb) << srgb.error().message;
  EXPECT_EQ(srgb->clamped_pixels, 1U) << "pixels are counted, not their components";
}

TEST(InvalidPixels, PixelsOverOneAreCounted) {
  const test::TempFolder folder;
  const std::string input = make_input(folder, Imf::HALF, [](test::Picture& p) {
    set(p, "R", 1, 0, 1.5);
    set(p, "G", 1, 0, 1.5);
    set(p, "B", 30, 30, 2);
  });
  const auto report = upsample_image(input, folder / "out.exr", test::kUpsample);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->over_one_pixels, 2U);
}

TEST(InvalidPixels, CancelledConversionLeavesNoOutput) {
  const test::TempFolder folder;
  const std::string input = make_input(folder, Imf::HALF, [](test::Picture&) {});
  for (const std::uint64_t allowed : {0U, 1U, 2U}) {
    UpsampleImageOptions options;
    std::uint64_t calls = 0;
    options.progress = [&](const Progress& progress) {
      EXPECT_LE(progress.pixels_done, progress.pixels);
      EXPECT_EQ(progress.pixels, 70U * 40U);
      return calls++ < allowed;
    };
    // 40 lines are three chunks: the last call comes when all is encoded.
    const auto report = upsample_image(input, folder / "out.exr", options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::kCancelled);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"in.exr"});
  }
}

}  // namespace
}  // namespace spectile
