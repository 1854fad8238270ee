// The channels that hold a colour: however they are spelled, in whatever layer or view, and what is said of
// it.
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <spectile/image/image.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ColorChoice : public testing::Test {
 protected:
  /// Three channels of the values 0.25, 0.5, 0.75.
  static void add(Picture& picture, const std::array<std::string, 3>& names) {
    for (int k = 0; k < 3; ++k) {
      picture.add(names[static_cast<std::size_t>(k)], Imf::FLOAT, [=](int, int) { return 0.25 * (k + 1); });
    }
  }
  /// The notes of upsampling; `r` is the first component that was taken.
  std::vector<std::string> notes(Picture& picture) {
    write_scanlines(in_, picture);
    UpsampleImageOptions options = options_;
    options.input_space = RgbSpace();  // stated, so that notes are of channels only
    options.pixel = SampleType::kFloat;
    const auto report = upsample_image(in_, out_, options);
    EXPECT_TRUE(report) << report.error().message;
    if (!report) return {};
    r = read_picture(out_).at("R", 0, 0);
    return report->notes;
  }
  std::string error(Picture& picture) {
    write_scanlines(in_, picture);
    const auto report = upsample_image(in_, out_, options_);
    EXPECT_FALSE(report);
    return report ? std::string() : report.error().message;
  }

  TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
  UpsampleImageOptions options_;
  double r = 0;
};

TEST_F(ColorChoice, PlainNamesNeedNoNote) {
  Picture picture = blank(2, 2);
  add(picture, {"R", "G", "B"});
  EXPECT_THAT(notes(picture), IsEmpty());
  EXPECT_EQ(r, 0.25);
}

TEST_F(ColorChoice, OtherSpellingsAreSaid) {
  const std::array<std::string, 3> spellings[] = {
      {"r", "g", "b"}, {"red", "green", "blue"}, {"Red", "Green", "Blue"}, {"RED", "GREEN", "BLUE"}};
  for (const auto& names : spellings) {
    Picture picture = blank(2, 2);
    add(picture, names);
    EXPECT_THAT(notes(picture), ElementsAre("channels " + names[0] + ", " + names[1] + ", " + names[2] +
                                            " are taken for R, G, B"));
    EXPECT_EQ(r, 0.25);
  }
}

TEST_F(ColorChoice, CapitalsComeBeforeOtherSpellings) {
  Picture picture = blank(2, 2);
  add(picture, {"B", "G", "R"});
  add(picture, {"r", "g", "b"});
  EXPECT_THAT(notes(picture), IsEmpty());
  EXPECT_EQ(r, 0.75);
}

TEST_F(ColorChoice, TheOnlyLayerIsTaken) {
  Picture picture = blank(2, 2);
  add(picture, {"ViewLayer.Diffuse.R", "ViewLayer.Diffuse.G", "ViewLayer.Diffuse.B"});
  EXPECT_THAT(notes(picture),
              ElementsAre("layer \"ViewLayer.Diffuse\", the only one with colours, is taken"));
  EXPECT_EQ(r, 0.25);
}

TEST_F(ColorChoice, TheMainLayerOfAProgramIsTaken) {
  for (const char* layer : {"rgba", "ViewLayer.Combined"}) {
    Picture picture = blank(2, 2);
    const std::string l = layer;
    add(picture, {"AO.B", "AO.G", "AO.R"});
    add(picture, {l + ".R", l + ".G", l + ".B"});
    EXPECT_THAT(notes(picture), ElementsAre("layer \"" + l + "\" is taken"));
    EXPECT_EQ(r, 0.25);
  }
}

TEST_F(ColorChoice, OneOfSeveralLayersMustBeNamed) {
  Picture picture = blank(2, 2);
  add(picture, {"key.R", "key.G", "key.B"});
  add(picture, {"fill.B", "fill.G", "fill.R"});
  const std::string message = error(picture);
  EXPECT_THAT(message, HasSubstr("--layer"));
  EXPECT_THAT(message, HasSubstr("key.R, key.G, key.B"));
  EXPECT_THAT(message, HasSubstr("fill.R, fill.G, fill.B"));
  options_.channels.layer = "key";
  EXPECT_THAT(notes(picture), IsEmpty());
  EXPECT_EQ(r, 0.25);
}

TEST_F(ColorChoice, AFileWithoutColourListsItsChannels) {
  Picture picture = blank(2, 2);
  picture.add("Z", Imf::FLOAT, [](int, int) { return 1; });
  picture.add("N.X", Imf::FLOAT, [](int, int) { return 1; });
  EXPECT_THAT(error(picture), HasSubstr("has no channels R, G, B (nor Y); it has channels N.X, Z"));
}

TEST_F(ColorChoice, OtherViewsStayBehindAndAreNamed) {
  Picture picture = blank(2, 2);
  picture.header.insert("multiView", Imf::StringVectorAttribute({"left", "right"}));
  add(picture, {"R", "G", "B"});
  add(picture, {"right.B", "right.G", "right.R"});
  EXPECT_THAT(notes(picture), Contains("left out: view right (see --view)"));
  EXPECT_EQ(r, 0.25);
  EXPECT_FALSE(read_picture(out_).planes.contains("right.R"));
  options_.channels.view = "right";
  notes(picture);
  EXPECT_EQ(r, 0.75);
}

TEST_F(ColorChoice, XyzIsXyz) {
  // Never Y alone as grey: the colour comes back from the tool's own XYZ.
  Picture picture = blank(2, 2);
  picture.add("R", Imf::FLOAT, [](int, int) { return 0.6; });
  picture.add("G", Imf::FLOAT, [](int, int) { return 0.1; });
  picture.add("B", Imf::FLOAT, [](int, int) { return 0.05; });
  write_scanlines(in_, picture);
  UpsampleImageOptions up;
  up.pixel = SampleType::kFloat;
  ProjectImageOptions down;
  down.pixel = SampleType::kFloat;
  ASSERT_TRUE(upsample_image(in_, folder_ / "a.exr", up));
  down.target = ColorTarget::kXyz;
  ASSERT_TRUE(project_image(folder_ / "a.exr", folder_ / "xyz.exr", down));
  const auto report = upsample_image(folder_ / "xyz.exr", folder_ / "b.exr", up);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->notes, Contains("channels X, Y, Z are taken for CIE XYZ under D65"));
  down.target = ColorTarget::kSrgb;
  ASSERT_TRUE(project_image(folder_ / "b.exr", out_, down));
  const Picture back = read_picture(out_);
  // Bands from 400 to 700 nm cut off a little of XYZ.
  EXPECT_NEAR(back.at("R", 0, 0), 0.6, 0.003);
  EXPECT_NEAR(back.at("G", 0, 0), 0.1, 0.003);
  EXPECT_NEAR(back.at("B", 0, 0), 0.05, 0.003);
}

TEST_F(ColorChoice, XyzOutputsSayTheirSpace) {
  Picture picture = blank(2, 2);
  add(picture, {"R", "G", "B"});
  write_scanlines(in_, picture);
  RelightImageOptions options(NamedLight{"A", *illuminant("A")});
  options.target = ColorTarget::kXyz;
  ASSERT_TRUE(relight_image(in_, out_, options));
  EXPECT_THAT(inspect_image(out_)->attributes,
              Contains(testing::Pair("colorInteropID", "lin_ciexyzd65_scene")));
}

TEST_F(ColorChoice, InformationListsAllThereIs) {
  Picture picture = blank(3, 2);
  picture.header.insert("multiView", Imf::StringVectorAttribute({"left", "right"}));
  picture.header.insert("exposure.time", Imf::DoubleAttribute(0.125));
  add(picture, {"R", "G", "B"});
  add(picture, {"right.B", "right.G", "right.R"});
  picture.add("A", Imf::HALF, [](int, int) { return 1; });
  picture.add("glow.S0.500,0nm", Imf::FLOAT, [](int, int) { return 1; });
  picture.add("S1.500,0nm", Imf::FLOAT, [](int, int) { return 1; });
  write_scanlines(in_, picture);
  const auto info = inspect_image(in_);
  ASSERT_TRUE(info) << info.error().message;
  ASSERT_EQ(info->part_list.size(), 1U);
  EXPECT_EQ(info->part_list[0].channels, 9U);
  EXPECT_EQ(info->alpha, "A");
  EXPECT_EQ(info->dialect, "spectral layout");
  EXPECT_THAT(info->attributes, Contains(testing::Pair("exposure.time", "0.125")));
  EXPECT_THAT(info->attributes, Contains(testing::Pair("multiView", "left, right")));
  for (const char* text :
       {"1 band of emission, layer \"glow\", view \"left\"", "1 channel of polarised light",
        "colour R, G, B of view \"left\"", "colour right.R, right.G, right.B of view \"right\""}) {
    EXPECT_THAT(info->contents, Contains(HasSubstr(text))) << text;
  }
}

}  // namespace
}  // namespace spectile::test
