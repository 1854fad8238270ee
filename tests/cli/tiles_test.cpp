// The tool's tiles and mip levels, in the files that it writes.
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>
#include <ImfTiledInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;

class TilesTool : public testing::Test {
 protected:
  TilesTool() {
    test::Picture picture = test::blank(100, 60);
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(in_, picture);
  }

  /// The tool's output as OpenEXR reads it.
  void expect_tiles(const std::vector<std::string>& words, unsigned width, unsigned height,
                    int levels) const {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"-o", out_});
    const auto outcome = run_tool(all);
    ASSERT_EQ(outcome.exit, 0) << outcome;
    ASSERT_TRUE(Imf::isTiledOpenExrFile(out_.c_str()));
    Imf::TiledInputFile file(out_.c_str());
    EXPECT_EQ(file.tileXSize(), width);
    EXPECT_EQ(file.tileYSize(), height);
    EXPECT_EQ(file.numLevels(), levels);
    EXPECT_TRUE(file.isComplete());
    for (int level = 0; level < levels; ++level) {
      EXPECT_EQ(file.levelWidth(level), std::max(1, 100 >> level)) << level;
      EXPECT_EQ(file.levelHeight(level), std::max(1, 60 >> level)) << level;
    }
  }

  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(TilesTool, OfTheSizeAskedFor) {
  expect_tiles({"upsample", in_, "--tile", "48", "32"}, 48, 32, 1);
}

TEST_F(TilesTool, MipLevelsOfEveryConversion) {
  expect_tiles({"upsample", in_, "--mipmap"}, 64, 64, 7);
  std::filesystem::copy_file(out_, folder_ / "s.exr");
  expect_tiles({"project", folder_ / "s.exr", "--mipmap", "--tile", "16", "16"}, 16, 16, 7);
  expect_tiles({"convert", folder_ / "s.exr", "--mipmap"}, 64, 64, 7);
  expect_tiles({"relight", in_, "--illuminant", "A", "--mipmap"}, 64, 64, 7);
  const auto stored = run_tool({"upsample", in_, "--store", "coefficients", "-o", folder_ / "c.exr"});
  ASSERT_EQ(stored.exit, 0) << stored;
  expect_tiles({"expand", folder_ / "c.exr", "--mipmap"}, 64, 64, 7);
}

TEST_F(TilesTool, CoefficientsThatCannotBeAveragedHaveNone) {
  const auto outcome =
      run_tool({"upsample", in_, "--method", "sigmoid", "--store", "coefficients", "--mipmap", "-o", out_});
  EXPECT_EQ(outcome.exit, 2) << outcome;
  EXPECT_THAT(outcome.err, HasSubstr("mip levels"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

/// Mip levels of an image of 2 x 200000 took 513 MB: a line of a level takes a whole block of lanes.
TEST(TilesToolMemory, OfMipLevelsDoesNotGrowWithTheHeight) {
  if (test::kSanitized) GTEST_SKIP() << "a sanitizer's memory is its own";
  const test::TempFolder folder;
  test::Picture picture = test::blank(2, 200000);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(folder / "in.exr", picture);
  const auto outcome =
      run_tool({"upsample", folder / "in.exr", "-o", folder / "out.exr", "--mipmap", "--threads", "2",
                "--compression", "none", "--method", "smits", "--bands", "400:700:50", "--quiet"});
  ASSERT_EQ(outcome.exit, 0) << outcome;
  EXPECT_LT(outcome.peak_mib, 256);
}

/// OpenImageIO takes files of the same oiio:SHA-1 for the same texture, and every level for all of the
/// display window. Prints the file's pixel 3, 2 as its cache has it, then the widths of the levels' full
/// windows.
constexpr const char* kCacheScript = R"(
import sys, numpy, OpenImageIO as oiio
cache = oiio.ImageCache()
for name in sys.argv[1:]:
    line = ["%.6f" % cache.get_pixels(name, 0, 0, 3, 4, 2, 3, 0, 1, oiio.FLOAT).reshape(-1)[0]]
    file = oiio.ImageInput.open(name)
    level = 0
    while file.seek_subimage(0, level):
        spec = file.spec()
        line.append("%d/%d" % (spec.width, spec.full_width))
        level += 1
    print(" ".join(line))
)";

TEST(TilesToolOpenImageIO, ItsCacheHasTheFilesOwnPixelsAndLevels) {
  test::Tool::Options python;
  python.program = "/usr/bin/python3";
  if (run_tool({"-c", "import numpy, OpenImageIO"}, python).exit != 0) {
    GTEST_SKIP() << "no OpenImageIO for /usr/bin/python3 (python3-openimageio, python3-numpy)";
  }
  const test::TempFolder folder;
  test::Picture picture = test::blank(32, 16);
  for (const char* name : {"R", "G", "B"}) picture.add(name, Imf::HALF, [](int, int) { return 0.5; });
  picture.header.insert("oiio:SHA-1", Imf::StringAttribute("0123456789ABCDEF0123456789ABCDEF01234567"));
  test::write_tiles(folder / "in.exr", picture, 64, true);
  ASSERT_EQ(run_tool({"relight", folder / "in.exr", "-o", folder / "out.exr", "--illuminant", "A", "--mipmap",
                      "--quiet"})
                .exit,
            0);
  test::Picture crop = test::blank(32, 16);
  crop.header.displayWindow() = {{-8, 0}, {55, 63}};
  for (const char* name : {"R", "G", "B"}) crop.add(name, Imf::HALF, [](int, int) { return 0.5; });
  test::write_scanlines(folder / "crop.exr", crop);
  ASSERT_EQ(run_tool({"relight", folder / "crop.exr", "-o", folder / "padded.exr", "--illuminant", "A",
                      "--mipmap", "--quiet"})
                .exit,
            0);
  const auto seen =
      run_tool({"-c", kCacheScript, folder / "in.exr", folder / "out.exr", folder / "padded.exr"}, python);
  ASSERT_EQ(seen.exit, 0) << seen;
  const auto lines = test::lines(seen.out);
  ASSERT_EQ(lines.size(), 3U) << seen;
  EXPECT_EQ(lines[0], "0.500000 32/32 16/16 8/8 4/4 2/2 1/1");
  const test::Picture own = test::read_picture(folder / "out.exr");
  char expected[80];
  std::snprintf(expected, sizeof(expected), "%.6f 32/32 16/16 8/8 4/4 2/2 1/1", own.at("R", 3, 2));
  EXPECT_EQ(lines[1], expected);
  EXPECT_NE(own.at("R", 3, 2), 0.5);
  EXPECT_THAT(lines[2], HasSubstr(" 64/64 32/32 16/16 8/8 4/4 2/2 1/1"));
}

}  // namespace
}  // namespace spectile
