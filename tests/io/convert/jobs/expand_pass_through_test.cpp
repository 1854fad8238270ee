// Channels and attributes of a compact image beside its coefficients come through expansion as they went in.
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spectile/image/image.hpp>

#include "tests/io/convert/jobs/compact_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

class ExpandPassThrough : public testing::Test {
 protected:
  ExpandPassThrough() {
    picture_ = test::every_color(67, 21, {-5, 12});
    picture_.add("A", Imf::HALF, [](int x, int y) { return test::noise(x, y, 7); });
    picture_.add("depth.Z", Imf::FLOAT, [](int x, int y) { return 1e6 * test::noise(x, y, 8); });
    picture_.add("id", Imf::UINT, [](int x, int y) { return 4e9 * test::noise(x, y, 9); });
    picture_.header.displayWindow() = Imath::Box2i({-10, 0}, {99, 49});
    picture_.header.insert("artist", Imf::StringAttribute("two words"));
    picture_.header.insert("exposure", Imf::FloatAttribute(0.1F));
    picture_.header.pixelAspectRatio() = 1.25F;
    test::write_scanlines(folder_ / "in.exr", picture_);
    test::upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "compact.exr",
                      test::options_of({Method::kSigmoid, Quantity::kUnbounded}));
  }

  const test::TempFolder folder_;
  const ExpandImageOptions expand_;
  test::Picture picture_;
};

TEST_F(ExpandPassThrough, PreviewAlphaAndOtherChannelsAreKeptToTheBit) {
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", folder_ / "out.exr", expand_));
  const test::Picture out = test::read_picture(folder_ / "out.exr");
  for (const auto& [name, plane] : picture_.planes) EXPECT_TRUE(out.planes.at(name) == plane) << name;
  EXPECT_EQ(out.planes.size(), picture_.planes.size() + 16);
  for (const auto& [name, plane] : out.planes) EXPECT_FALSE(name.starts_with("spectile.")) << name;
}

TEST_F(ExpandPassThrough, WindowsAndAttributesAreKept) {
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", folder_ / "out.exr", expand_));
  const Imf::Header header = test::read_picture(folder_ / "out.exr").header;
  EXPECT_EQ(header.dataWindow(), picture_.header.dataWindow());
  EXPECT_EQ(header.displayWindow(), picture_.header.displayWindow());
  EXPECT_EQ(header.pixelAspectRatio(), 1.25F);
  EXPECT_EQ(test::text_of(header, "artist"), "two words");
  EXPECT_EQ(header.typedAttribute<Imf::FloatAttribute>("exposure").value(), 0.1F);
}

TEST_F(ExpandPassThrough, AttributesSayWhatTheSpectraAreAndNoMore) {
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", folder_ / "out.exr", expand_));
  const Imf::Header header = test::read_picture(folder_ / "out.exr").header;
  EXPECT_EQ(test::text_of(header, "spectralLayoutVersion"), "1.0");
  EXPECT_EQ(test::text_of(header, "emissiveUnits"), "(none)");
  EXPECT_EQ(test::text_of(header, "spectileMethod"), "sigmoid");
  EXPECT_EQ(test::text_of(header, "spectileLight"), "D65");
  EXPECT_EQ(test::text_of(header, "spectileObserver"), "1931");
  for (const char* name :
       {"spectileCoefficients", "spectileQuantity", "spectileBands", "spectileLightSamples"}) {
    EXPECT_EQ(test::text_of(header, name), "(none)") << name;
  }
}

TEST_F(ExpandPassThrough, ExpandedImageIsProjectedLikeAnyOther) {
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", folder_ / "out.exr", expand_));
  ASSERT_TRUE(project_image(folder_ / "out.exr", folder_ / "rgb.exr", test::kProject));
  EXPECT_TRUE(test::read_picture(folder_ / "rgb.exr").planes.at("A") == picture_.planes.at("A"));
}

TEST_F(ExpandPassThrough, SubsampledChannelsAreLeftOutAndNamed) {
  test::Picture compact = test::read_picture(folder_ / "compact.exr");
  Imf::FrameBuffer frame = compact.frame_buffer();
  compact.header.channels().insert("fog", Imf::Channel(Imf::HALF, 1, 3));
  std::vector<half> fog(67 * 7, half(0.5F));
  // The first line of the data window is line 12.
  char* const origin = reinterpret_cast<char*>(fog.data()) - 2 * (67 * (12 / 3) - 5);
  frame.insert("fog", Imf::Slice(Imf::HALF, origin, 2, 134, 1, 3));
  {
    Imf::OutputFile file((folder_ / "fog.exr").c_str(), compact.header);
    file.setFrameBuffer(frame);
    file.writePixels(21);
  }
  const auto report = expand_image(folder_ / "fog.exr", folder_ / "out.exr", expand_);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->notes, testing::ElementsAre(HasSubstr("\"fog\" is left out")));
}

TEST_F(ExpandPassThrough, PartWithCoefficientsIsFoundAmongOthers) {
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", folder_ / "alone.exr", expand_));
  test::Picture compact = test::read_picture(folder_ / "compact.exr");
  std::vector<Imf::Header> headers = {picture_.header, compact.header};
  headers[0].setName("picture");
  headers[1].setName("texture");
  for (Imf::Header& header : headers) header.setType("scanlineimage");
  {
    Imf::MultiPartOutputFile file((folder_ / "parts.exr").c_str(), headers.data(), 2, true);
    Imf::OutputPart first(file, 0);
    first.setFrameBuffer(picture_.frame_buffer());
    first.writePixels(21);
    Imf::OutputPart second(file, 1);
    second.setFrameBuffer(compact.frame_buffer());
    second.writePixels(21);
  }
  const auto report = expand_image(folder_ / "parts.exr", folder_ / "out.exr", expand_);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->notes, testing::ElementsAre("1 other part of the file is left out: \"picture\""));
  EXPECT_TRUE(test::read_picture(folder_ / "out.exr").planes ==
              test::read_picture(folder_ / "alone.exr").planes);
}

TEST_F(ExpandPassThrough, CompressionsButPxr24KeepTheCoefficients) {
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", folder_ / "alone.exr", expand_));
  const test::Picture want = test::read_picture(folder_ / "alone.exr");
  for (const char* name : {"rle", "zips", "zip:9", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    UpsampleImageOptions options = test::options_of({Method::kSigmoid, Quantity::kUnbounded});
    options.compression = *Compression::parse(name);
    test::upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "packed.exr", options);
    ASSERT_TRUE(expand_image(folder_ / "packed.exr", folder_ / "out.exr", expand_)) << name;
    const test::Picture out = test::read_picture(folder_ / "out.exr");
    bool same = true;
    for (const auto& [channel, plane] : want.planes) {
      if (channel.ends_with("nm")) same = same && out.planes.at(channel) == plane;
    }
    EXPECT_EQ(same, std::string(name) != "pxr24") << name;
  }
}

TEST_F(ExpandPassThrough, TiledCompactImagesExpandToTheSameSpectra) {
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", folder_ / "alone.exr", expand_));
  test::Picture compact = test::read_picture(folder_ / "compact.exr");
  test::write_tiles(folder_ / "tiles.exr", compact, 16, true);
  ASSERT_TRUE(expand_image(folder_ / "tiles.exr", folder_ / "out.exr", expand_));
  EXPECT_TRUE(test::read_picture(folder_ / "out.exr").planes ==
              test::read_picture(folder_ / "alone.exr").planes);
}

}  // namespace
}  // namespace spectile
