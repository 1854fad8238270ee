// Tiled outputs: the pixels of the scanline file, in tiles that OpenEXR reads.
#include <OpenEXR/ImfTiledInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

class Tiles : public testing::Test {
 protected:
  /// A texture with a black corner, one colour, noise, and two bad pixels.
  void make(int width, int height, Imf::PixelType type = Imf::HALF) {
    test::Picture picture = test::blank(width, height, {-5, 3});
    int channel = 0;
    for (const char* name : {"R", "G", "B"}) {
      const int c = channel++;
      picture.add(name, type, [=](int x, int y) {
        if (x < width / 2 && y < height / 2) return 0.0;
        return x > 3 * width / 4 ? 0.1 + 0.2 * c : test::noise(x, y, c) * 1.2 - 0.1;
      });
    }
    picture.add("A", Imf::FLOAT, [=](int x, int) { return x == width / 3 ? 0 : 1; });
    picture.add("id", Imf::UINT, [](int x, int y) { return x / 9 + y / 9; });
    test::write_scanlines(in_, picture);
  }

  /// Reads a file tile by tile with OpenEXR's own class; every tile must be there.
  test::Picture read_by_tiles(const std::string& path, std::array<int, 2> tile) {
    Imf::TiledInputFile file(path.c_str());
    EXPECT_EQ(file.header().lineOrder(), Imf::INCREASING_Y);
    EXPECT_EQ(static_cast<int>(file.tileXSize()), tile[0]);
    EXPECT_EQ(static_cast<int>(file.tileYSize()), tile[1]);
    EXPECT_EQ(file.numLevels(), 1);
    EXPECT_TRUE(file.isComplete());
    test::Picture out{file.header(), {}};
    for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
      out.add(it.name(), it.channel().type, [](int, int) { return 0; });
    }
    file.setFrameBuffer(out.frame_buffer());
    for (int y = 0; y < file.numYTiles(); ++y) {
      for (int x = 0; x < file.numXTiles(); ++x) file.readTile(x, y);
    }
    return out;
  }

  using Convert = std::function<Result<ImageReport>(
      const std::string& output, std::optional<std::array<int, 2>> tile, int threads, bool skip)>;
  /// Checks that tiles of several sizes hold the scanline file's pixels, in the same bytes whatever the
  /// threads.
  void check(const Convert& convert, bool lossless = true) {
    const auto lines = convert(folder_ / "lines.exr", {}, 1, true);
    ASSERT_TRUE(lines) << lines.error().message;
    const test::Picture expected = test::read_picture(folder_ / "lines.exr");
    for (const std::array<int, 2> tile : {std::array{64, 64}, {32, 16}, {1, 7}, {61, 3}, {4096, 4096}}) {
      SCOPED_TRACE(std::to_string(tile[0]) + " x " + std::to_string(tile[1]));
      std::string bytes;
      for (const auto& [threads, skip] : {std::pair{1, true}, {4, false}, {4, true}}) {
        const auto report = convert(folder_ / "tiles.exr", tile, threads, skip);
        ASSERT_TRUE(report) << report.error().message;
        const std::string got = test::file_bytes(folder_ / "tiles.exr");
        if (bytes.empty()) bytes = got;
        EXPECT_TRUE(got == bytes) << threads << " threads, skip " << skip;
        EXPECT_EQ(report->nonfinite_pixels, lines->nonfinite_pixels);
        EXPECT_EQ(report->out_of_gamut_pixels, lines->out_of_gamut_pixels);
        EXPECT_EQ(report->over_one_pixels, lines->over_one_pixels);
      }
      const test::Picture got = read_by_tiles(folder_ / "tiles.exr", tile);
      EXPECT_EQ(got.header.dataWindow(), expected.header.dataWindow());
      if (!lossless) continue;
      EXPECT_TRUE(got.planes == expected.planes);
      EXPECT_TRUE(test::read_picture(folder_ / "tiles.exr").planes == expected.planes) << "as scanlines";
    }
  }

  static void apply(ImageOptions& options, std::optional<std::array<int, 2>> tile, int threads, bool skip) {
    options.tile = tile;
    options.threads = threads;
    options.skip = skip;
  }

  Convert upsampling(UpsampleImageOptions options) {
    options.bands = *Bands::uniform(400, 700, 25);
    return [this, options](const std::string& output, std::optional<std::array<int, 2>> tile, int threads,
                           bool skip) mutable {
      apply(options, tile, threads, skip);
      return upsample_image(in_, output, options);
    };
  }

  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
};

TEST_F(Tiles, HoldTheScanlinesPixelsWhateverTheSize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {131, 67}, {200, 128}}) {
    SCOPED_TRACE(width);
    make(width, height, width == 131 ? Imf::FLOAT : Imf::HALF);
    for (const Method method : {kDefaultMethod, Method::kSigmoid, Method::kTetrahedral}) {
      UpsampleImageOptions options;
      options.method = method;
      options.pixel = height == 67 ? SampleType::kFloat : SampleType::kHalf;
      check(upsampling(options));
      options.store = Store::kCoefficients;
      check(upsampling(options));
    }
  }
}

TEST_F(Tiles, WorkWithEveryCompression) {
  make(131, 67);
  for (const char* name :
       {"none", "rle", "zips", "zip", "zip:4", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    SCOPED_TRACE(name);
    UpsampleImageOptions options;
    options.compression = *Compression::parse(name);
    const std::string kind = name;
    check(upsampling(options), !kind.starts_with("b44") && !kind.starts_with("dwa"));
  }
}

TEST_F(Tiles, OfExpandedProjectedAndRelitImages) {
  make(131, 67);
  UpsampleImageOptions up;
  up.store = Store::kCoefficients;
  ASSERT_TRUE(upsample_image(in_, folder_ / "c.exr", up));
  check([&](const std::string& output, auto tile, int threads, bool skip) {
    ExpandImageOptions options;
    options.bands = *Bands::uniform(400, 700, 25);
    apply(options, tile, threads, skip);
    return expand_image(folder_ / "c.exr", output, options);
  });
  up.store = Store::kSpectra;
  ASSERT_TRUE(upsample_image(in_, folder_ / "s.exr", up));
  for (const ColorTarget target : {ColorTarget::kSrgb, ColorTarget::kLuminance}) {
    check([&](const std::string& output, auto tile, int threads, bool skip) {
      ProjectImageOptions options;
      options.target = target;
      apply(options, tile, threads, skip);
      return project_image(folder_ / "s.exr", output, options);
    });
  }
  for (const RelightMode mode : {RelightMode::kDirect, RelightMode::kSpectra}) {
    check([&](const std::string& output, auto tile, int threads, bool skip) {
      RelightImageOptions options({"A", *illuminant("A")});
      options.mode = mode;
      apply(options, tile, threads, skip);
      return relight_image(in_, output, options);
    });
  }
}

TEST_F(Tiles, SameOnesAreReused) {
  test::Picture picture = test::blank(256, 128);
  test::add_rgb_noise(picture, Imf::HALF);
  for (const char* name : {"R", "G", "B"}) {
    picture.add(name, Imf::HALF, [](int x, int y) { return x < 64 && y < 64 ? test::noise(x, y, 1) : 0; });
  }
  test::write_scanlines(in_, picture);
  UpsampleImageOptions options;
  options.tile = {64, 64};
  const auto report = upsample_image(in_, folder_ / "out.exr", options);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->skipped.chunks, 8U);
  EXPECT_EQ(report->skipped.chunks_reused, 6U);
}

TEST_F(Tiles, SameBytesInAnotherShapeAreAnotherTile) {
  // The tiles at the right and at the bottom are of 32 x 64 and 64 x 32 pixels of one grey.
  test::Picture picture = test::blank(96, 96);
  for (const char* name : {"R", "G", "B"}) picture.add(name, Imf::HALF, [](int, int) { return 0.5; });
  test::write_scanlines(in_, picture);
  UpsampleImageOptions options;
  options.method = Method::kSmits;  // whose white is not the same in every band
  check(upsampling(options));
}

TEST_F(Tiles, FirstBadPixelIsThatOfTheImage) {
  test::Picture picture = test::blank(100, 40);
  test::add_rgb_noise(picture, Imf::HALF);
  // The tile of the second comes before the tile of the first.
  picture.add("G", Imf::HALF, [](int x, int y) {
    return (x == 80 && y == 2) || (x == 3 && y == 9) ? std::numeric_limits<double>::infinity() : 0.5;
  });
  test::write_scanlines(in_, picture);
  for (const int threads : {1, 4}) {
    UpsampleImageOptions options;
    options.tile = {32, 32};
    options.threads = threads;
    const auto report = upsample_image(in_, folder_ / "out.exr", options);
    ASSERT_FALSE(report);
    EXPECT_THAT(report.error().message, testing::HasSubstr("2 non-finite pixels, the first at 80,2"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
  }
}

TEST_F(Tiles, SidesOutOfRangeAreErrors) {
  make(20, 20);
  for (const std::array<int, 2> tile : {std::array{0, 64}, {64, -1}, {4097, 64}}) {
    UpsampleImageOptions options;
    options.tile = tile;
    const auto report = upsample_image(in_, folder_ / "out.exr", options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
  }
}

}  // namespace
}  // namespace spectile
