// Mip levels as files: compressions, integers, memory, what is refused, attributes, files cut short.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <spectile/image/image.hpp>
#include <spectile/image/settings.hpp>

#include "tests/io/convert/frame/mipmap_support.hpp"

namespace spectile {
namespace {

using test::kMixing;
using test::Mipmap;
using test::Picture;
using test::Plane;
using test::read_levels;
using testing::HasSubstr;

TEST_F(Mipmap, WorkWithEveryCompression) {
  make(131, 67);
  UpsampleImageOptions options;
  options.bands = *Bands::uniform(400, 700, 25);
  options.mipmap = true;
  options.compression = *Compression::parse("none");
  ASSERT_TRUE(upsample_image(in_, folder_ / "none.exr", options));
  const auto expected = read_levels(folder_ / "none.exr");
  for (const char* name : {"rle", "zips", "zip", "zip:4", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    SCOPED_TRACE(name);
    options.compression = *Compression::parse(name);
    ASSERT_TRUE(upsample_image(in_, folder_ / "out.exr", options));
    const auto got = read_levels(folder_ / "out.exr");
    const std::string kind = name;
    const bool loses = kind.starts_with("b44") || kind.starts_with("dwa");
    double first_error = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      double error = 0;
      for (const auto& [channel, plane] : got[i].planes) {
        const Plane& exact = expected[i].planes.at(channel);
        if (!loses && (kind != "pxr24" || plane.type != Imf::FLOAT)) {
          EXPECT_TRUE(plane == exact) << channel << " of level " << i;
        }
        for (std::size_t p = 0; plane.type == Imf::HALF && p < got[i].pixels(); ++p) {
          error = std::max(error, std::abs(plane.at(p) - exact.at(p)));
        }
      }
      // The loss of noise is a loss of its averages too, but no more.
      if (i == 0) first_error = error;
      EXPECT_LE(error, first_error) << "level " << i;
    }
  }
}

TEST_F(Mipmap, IntegersAreThoseNearestToTheCentre) {
  make(37, 23);
  UpsampleImageOptions options;
  options.mipmap = true;
  ASSERT_TRUE(upsample_image(in_, folder_ / "out.exr", options));
  for (const Picture& level : read_levels(folder_ / "out.exr")) {
    for (int y = 0; y < level.height(); ++y) {
      for (int x = 0; x < level.width(); ++x) {
        const auto from = [](int image, int side, int at) {
          return static_cast<int>(std::floor((at + 0.5) * image / side + 1e-9));
        };
        EXPECT_EQ(level.at("id", x, y), 1000 * from(23, level.height(), y) + from(37, level.width(), x));
      }
    }
  }
}

TEST_F(Mipmap, ThatDoNotFitIntoMemoryAreTheSame) {
  constexpr int kWidth = 401;
  constexpr int kHeight = 641;
  make(kWidth, kHeight);
  UpsampleImageOptions options;
  options.method = Method::kSigmoid;
  options.bands = *Bands::uniform(400, 700, 1.25);
  options.compression = *Compression::parse("none");
  options.mipmap = true;
  ASSERT_TRUE(upsample_image(in_, folder_ / "out.exr", options));
  const std::set<std::string> some = {
      "T.400,625000nm", "T.550,625000nm", "T.699,375000nm", "A", "Z", "R", "id"};
  auto levels = read_levels(folder_ / "out.exr", {64, 64}, some);
  ASSERT_EQ(levels[1].planes.size(), some.size());
  levels.resize(4);
  // The same samples, at these centres only.
  options.mipmap = false;
  options.store = Store::kCoefficients;
  ASSERT_TRUE(upsample_image(in_, folder_ / "c.exr", options));
  ExpandImageOptions expand;
  expand.pixel = SampleType::kFloat;
  expand.bands = *Bands::from_centres(std::vector<double>{400.625, 550.625, 699.375});
  ASSERT_TRUE(expand_image(folder_ / "c.exr", folder_ / "float.exr", expand));
  check_averages(levels, test::read_picture(folder_ / "float.exr"), 0);
  for (const Picture& level : levels) {
    for (int y = 0; y < level.height(); ++y) {
      const int from = (2 * y + 1) * kHeight / (2 * level.height());
      EXPECT_EQ(std::floor(level.at("id", 0, y) / 1000), from);
    }
  }
}

TEST_F(Mipmap, CoefficientsHaveSomeOnlyWhereTheyAreLinear) {
  make(37, 23);
  for (const std::string& name : method_names()) {
    SCOPED_TRACE(name);
    UpsampleImageOptions options;
    options.bands = *Bands::uniform(400, 700, 25);
    options.method = *parse_method(name);
    options.store = Store::kCoefficients;
    options.mipmap = true;
    const auto report = upsample_image(in_, folder_ / (name + ".exr"), options);
    if (options.method == Method::kMallett) {
      ASSERT_TRUE(report) << report.error().message;
      continue;
    }
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
    EXPECT_THAT(report.error().message, HasSubstr("coefficients of " + name + " have no mip levels"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / (name + ".exr")));
  }
  // Those of averages are averages.
  UpsampleImageOptions options;
  options.bands = *Bands::uniform(400, 700, 25);
  options.method = Method::kMallett;
  options.store = Store::kCoefficients;
  check(converter(in_, options, &upsample_image), options, 0);
}

TEST_F(Mipmap, StopsAtBadPixelsAndOnRequest) {
  Picture picture = test::blank(200, 130);
  test::add_rgb_noise(picture, Imf::FLOAT);
  picture.planes.at("G").set(picture.index(150, 70), std::nan(""));
  test::write_scanlines(in_, picture);
  UpsampleImageOptions options;
  options.mipmap = true;
  const auto bad = upsample_image(in_, folder_ / "out.exr", options);
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("1 non-finite pixel, the first at 150,70"));
  options.nonfinite = NonFinite::kZero;
  Progress last;
  options.progress = [&](const Progress& progress) {
    EXPECT_LE(last.pixels_done, progress.pixels_done);
    last = progress;
    return true;
  };
  const auto good = upsample_image(in_, folder_ / "out.exr", options);
  ASSERT_TRUE(good) << good.error().message;
  EXPECT_EQ(good->nonfinite_pixels, 1U);
  EXPECT_EQ(last.pixels_done, last.pixels);
  std::uint64_t pixels = 0;
  for (const Picture& level : read_levels(folder_ / "out.exr")) pixels += level.pixels();
  EXPECT_EQ(last.pixels, pixels);
  std::filesystem::remove(folder_ / "out.exr");
  options.progress = [](const Progress& progress) { return progress.pixels_done <= 200 * 130; };
  const auto cancelled = upsample_image(in_, folder_ / "out.exr", options);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
}

TEST_F(Mipmap, AttributesThatDescribeTheTexturePassThrough) {
  make(37, 23);
  UpsampleImageOptions options;
  options.mipmap = true;
  ASSERT_TRUE(upsample_image(in_, folder_ / "out.exr", options));
  const Imf::TiledInputFile file((folder_ / "out.exr").c_str());
  EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("wrapmodes").value(), "periodic,periodic");
}

TEST_F(Mipmap, FilesThatWereCutAreNotUpToDate) {
  make(200, 130);
  UpsampleImageOptions options;
  options.mipmap = true;
  const std::string out = folder_ / "out.exr";
  ASSERT_TRUE(upsample_image(in_, out, options));
  const std::vector<std::string> from = {in_};
  const auto fresh = [&] {
    std::filesystem::last_write_time(out, std::filesystem::last_write_time(in_) + std::chrono::hours(1));
    return up_to_date(out, from, settings_text(options));
  };
  EXPECT_TRUE(fresh());
  const std::string bytes = test::file_bytes(out);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{100}, bytes.size() / 5}) {
    test::write_text(out, bytes.substr(0, bytes.size() - cut));
    EXPECT_FALSE(fresh()) << cut;
  }
}

}  // namespace
}  // namespace spectile
