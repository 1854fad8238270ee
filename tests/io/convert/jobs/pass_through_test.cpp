// Channels and attributes that are no business of a conversion come out as they went in, to the bit.
#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfChannelListAttribute.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfCompressionAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfKeyCodeAttribute.h>
#include <OpenEXR/ImfLineOrderAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOpaqueAttribute.h>
#include <OpenEXR/ImfPreviewImage.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfTileDescriptionAttribute.h>
#include <OpenEXR/ImfTimeCodeAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using Attributes = std::map<std::string, std::unique_ptr<Imf::Attribute>>;

/// One attribute of every type that can describe a picture.
Attributes every_type() {
  Attributes out;
  const auto add = [&out](const char* name, auto attribute) {
    out[name] = std::make_unique<decltype(attribute)>(attribute);
  };
  add("anInt", Imf::IntAttribute(-123456789));
  add("aFloat", Imf::FloatAttribute(0.1F));
  add("aNan", Imf::FloatAttribute(std::numeric_limits<float>::quiet_NaN()));
  add("aDouble", Imf::DoubleAttribute(1.0 / 3.0));
  add("aString", Imf::StringAttribute("two words, \xC3\xA4 and \"quotes\"\n"));
  add("v2i", Imf::V2iAttribute({1, -2}));
  add("v2f", Imf::V2fAttribute({0.1F, -0.2F}));
  add("v2d", Imf::V2dAttribute({0.1, -0.2}));
  add("v3i", Imf::V3iAttribute({1, -2, 3}));
  add("v3f", Imf::V3fAttribute({0.1F, -0.2F, 0.3F}));
  add("v3d", Imf::V3dAttribute({0.1, -0.2, 0.3}));
  add("m33f", Imf::M33fAttribute({1, 2, 3, 4, 5, 6, 7, 8, 0.9F}));
  add("m33d", Imf::M33dAttribute({1, 2, 3, 4, 5, 6, 7, 8, 0.9}));
  add("m44f", Imf::M44fAttribute({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 0.16F}));
  add("m44d", Imf::M44dAttribute({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 0.16}));
  add("box2i", Imf::Box2iAttribute({{-1, -2}, {3, 4}}));
  add("box2f", Imf::Box2fAttribute({{-1.5F, -2.5F}, {3.5F, 4.5F}}));
  add("otherPrimaries",
      Imf::ChromaticitiesAttribute(Imf::Chromaticities({0.6F, 0.3F}, {0.3F, 0.6F}, {0.1F, 0.05F})));
  add("timeCode",
      Imf::TimeCodeAttribute(Imf::TimeCode(1, 2, 3, 4, true, false, true, false, true, false, 1, 2, 3)));
  add("keyCode", Imf::KeyCodeAttribute(Imf::KeyCode(12, 34, 567890, 1234, 56, 4, 64)));
  add("rational", Imf::RationalAttribute(Imf::Rational(-24000, 1001)));
  add("strings", Imf::StringVectorAttribute({"one", "", "three"}));
  add("floats", Imf::FloatVectorAttribute({0.1F, -2, 3e38F}));
  add("envmap", Imf::EnvmapAttribute(Imf::ENVMAP_CUBE));
  Imf::OpaqueAttribute grain("grainOfAnotherProgram");
  Imf::StdISStream bytes;
  bytes.str(std::string("\0\x01raw\xFF bytes", 12));
  grain.readValueFrom(bytes, 12, 2);
  out["grain"] = std::make_unique<Imf::OpaqueAttribute>(grain);
  return out;
}

test::Picture picture_with_extras() {
  test::Picture picture = test::blank(83, 21, {3, -4});
  test::add_rgb_noise(picture, Imf::HALF);
  picture.add("A", Imf::HALF, [](int x, int y) { return test::noise(x, y, 5); });
  picture.add("Z", Imf::FLOAT, [](int x, int y) { return 1e30 * test::noise(x, y, 6) - 1e20; });
  picture.add("id", Imf::UINT, [](int x, int y) { return 4294967295.0 * test::noise(x, y, 7); });
  picture.add("normal.x", Imf::HALF, [](int x, int y) { return test::noise(x, y, 8) - 0.5; });
  // Samples that arithmetic would change: a signalling NaN, an infinity, the smallest denormal.
  const std::uint32_t odd[] = {0x7F800001U, 0xFF800000U, 1U};
  std::memcpy(picture.planes.at("Z").bytes.data(), odd, sizeof(odd));
  const std::uint16_t odd_halves[] = {0x7C01U, 0xFC00U, 1U};
  std::memcpy(picture.planes.at("A").bytes.data(), odd_halves, sizeof(odd_halves));
  return picture;
}

void expect_same_attributes(const Attributes& expected, const Imf::Header& got, const char* where) {
  for (const auto& [name, attribute] : expected) {
    ASSERT_TRUE(got.find(name) != got.end()) << where << ": " << name << " is lost";
    EXPECT_STREQ(got[name].typeName(), attribute->typeName()) << where << ": " << name;
    EXPECT_EQ(test::attribute_bytes(got[name]), test::attribute_bytes(*attribute)) << where << ": " << name;
  }
}

TEST(PassThrough, ChannelsKeepTheirTypesAndBits) {
  const test::TempFolder folder;
  test::Picture picture = picture_with_extras();
  test::write_scanlines(folder / "in.exr", picture);
  for (const auto kind : {CompressionKind::kNone, CompressionKind::kZip, CompressionKind::kPiz}) {
    UpsampleImageOptions up;
    up.compression = {kind, -1};
    const auto made = upsample_image(folder / "in.exr", folder / "spectral.exr", up);
    ASSERT_TRUE(made) << made.error().message;
    const auto back = project_image(folder / "spectral.exr", folder / "back.exr", test::kProject);
    ASSERT_TRUE(back) << back.error().message;
    const test::Picture spectral = test::read_picture(folder / "spectral.exr");
    const test::Picture projected = test::read_picture(folder / "back.exr");
    for (const char* name : {"A", "Z", "id", "normal.x"}) {
      EXPECT_TRUE(spectral.planes.at(name) == picture.planes.at(name)) << name;
      EXPECT_TRUE(projected.planes.at(name) == picture.planes.at(name)) << name;
    }
  }
}

TEST(PassThrough, AttributesOfEveryTypeAreTheSame) {
  const test::TempFolder folder;
  test::Picture picture = picture_with_extras();
  const Attributes attributes = every_type();
  for (const auto& [name, attribute] : attributes) picture.header.insert(name, *attribute);
  std::vector<Imf::PreviewRgba> thumb(6, Imf::PreviewRgba(1, 2, 3, 4));
  picture.header.setPreviewImage(Imf::PreviewImage(3, 2, thumb.data()));
  picture.header.pixelAspectRatio() = 1.25F;
  picture.header.screenWindowWidth() = 0.45F;
  picture.header.screenWindowCenter() = {0.5F, -0.25F};
  test::write_scanlines(folder / "in.exr", picture);
  const auto made = upsample_image(folder / "in.exr", folder / "spectral.exr", test::kUpsample);
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_TRUE(project_image(folder / "spectral.exr", folder / "back.exr", test::kProject));
  for (const char* name : {"spectral.exr", "back.exr"}) {
    const Imf::Header header = test::read_picture(folder / name).header;
    expect_same_attributes(attributes, header, name);
    // The thumbnail shows the colours, which the second has anew.
    const bool shown = header.find("preview") != header.end();
    EXPECT_EQ(shown, name == std::string_view("spectral.exr"));
    if (shown) {
      EXPECT_EQ(test::attribute_bytes(header["preview"]), test::attribute_bytes(picture.header["preview"]));
    }
    EXPECT_EQ(header.pixelAspectRatio(), 1.25F);
    EXPECT_EQ(header.screenWindowWidth(), 0.45F);
    EXPECT_EQ(header.screenWindowCenter(), Imath::V2f(0.5F, -0.25F));
  }
}

TEST(PassThrough, AttributesThatDescribeStorageStayBehindWhateverTheirNames) {
  const test::TempFolder folder;
  test::Picture picture = test::blank(9, 6);
  test::add_rgb_noise(picture, Imf::HALF);
  const std::string names[] = {"itsChannels", "itsCompression", "itsOrder", "itsTiles"};
  picture.header.insert(names[0], Imf::ChannelListAttribute(picture.header.channels()));
  picture.header.insert(names[1], Imf::CompressionAttribute(Imf::PIZ_COMPRESSION));
  picture.header.insert(names[2], Imf::LineOrderAttribute(Imf::DECREASING_Y));
  picture.header.insert(names[3], Imf::TileDescriptionAttribute(Imf::TileDescription(8, 8)));
  test::write_scanlines(folder / "in.exr", picture);
  const auto made = upsample_image(folder / "in.exr", folder / "out.exr", test::kUpsample);
  ASSERT_TRUE(made) << made.error().message;
  const Imf::Header header = test::read_picture(folder / "out.exr").header;
  for (const std::string& name : names) EXPECT_TRUE(header.find(name) == header.end()) << name;
}

TEST(PassThrough, EmptyValuesAreKept) {
  const test::TempFolder folder;
  Attributes attributes;
  attributes["noText"] = std::make_unique<Imf::StringAttribute>("");
  attributes["noStrings"] = std::make_unique<Imf::StringVectorAttribute>(Imf::StringVector());
  attributes["noBytes"] = std::make_unique<Imf::OpaqueAttribute>("emptyTypeOfAnotherProgram");
  attributes["noFloats"] = std::make_unique<Imf::FloatVectorAttribute>(Imf::FloatVector());
  for (const auto& [name, attribute] : attributes) {
    test::Picture picture = test::blank(5, 5);
    test::add_rgb_noise(picture, Imf::HALF);
    picture.header.insert(name, *attribute);
    test::write_scanlines(folder / "in.exr", picture);
    const auto made = upsample_image(folder / "in.exr", folder / "out.exr", test::kUpsample);
    EXPECT_TRUE(made) << name << ": " << made.error().message;
    if (!made) continue;
    const Imf::Header header = test::read_picture(folder / "out.exr").header;
    EXPECT_TRUE(header.find(name) != header.end()) << name;
    if (header.find(name) == header.end()) continue;
    EXPECT_EQ(test::attribute_bytes(header[name]), test::attribute_bytes(*attribute)) << name;
  }
}

TEST(PassThrough, SubsampledChannelsAreLeftOutAndNamed) {
  const test::TempFolder folder;
  test::Picture picture = test::blank(64, 32);
  test::add_rgb_noise(picture, Imf::HALF);
  Imf::FrameBuffer frame = picture.frame_buffer();
  picture.header.channels().insert("fog", Imf::Channel(Imf::HALF, 2, 2));
  std::vector<half> fog(32 * 16, half(0.5F));
  frame.insert("fog", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(fog.data()), 2, 64, 2, 2));
  {
    Imf::OutputFile file((folder / "in.exr").c_str(), picture.header);
    file.setFrameBuffer(frame);
    file.writePixels(32);
  }
  const auto made = upsample_image(folder / "in.exr", folder / "out.exr", test::kUpsample);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_THAT(made->notes,
              testing::ElementsAre(testing::HasSubstr("\"fog\" is left out"), kAssumedSpaceNote));
  EXPECT_EQ(test::read_picture(folder / "out.exr").header.channels().findChannel("fog"), nullptr);
}

}  // namespace
}  // namespace spectile
