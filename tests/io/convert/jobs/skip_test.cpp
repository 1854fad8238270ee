// Work that upsample_image skips changes no byte of its file, and is counted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
using Value = std::function<double(int x, int y, int channel)>;

test::Picture picture_of(int width, int height, Imf::PixelType type, const Value& value) {
  test::Picture out = test::blank(width, height);
  int channel = 0;
  for (const char* name : {"R", "G", "B"}) {
    const int c = channel++;
    out.add(name, type, [&](int x, int y) { return value(x, y, c); });
  }
  return out;
}

/// Noise of 8 bits, and few colours of it.
double eight_bits(int x, int y, int channel) {
  return std::floor(test::noise(x % 23, y % 5, channel) * 256) / 255;
}

class Skipping : public testing::Test {
 protected:
  /// Converts with and without skipping, on one thread and on four, and compares the files. Returns the
  /// report of skipping.
  ImageReport check(const std::string& input, UpsampleImageOptions options) {
    std::optional<ImageReport> plain;
    std::string bytes;
    ImageReport last;
    for (const bool skip : {false, true}) {
      for (const int threads : {1, 4}) {
        options.skip = skip;
        options.threads = threads;
        const auto report = upsample_image(input, folder_ / "out.exr", options);
        EXPECT_TRUE(report) << report.error().message;
        if (!report) return {};
        const std::string got = test::file_bytes(folder_ / "out.exr");
        if (!plain) {
          plain = *report;
          bytes = got;
        }
        EXPECT_TRUE(got == bytes) << "skip " << skip << ", " << threads << " threads";
        EXPECT_EQ(report->nonfinite_pixels, plain->nonfinite_pixels);
        EXPECT_EQ(report->negative_pixels, plain->negative_pixels);
        EXPECT_EQ(report->over_one_pixels, plain->over_one_pixels);
        EXPECT_EQ(report->out_of_gamut_pixels, plain->out_of_gamut_pixels);
        EXPECT_EQ(report->clamped_pixels, plain->clamped_pixels);
        EXPECT_EQ(report->notes, plain->notes);
        if (!skip) expect_nothing(report->skipped);
        if (skip && threads == 4) expect_same(report->skipped, last.skipped);
        last = *report;
      }
    }
    return last;
  }

  ImageReport check(test::Picture picture, const UpsampleImageOptions& options) {
    test::write_scanlines(folder_ / "in.exr", picture);
    return check(folder_ / "in.exr", options);
  }

  static void expect_nothing(const SkipStats& s) {
    EXPECT_EQ(s.masked_pixels + s.black_pixels + s.constant_pixels + s.chunks + s.chunks_reused, 0U);
    EXPECT_EQ(s.colors_looked_up + s.colors_solved, 0U);
    EXPECT_EQ(s.core_seconds_saved, 0);
  }
  static void expect_same(const SkipStats& a, const SkipStats& b) {
    EXPECT_EQ(a.masked_pixels, b.masked_pixels);
    EXPECT_EQ(a.black_pixels, b.black_pixels);
    EXPECT_EQ(a.constant_pixels, b.constant_pixels);
    EXPECT_EQ(a.chunks, b.chunks);
    EXPECT_EQ(a.chunks_reused, b.chunks_reused);
  }

  const test::TempFolder folder_;
};

/// Pictures of every kind, by name.
std::vector<std::pair<std::string, test::Picture>> kinds() {
  std::vector<std::pair<std::string, test::Picture>> out;
  const auto add = [&](const char* name, int width, int height, Imf::PixelType type, const Value& value) {
    out.emplace_back(name, picture_of(width, height, type, value));
  };
  add("black", 200, 70, Imf::HALF, [](int, int, int) { return 0.0; });
  add("constant", 150, 40, Imf::FLOAT, [](int, int, int c) { return 0.1 + 0.3 * c; });
  add("blocks", 450, 60, Imf::HALF,
      [](int x, int y, int c) { return (x / 64 + y / 16) % 3 * 0.2 + (x > 300 ? test::noise(x, y, c) : 0); });
  add("rows of tiles", 130, 96, Imf::FLOAT, [](int x, int y, int c) { return test::noise(x, y % 32, c); });
  add("8 bits", 333, 50, Imf::FLOAT, eight_bits);
  add("beyond the range", 201, 33, Imf::FLOAT, [](int x, int y, int c) {
    return std::exp2(40 * test::noise(x % 100, y, c) - 20) * (test::noise(x, y, 4) < 0.1 ? -1 : 1);
  });
  add("not finite", 100, 40, Imf::HALF,
      [](int x, int y, int c) { return (x * y) % 37 == 5 && c == 1 ? kNaN : test::noise(x / 9, y, c); });
  add("numbers", 90, 20, Imf::UINT, [](int x, int y, int) { return (x / 40 + y) % 3; });
  test::Picture alpha = picture_of(300, 50, Imf::HALF,
                                   [](int x, int y, int c) { return x == 17 ? kNaN : test::noise(x, y, c); });
  alpha.add("A", Imf::HALF, [](int x, int y) { return x < 128 || y > 30 ? 0.0 : 0.5; });
  out.emplace_back("alpha 0 with colour", std::move(alpha));
  return out;
}

TEST_F(Skipping, EveryKindOfImageGivesTheSameBytes) {
  for (auto& [name, picture] : kinds()) {
    for (const Method method : {kDefaultMethod, Method::kSigmoid, Method::kTetrahedral}) {
      SCOPED_TRACE(name + ", " + std::string(to_string(method)));
      UpsampleImageOptions options;
      options.method = method;
      options.nonfinite = NonFinite::kZero;
      options.bands = *Bands::uniform(400, 700, 20);
      check(picture, options);
      options.store = Store::kCoefficients;
      check(picture, options);
    }
  }
}

TEST_F(Skipping, EveryMethodQuantityAndPolicyGivesTheSameBytes) {
  for (auto& [name, picture] : kinds()) {
    if (name != "beyond the range" && name != "blocks") continue;
    for (const std::string& method : method_names()) {
      for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
        for (const GamutPolicy policy : {GamutPolicy::kClip, GamutPolicy::kKeep}) {
          SCOPED_TRACE(name + ", " + method + ", " + std::string(to_string(quantity)));
          UpsampleImageOptions options;
          options.method = *parse_method(method);
          options.quantity = quantity;
          options.out_of_gamut = policy;
          options.pixel = policy == GamutPolicy::kKeep ? SampleType::kFloat : SampleType::kHalf;
          options.bands = *Bands::uniform(400, 700, 25);
          check(picture, options);
        }
      }
    }
  }
}

TEST_F(Skipping, EveryCompressionGivesTheSameBytes) {
  for (const char* compression : {"none", "rle", "zips", "zip", "zip:4", "piz", "pxr24", "b44", "dwaa"}) {
    SCOPED_TRACE(compression);
    UpsampleImageOptions options;
    options.bands = *Bands::uniform(400, 700, 25);
    options.compression = *Compression::parse(compression);
    check(picture_of(130, 96, Imf::HALF,
                     [](int x, int y, int c) { return x < 64 ? 0 : test::noise(x, y % 32, c); }),
          options);
  }
}

TEST_F(Skipping, RealImagesGiveTheSameBytes) {
  SPECTILE_NEEDS_IMAGES("rgb");
  for (const std::string& input : test::shared_files("rgb")) {
    if (input.find("GoldenGate") == std::string::npos &&
        input.find("Beachball_single") == std::string::npos &&
        input.find("WideColorGamut") == std::string::npos) {
      continue;
    }
    for (const Method method : {kDefaultMethod, Method::kSigmoid, Method::kTetrahedral}) {
      SCOPED_TRACE(input);
      UpsampleImageOptions options;
      options.method = method;
      options.nonfinite = NonFinite::kZero;
      options.bands = *Bands::uniform(400, 700, 25);
      check(input, options);
    }
  }
}

TEST_F(Skipping, CountsPixelsAndChunks) {
  // Two chunks of ZIP alike, and one that is not: on the left a black block, then one of one colour, and one
  // that has a single black pixel; 8 pixels of one colour are a block, too.
  const auto value = [](int x, int y, int c) {
    if (x < 64) return 0.0;
    if (x < 128 || x >= 192) return 0.25;
    return x == 150 ? 0.0 : 0.5 + 0.5 * test::noise(x, y % 16 + (y < 32 ? 0 : 100), c);
  };
  const SkipStats s = check(picture_of(200, 48, Imf::FLOAT, value), {}).skipped;
  EXPECT_EQ(s.black_pixels, 65U * 48);
  EXPECT_EQ(s.constant_pixels, 72U * 48);
  EXPECT_EQ(s.masked_pixels, 0U);
  EXPECT_EQ(s.chunks, 3U);
  EXPECT_EQ(s.chunks_reused, 1U);
  EXPECT_EQ(s.colors_looked_up, 0U) << "bases need no table";
}

TEST_F(Skipping, LastChunkOfFewerLinesIsAnother) {
  // 16 + 16 + 8 lines.
  const SkipStats s = check(picture_of(70, 40, Imf::HALF, [](int, int, int) { return 0.0; }), {}).skipped;
  EXPECT_EQ(s.chunks, 3U);
  EXPECT_EQ(s.chunks_reused, 1U);
  EXPECT_EQ(s.black_pixels, 70U * 40);
}

TEST_F(Skipping, ChannelsThatPassThroughTellChunksApart) {
  test::Picture picture = picture_of(70, 48, Imf::HALF, [](int, int, int) { return 0.0; });
  picture.add("Z", Imf::FLOAT, [](int x, int y) { return y == 20 && x == 69 ? 1 : 0; });
  EXPECT_EQ(check(picture, {}).skipped.chunks_reused, 1U);
  const test::Picture got = test::read_picture(folder_ / "out.exr");
  EXPECT_TRUE(got.planes.at("Z") == picture.planes.at("Z"));
}

TEST_F(Skipping, EachColourIsSolvedOnce) {
  UpsampleImageOptions options;
  options.method = Method::kSigmoid;
  options.bands = *Bands::uniform(400, 700, 25);
  const auto value = [](int x, int y, int c) { return 0.1 + 0.05 * ((x + 3 * (y % 16) + c) % 11); };
  const SkipStats s = check(picture_of(320, 64, Imf::FLOAT, value), options).skipped;
  EXPECT_EQ(s.colors_solved, 11U);
  EXPECT_EQ(s.chunks_reused, 3U);
  EXPECT_EQ(s.colors_looked_up, 320U * 16) << "those of reused chunks are not looked up again";
}

TEST_F(Skipping, CountsOfAReusedChunkHaveTheirOwnPlace) {
  UpsampleImageOptions options;
  options.nonfinite = NonFinite::kZero;
  const auto value = [](int x, int y, int) { return y % 16 == 3 && x == 5 ? kNaN : 0.5; };
  const ImageReport report = check(picture_of(70, 64, Imf::HALF, value), options);
  EXPECT_EQ(report.nonfinite_pixels, 4U);
  EXPECT_EQ(report.skipped.chunks_reused, 3U);
  // A chunk that may not be converted stops the conversion wherever it comes.
  for (const bool skip : {true, false}) {
    options = {};
    options.skip = skip;
    const auto stopped = upsample_image(folder_ / "in.exr", folder_ / "none.exr", options);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::kNonFinite);
    EXPECT_THAT(stopped.error().message, testing::HasSubstr("4 non-finite pixels, the first at 5,3"));
  }
}

TEST_F(Skipping, TablesThatAreNoUseGiveUp) {
  UpsampleImageOptions options;
  options.method = Method::kSigmoid;
  options.bands = *Bands::uniform(400, 700, 25);
  const SkipStats s =
      check(picture_of(1024, 300, Imf::FLOAT, [](int x, int y, int c) { return test::noise(x, y, c); }),
            options)
          .skipped;
  EXPECT_LT(s.colors_looked_up, 1024U * 300 / 2);
}

}  // namespace
}  // namespace spectile
