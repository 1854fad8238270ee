// The tool's files as OpenImageIO's programs see them: pixels, mip levels and colour space.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "tests/cli/process.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::run_tool;
using testing::HasSubstr;
using testing::Not;

class OpenImageIoPrograms : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"oiiotool", "iinfo", "maketx"}) {
      if (!std::filesystem::exists(std::string("/usr/bin/") + name)) {
        GTEST_SKIP() << "no /usr/bin/" << name << " (openimageio-tools)";
      }
    }
  }
  static std::string run(const std::string& program, const std::vector<std::string>& arguments) {
    test::Tool::Options options;
    options.program = "/usr/bin/" + program;
    const auto outcome = run_tool(arguments, options);
    EXPECT_EQ(outcome.exit, 0) << program << outcome;
    return outcome.out;
  }
  static void expect_done(const std::vector<std::string>& arguments) {
    const auto outcome = run_tool(arguments);
    ASSERT_EQ(outcome.exit, 0) << outcome;
  }
  void write_noise(int width, int height, const Imath::Box2i& display) const {
    test::Picture picture = test::blank(width, height);
    picture.header.displayWindow() = display;
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(in_, picture);
  }
  /// The value of a pixel of the display window, as oiiotool prints it.
  static std::string pixel(const std::string& path, int x, int y) {
    const std::string start = "Pixel (" + std::to_string(x) + ", " + std::to_string(y) + "): ";
    for (const std::string& line : test::lines(run("oiiotool", {"--dumpdata", path}))) {
      const std::size_t at = line.find(start);
      if (at != std::string::npos) return line.substr(at + start.size());
    }
    return "none";
  }
  static std::string printed(const test::Picture& picture, int x, int y) {
    char text[80];
    std::snprintf(text, sizeof(text), "%.9f %.9f %.9f", picture.at("R", x, y), picture.at("G", x, y),
                  picture.at("B", x, y));
    return text;
  }
  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(OpenImageIoPrograms, SeeARelitTextureOfMaketxAsItIs) {
  write_noise(32, 16, {{0, 0}, {31, 15}});
  const std::string texture = folder_ / "in.tx.exr";
  run("maketx", {in_, "-o", texture, "--format", "exr"});
  const std::string before = run("iinfo", {"-v", texture});
  ASSERT_THAT(before, HasSubstr("oiio:SHA-1"));
  expect_done({"relight", texture, "-o", out_, "--illuminant", "A", "--mipmap", "--tile", "64", "64"});
  const std::string after = run("iinfo", {"-v", out_});
  for (const char* name : {"oiio:SHA-1", "oiio:AverageColor", "oiio:ConstantColor"})
    EXPECT_THAT(after, Not(HasSubstr(name)));
  EXPECT_THAT(after, HasSubstr("MIP-map levels: 32x16 16x8 8x4 4x2 2x1 1x1"));
  EXPECT_THAT(after, HasSubstr("tile size: 64 x 64"));
  EXPECT_THAT(after, HasSubstr("wrapmodes: \"black,black\""));
  const test::Picture own = test::read_picture(out_);
  for (const auto& [x, y] : {std::pair{3, 2}, {31, 15}, {0, 9}})
    EXPECT_EQ(pixel(out_, x, y), printed(own, x, y));
  // Again a texture, of its own.
  run("maketx", {out_, "-o", folder_ / "again.tx.exr", "--format", "exr"});
  EXPECT_EQ(pixel(folder_ / "again.tx.exr", 3, 2), printed(own, 3, 2));
}

TEST_F(OpenImageIoPrograms, SeeLevelsOfACroppedImageLineUp) {
  // 16 x 8 pixels in a frame of 64 x 32, and one larger than its frame.
  for (const Imath::Box2i& display : {Imath::Box2i({-24, -8}, {39, 23}), Imath::Box2i({4, 2}, {11, 5})}) {
    write_noise(16, 8, display);
    expect_done({"relight", in_, "-o", out_, "--illuminant", "A", "--mipmap"});
    const std::string seen = run("iinfo", {"-v", out_});
    const bool wide = display.min.x < 0;
    EXPECT_THAT(seen, HasSubstr(wide ? "MIP-map levels: 64x32 32x16 16x8 8x4 4x2 2x1 1x1"
                                     : "MIP-map levels: 8x4 4x2 2x1 1x1"));
    // Data and display window are one, as readers take each level for all of it.
    EXPECT_THAT(seen, HasSubstr(wide ? "full/display size: 64 x 32" : "full/display size: 8 x 4"));
    EXPECT_THAT(seen, HasSubstr(wide ? "full/display origin: -24, -8" : "full/display origin: 4, 2"));
    EXPECT_THAT(seen, HasSubstr(wide ? "pixel data origin: x=-24, y=-8" : "pixel data origin: x=4, y=2"));
    const test::Picture own = test::read_picture(out_);
    const int x = 5 - display.min.x;
    const int y = 3 - display.min.y;
    EXPECT_EQ(pixel(out_, 5, 3), printed(own, x, y));
  }
}

TEST_F(OpenImageIoPrograms, UnderstandTheColourSpace) {
  write_noise(4, 4, {{0, 0}, {3, 3}});
  const auto space_of = [&](const std::string& path) {
    for (const std::string& line : test::lines(run("iinfo", {"-v", path}))) {
      const std::size_t at = line.find("oiio:ColorSpace: ");
      if (at != std::string::npos) return line.substr(at + 17);
    }
    return std::string("none");
  };
  // Before 3.0 it calls linear Rec.709 so.
  const auto linear =
      testing::AnyOf("\"Linear\"", "\"lin_rec709\"", "\"lin_rec709_scene\"", "\"scene_linear\"");
  expect_done({"relight", in_, "-o", out_, "--illuminant", "A"});
  EXPECT_THAT(space_of(out_), linear);
  expect_done({"relight", in_, "-o", out_, "--illuminant", "A", "--to", "xyz"});
  EXPECT_THAT(space_of(out_), "\"lin_ciexyzd65_scene\"");
  const std::string spectral = folder_ / "spectral.exr";
  expect_done({"upsample", in_, "-o", spectral});
  expect_done({"project", spectral, "-o", out_, "--to", "xyz"});
  EXPECT_THAT(space_of(out_), "\"lin_ciexyzd65_scene\"");
  expect_done({"project", spectral, "-o", folder_ / "rgb.exr"});
  EXPECT_THAT(space_of(folder_ / "rgb.exr"), linear);
  // The tool takes its own XYZ for what they are.
  EXPECT_THAT(run_tool({"upsample", out_, "-o", spectral}).out, HasSubstr("input space: CIE XYZ (D65)"));
}

}  // namespace
}  // namespace spectile
