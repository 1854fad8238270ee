// Masked pixels: black, and everything else as it was.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

class PixelMasks : public testing::Test {
 protected:
  PixelMasks() : picture_(test::blank(100, 40, {-3, 5})) {
    test::add_rgb_noise(picture_, Imf::HALF);
    options_.bands = *Bands::uniform(400, 700, 25);
    options_.input_space = RgbSpace();  // stated, so that notes are of masks only
    options_.masking = Masking::kAlpha;
  }

  /// True if every band is 0 at a pixel.
  static bool black(const test::Picture& got, int x, int y) {
    int zeros = 0;
    int bands = 0;
    for (const auto& [name, plane] : got.planes) {
      if (!name.starts_with("T.")) continue;
      ++bands;
      zeros += plane.at(got.index(x, y)) == 0 && !std::signbit(plane.at(got.index(x, y))) ? 1 : 0;
    }
    EXPECT_EQ(bands, 12);
    return zeros == bands;
  }

  /// Converts, and checks that the masked pixels are black and those beside them as without a mask.
  ImageReport expect_masked(const std::function<bool(int, int)>& masked) {
    test::write_scanlines(folder_ / "in.exr", picture_);
    UpsampleImageOptions bare = options_;
    bare.masking = Masking::kNone;
    bare.mask = "";
    bare.nonfinite = NonFinite::kZero;
    EXPECT_TRUE(upsample_image(folder_ / "in.exr", folder_ / "bare.exr", bare));
    const auto report = upsample_image(folder_ / "in.exr", folder_ / "out.exr", options_);
    EXPECT_TRUE(report) << report.error().message;
    if (!report) return {};
    const test::Picture without = test::read_picture(folder_ / "bare.exr");
    const test::Picture got = test::read_picture(folder_ / "out.exr");
    for (const auto& [name, plane] : picture_.planes) {
      const bool color = name == "R" || name == "G" || name == "B";
      for (int y = 0; color && y < 40; ++y) {
        for (int x = 0; x < 100; ++x) {
          const double v = got.at(name, x, y);
          EXPECT_TRUE(masked(x, y) ? v == 0 && !std::signbit(v) : v == picture_.at(name, x, y))
              << name << " at " << x << ", " << y;
        }
      }
      EXPECT_TRUE(color || got.planes.at(name) == plane) << name << " passes through";
    }
    std::uint64_t count = 0;
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 100; ++x) {
        count += masked(x, y) ? 1 : 0;
        EXPECT_EQ(black(got, x, y), masked(x, y)) << x << ", " << y;
        for (const auto& [name, plane] : got.planes) {
          EXPECT_TRUE(masked(x, y) || got.at(name, x, y) == without.at(name, x, y)) << name;
        }
      }
    }
    EXPECT_EQ(report->skipped.masked_pixels, count);
    return *report;
  }

  /// Writes the picture's mask and asks for it.
  void mask_by(test::Picture mask) {
    test::write_scanlines(folder_ / "mask.exr", mask);
    options_.masking = Masking::kFile;
    options_.mask = folder_ / "mask.exr";
  }

  Error refused() {
    test::write_scanlines(folder_ / "in.exr", picture_);
    const auto report = upsample_image(folder_ / "in.exr", folder_ / "refused.exr", options_);
    EXPECT_FALSE(report);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused.exr"));
    return report ? Error{} : report.error();
  }

  const test::TempFolder folder_;
  test::Picture picture_;
  UpsampleImageOptions options_;
};

bool corner(int x, int y) {
  return x < 70 && y < 20;
}

TEST_F(PixelMasks, AlphaZeroIsBlackInEveryType) {
  for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
    picture_.add("A", type, [](int x, int y) { return corner(x, y) ? 0 : 1; });
    const ImageReport report = expect_masked(corner);
    EXPECT_THAT(report.notes, testing::ElementsAre(HasSubstr("1400 pixels of alpha 0 with a colour")));
    EXPECT_THAT(report.notes[0], HasSubstr("without --mask alpha they keep it"));
  }
}

TEST_F(PixelMasks, MinusZeroIsZero) {
  picture_.add("A", Imf::FLOAT, [](int x, int y) { return corner(x, y) ? -0.0 : -1; });
  expect_masked(corner);
}

TEST_F(PixelMasks, NoneKeepsThemAsByDefault) {
  EXPECT_EQ(UpsampleImageOptions().masking, Masking::kNone);
  picture_.add("A", Imf::HALF, [](int x, int y) { return corner(x, y) ? 0 : 1; });
  options_.masking = Masking::kNone;
  EXPECT_TRUE(expect_masked([](int, int) { return false; }).notes.empty());
}

TEST_F(PixelMasks, BlackOfAlphaZeroIsNotMentioned) {
  for (const char* name : {"R", "G", "B"}) {
    picture_.add(name, Imf::HALF, [](int x, int y) { return corner(x, y) ? 0 : 0.5; });
  }
  picture_.add("A", Imf::HALF, [](int x, int y) { return corner(x, y) ? 0 : 1; });
  EXPECT_TRUE(expect_masked(corner).notes.empty());
}

TEST_F(PixelMasks, MaskedPixelsMayHoldAnything) {
  picture_.add("G", Imf::HALF, [](int x, int y) {
    return corner(x, y) ? (x % 2 == 0 ? std::numeric_limits<double>::quiet_NaN() : -3) : 0.5;
  });
  picture_.add("A", Imf::HALF, [](int x, int y) { return corner(x, y) ? 0 : 1; });
  options_.negative = NegativeInput::kError;
  test::write_scanlines(folder_ / "in.exr", picture_);
  const auto report = upsample_image(folder_ / "in.exr", folder_ / "out.exr", options_);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->nonfinite_pixels, 0U);
  EXPECT_EQ(report->negative_pixels, 0U);
  EXPECT_TRUE(black(test::read_picture(folder_ / "out.exr"), 0, 0));
}

TEST_F(PixelMasks, CoefficientsAreThoseOfBlack) {
  picture_.add("A", Imf::HALF, [](int x, int y) { return corner(x, y) ? 0 : 1; });
  test::write_scanlines(folder_ / "in.exr", picture_);
  options_.store = Store::kCoefficients;
  for (const Method method : {kDefaultMethod, Method::kSigmoid, Method::kTetrahedral}) {
    options_.method = method;
    ASSERT_TRUE(upsample_image(folder_ / "in.exr", folder_ / "c.exr", options_));
    ExpandImageOptions expand;
    ASSERT_TRUE(expand_image(folder_ / "c.exr", folder_ / "expanded.exr", expand));
    const test::Picture got = test::read_picture(folder_ / "expanded.exr");
    EXPECT_TRUE(black(got, 69, 19));
    EXPECT_FALSE(black(got, 70, 19));
  }
}

TEST_F(PixelMasks, FileOfOtherWindowAndTypeMasks) {
  picture_.add("A", Imf::HALF, [](int x, int) { return x < 50 ? 0 : 1; });
  for (const char* name : {"A", "Y", "R"}) {
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
      test::Picture mask = test::blank(100, 40, {11, -7});
      mask.add(name, type, [](int x, int y) { return corner(x, y) ? 0 : 3; });
      // Less than A, Y, R in this order.
      mask.add("Z", Imf::FLOAT, [](int, int) { return 0; });
      if (name[0] != 'R') mask.add("R", Imf::HALF, [](int, int) { return 0; });
      mask_by(mask);
      // The image's own alpha does not matter; where another channel could be the mask, the one taken is
      // said.
      const auto notes = expect_masked(corner).notes;
      if (name[0] == 'R') {
        EXPECT_TRUE(notes.empty());
      } else {
        EXPECT_THAT(notes, testing::ElementsAre(HasSubstr(fmt::format("channel {} of ", name))));
      }
    }
  }
}

TEST_F(PixelMasks, MasksTellChunksApart) {
  for (const char* name : {"R", "G", "B"}) picture_.add(name, Imf::HALF, [](int, int) { return 0.5; });
  test::Picture mask = test::blank(100, 40);
  mask.add("A", Imf::HALF, [](int x, int y) { return x == 99 && y == 17 ? 0 : 1; });
  mask_by(mask);
  EXPECT_EQ(expect_masked([](int x, int y) { return x == 99 && y == 17; }).skipped.chunks_reused, 0U);
}

TEST_F(PixelMasks, MasksThatDoNotFitAreErrors) {
  test::Picture small = test::blank(99, 40);
  small.add("A", Imf::HALF, [](int, int) { return 1; });
  mask_by(small);
  EXPECT_THAT(refused().message, HasSubstr("mask.exr: is 99 x 40, the image that it masks 100 x 40"));

  test::Picture other = test::blank(100, 40);
  other.add("Z", Imf::HALF, [](int, int) { return 1; });
  mask_by(other);
  EXPECT_THAT(refused().message, HasSubstr("mask.exr: has no channel A, Y or R to be a mask"));

  options_.mask = folder_ / "missing.exr";
  EXPECT_EQ(refused().code, ErrorCode::kBadFile);
  options_.mask = "";
  EXPECT_EQ(refused().code, ErrorCode::kBadArgument);
  options_.mask = folder_ / "mask.exr";
  options_.masking = Masking::kAlpha;
  EXPECT_EQ(refused().code, ErrorCode::kBadArgument);
}

TEST_F(PixelMasks, MaskMayNotBeTheOutput) {
  test::Picture mask = test::blank(100, 40);
  mask.add("A", Imf::HALF, [](int, int) { return 1; });
  mask_by(mask);
  test::write_scanlines(folder_ / "in.exr", picture_);
  const auto report = upsample_image(folder_ / "in.exr", folder_ / "mask.exr", options_);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
}

TEST_F(PixelMasks, ALayersAlphaIsItsOwn) {
  test::add_rgb_noise(picture_, Imf::HALF, 1, "hat.");
  picture_.add("A", Imf::HALF, [](int, int) { return 0; });
  picture_.add("hat.A", Imf::HALF, [](int x, int y) { return corner(x, y) ? 0 : 1; });
  test::write_scanlines(folder_ / "in.exr", picture_);
  options_.channels.layer = "hat";
  const auto report = upsample_image(folder_ / "in.exr", folder_ / "out.exr", options_);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->skipped.masked_pixels, 1400U);
}

}  // namespace
}  // namespace spectile
