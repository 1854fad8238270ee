// RGB in all the forms that OpenEXR files come in gives the same spectra.
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

/// Only the spectral channels.
std::map<std::string, test::Plane> spectra(const std::string& path) {
  auto planes = test::read_picture(path).planes;
  std::erase_if(planes, [](const auto& entry) { return !entry.first.starts_with("T."); });
  return planes;
}

class RgbSourceImages : public testing::Test {
 protected:
  /// Upsamples; its spectra.
  std::map<std::string, test::Plane> upsampled(const std::string& input, const std::string& layer = "") {
    UpsampleImageOptions options;
    options.channels.layer = layer;
    report_ = upsample_image(input, folder_ / "out.exr", options);
    if (!report_) {
      ADD_FAILURE() << report_.error().message;
      return {};
    }
    return spectra(folder_ / "out.exr");
  }

  /// Spectra of the plain form: half R, G, B in one part of scanlines.
  std::map<std::string, test::Plane> plain(int width, int height, Imath::V2i origin = {0, 0}) {
    test::Picture picture = test::blank(width, height, origin);
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(folder_ / "plain.exr", picture);
    auto out = upsampled(folder_ / "plain.exr");
    EXPECT_EQ(out.size(), 60U);
    return out;
  }

  test::TempFolder folder_;
  Result<ImageReport> report_ = Error{};
};

TEST_F(RgbSourceImages, FloatOfHalfValuesEqualsHalf) {
  const auto expected = plain(100, 20);
  const test::Picture halves = test::read_picture(folder_ / "plain.exr");
  test::Picture picture = test::blank(100, 20);
  for (const char* name : {"R", "G", "B"}) {
    picture.add(name, Imf::FLOAT, [&](int x, int y) { return halves.at(name, x, y); });
  }
  test::write_scanlines(folder_ / "float.exr", picture);
  EXPECT_TRUE(upsampled(folder_ / "float.exr") == expected);
  // One channel half, one float.
  picture.add("G", Imf::HALF, [&](int x, int y) { return halves.at("G", x, y); });
  test::write_scanlines(folder_ / "mixed.exr", picture);
  EXPECT_TRUE(upsampled(folder_ / "mixed.exr") == expected);
}

TEST_F(RgbSourceImages, IntegersAreTakenAsTheyAre) {
  test::Picture uints = test::blank(67, 5);
  test::Picture floats = test::blank(67, 5);
  int channel = 0;
  for (const char* name : {"R", "G", "B"}) {
    const int c = channel++;
    const auto value = [c](int x, int y) { return std::floor(9 * test::noise(x, y, c)); };
    uints.add(name, Imf::UINT, value);
    floats.add(name, Imf::FLOAT, value);
  }
  test::write_scanlines(folder_ / "uint.exr", uints);
  test::write_scanlines(folder_ / "float.exr", floats);
  EXPECT_TRUE(upsampled(folder_ / "uint.exr") == upsampled(folder_ / "float.exr"));
}

TEST_F(RgbSourceImages, TilesWithAndWithoutMipmaps) {
  const auto expected = plain(150, 131, {7, -9});
  for (const unsigned side : {16U, 64U, 300U}) {
    for (const bool mipmaps : {false, true}) {
      test::Picture picture = test::blank(150, 131, {7, -9});
      test::add_rgb_noise(picture, Imf::HALF);
      test::write_tiles(folder_ / "tiles.exr", picture, side, mipmaps);
      EXPECT_TRUE(upsampled(folder_ / "tiles.exr") == expected) << side << mipmaps;
    }
  }
}

TEST_F(RgbSourceImages, EveryCompressionThatLosesNothing) {
  const auto expected = plain(70, 67);
  for (const auto method : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                            Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION}) {
    for (const auto order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
      test::Picture picture = test::blank(70, 67);
      picture.header.compression() = method;
      picture.header.lineOrder() = order;
      test::add_rgb_noise(picture, Imf::HALF);
      {
        Imf::OutputFile file((folder_ / "in.exr").c_str(), picture.header);
        file.setFrameBuffer(picture.frame_buffer());
        file.writePixels(67);
      }
      EXPECT_TRUE(upsampled(folder_ / "in.exr") == expected) << method << order;
    }
  }
}

TEST_F(RgbSourceImages, DataWindowMayLieAnywhere) {
  const auto expected = plain(90, 17);
  for (const auto& origin : {Imath::V2i(-200, -300), Imath::V2i(1000, 7), Imath::V2i(-45, -8)}) {
    test::Picture picture = test::blank(90, 17, origin);
    picture.header.displayWindow() = Imath::Box2i({0, 0}, {639, 479});
    test::add_rgb_noise(picture, Imf::HALF);
    test::write_scanlines(folder_ / "in.exr", picture);
    EXPECT_TRUE(upsampled(folder_ / "in.exr") == expected);
    const Imf::Header header = test::read_picture(folder_ / "out.exr").header;
    EXPECT_TRUE(header.dataWindow() == picture.header.dataWindow());
    EXPECT_TRUE(header.displayWindow() == picture.header.displayWindow());
    ASSERT_TRUE(project_image(folder_ / "out.exr", folder_ / "back.exr", test::kProject));
    EXPECT_TRUE(test::read_picture(folder_ / "back.exr").header.dataWindow() == picture.header.dataWindow());
  }
}

TEST_F(RgbSourceImages, LayersAreTakenByName) {
  test::Picture picture = test::blank(70, 9);
  test::add_rgb_noise(picture, Imf::HALF, 0.5);
  test::add_rgb_noise(picture, Imf::HALF, 1, "left.");
  test::add_rgb_noise(picture, Imf::HALF, 0.25, "deep.er.");
  test::write_scanlines(folder_ / "in.exr", picture);
  const auto expected = plain(70, 9);
  EXPECT_TRUE(upsampled(folder_ / "in.exr", "left") == expected);
  const test::Picture out = test::read_picture(folder_ / "out.exr");
  EXPECT_TRUE(out.planes.at("R") == picture.planes.at("left.R")) << "the preview is the layer's";
  EXPECT_FALSE(upsampled(folder_ / "in.exr", "deep.er") == expected);
  EXPECT_FALSE(upsampled(folder_ / "in.exr") == expected);
  UpsampleImageOptions options;
  options.channels.layer = "right";
  const auto missing = upsample_image(folder_ / "in.exr", folder_ / "none.exr", options);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kBadFile);
  EXPECT_THAT(missing.error().message, testing::HasSubstr("right"));
}

TEST_F(RgbSourceImages, PartsAreSearchedInOrderAndTakenByNameOrView) {
  test::Picture depth = test::blank(30, 8);
  depth.add("Z", Imf::FLOAT, [](int x, int) { return x; });
  test::Picture dim = test::blank(70, 9);
  test::add_rgb_noise(dim, Imf::HALF, 0.5);
  test::Picture bright = test::blank(70, 9);
  test::add_rgb_noise(bright, Imf::HALF);
  std::vector<test::Picture*> parts = {&depth, &dim, &bright};
  const char* const names[] = {"depth", "dim", "bright"};
  std::vector<Imf::Header> headers;
  for (std::size_t i = 0; i < 3; ++i) {
    parts[i]->header.setName(names[i]);
    parts[i]->header.setType(Imf::SCANLINEIMAGE);
    parts[i]->header.displayWindow() = depth.header.displayWindow();
    if (i == 2) Imf::addMultiView(parts[i]->header, {"left"});
    if (i == 2) parts[i]->header.setView("left");
    headers.push_back(parts[i]->header);
  }
  {
    Imf::MultiPartOutputFile file((folder_ / "in.exr").c_str(), headers.data(), 3);
    for (int i = 0; i < 3; ++i) {
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(parts[static_cast<std::size_t>(i)]->frame_buffer());
      part.writePixels(parts[static_cast<std::size_t>(i)]->height());
    }
  }
  const auto expected = plain(70, 9);
  EXPECT_TRUE(upsampled(folder_ / "in.exr", "bright") == expected);
  EXPECT_TRUE(upsampled(folder_ / "in.exr", "left") == expected);
  const auto first = upsampled(folder_ / "in.exr");
  EXPECT_TRUE(first == upsampled(folder_ / "in.exr", "dim"));
  EXPECT_FALSE(first == expected);
  EXPECT_THAT(report_->notes, testing::Contains(testing::HasSubstr("2 other parts")));
}

TEST_F(RgbSourceImages, LuminanceAloneIsGrey) {
  test::Picture luminance = test::blank(70, 9);
  luminance.add("Y", Imf::HALF, [](int x, int y) { return test::noise(x, y, 4); });
  test::write_scanlines(folder_ / "y.exr", luminance);
  test::Picture grey = test::blank(70, 9);
  for (const char* name : {"R", "G", "B"}) {
    grey.add(name, Imf::HALF, [](int x, int y) { return test::noise(x, y, 4); });
  }
  test::write_scanlines(folder_ / "grey.exr", grey);
  EXPECT_TRUE(upsampled(folder_ / "y.exr") == upsampled(folder_ / "grey.exr"));
}

TEST_F(RgbSourceImages, LuminanceAndChromaIsWhatOpenExrMakesOfIt) {
  const int width = 120;
  const int height = 66;
  std::vector<Imf::Rgba> pixels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto wave = [&](double f, double p) {
        return static_cast<float>(0.5 + 0.4 * std::sin(f * (x + 2 * y) + p));
      };
      pixels.emplace_back(wave(0.05, 0), wave(0.07, 1), wave(0.03, 2), 1.0F);
    }
  }
  {
    Imf::RgbaOutputFile file((folder_ / "yc.exr").c_str(), width, height, Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data(), 1, width);
    file.writePixels(height);
  }
  // As OpenEXR itself reads it, as plain R, G, B.
  std::vector<Imf::Rgba> read(pixels.size());
  Imf::RgbaInputFile file((folder_ / "yc.exr").c_str());
  file.setFrameBuffer(read.data(), 1, width);
  file.readPixels(0, height - 1);
  test::Picture picture = test::blank(width, height);
  const auto pixel = [&](int x, int y) { return read[picture.index(x, y)]; };
  picture.add("R", Imf::HALF, [&](int x, int y) { return static_cast<double>(pixel(x, y).r); });
  picture.add("G", Imf::HALF, [&](int x, int y) { return static_cast<double>(pixel(x, y).g); });
  picture.add("B", Imf::HALF, [&](int x, int y) { return static_cast<double>(pixel(x, y).b); });
  test::write_scanlines(folder_ / "rgb.exr", picture);
  EXPECT_TRUE(upsampled(folder_ / "yc.exr") == upsampled(folder_ / "rgb.exr"));
}

TEST_F(RgbSourceImages, SubsampledRgbIsAClearError) {
  Imf::Header header(64, 32);
  for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::HALF, 2, 2));
  std::vector<half> samples(64 * 32);
  Imf::FrameBuffer frame;
  for (const char* name : {"R", "G", "B"}) {
    frame.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(samples.data()), 2, 64, 2, 2));
  }
  {
    Imf::OutputFile file((folder_ / "in.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(32);
  }
  const auto report = upsample_image(folder_ / "in.exr", folder_ / "out.exr", test::kUpsample);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadFile);
  EXPECT_THAT(report.error().message, testing::HasSubstr("subsampled"));
}

}  // namespace
}  // namespace spectile
