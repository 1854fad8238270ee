// Attributes: those that describe what an output does not hold any more are not in it, and a note names them.
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfPreviewImage.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spectile/image/average.hpp>
#include <spectile/image/image.hpp>
#include <spectile/spectra/named_spectra.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;
using testing::Not;

class ImageAttributes : public testing::Test {
 protected:
  ImageAttributes() : picture_(test::blank(20, 20)) { test::add_rgb_noise(picture_, Imf::HALF); }

  void text(const char* name, const std::string& value) {
    picture_.header.insert(name, Imf::StringAttribute(value));
  }
  /// All that describes R, G, B or the samples of the file.
  void describe_pixels() {
    text("oiio:SHA-1", "0123456789ABCDEF");
    text("oiio:AverageColor", "0.5,0.5,0.5");
    text("oiio:ConstantColor", "0.5,0.5,0.5");
    text("oiio:ColorSpace", "ACEScg");
    text("owner", "me");
    picture_.header.insert("acesImageContainerFlag", Imf::IntAttribute(1));
    picture_.header.insert("adoptedNeutral", Imf::V2fAttribute({0.32F, 0.33F}));
    picture_.header.insert("whiteLuminance", Imf::FloatAttribute(100));
    const std::vector<Imf::PreviewRgba> thumb(4, Imf::PreviewRgba(1, 2, 3, 4));
    picture_.header.setPreviewImage(Imf::PreviewImage(2, 2, thumb.data()));
  }
  /// A spectral image of reflectances by other hands, with all of the layout's optional attributes.
  void make_spectral() {
    for (int nm = 400; nm <= 700; nm += 50) {
      const std::string name = "T." + std::to_string(nm) + ",000000nm";
      picture_.add(name, Imf::HALF, [nm](int x, int y) { return test::noise(x, y, nm); });
      text(name.c_str(), "390nm:0;" + std::to_string(nm) + "nm:1;");
    }
    text("spectralLayoutVersion", "1.0");
    text("polarisationHandedness", "right");
    text("lensTransmission", "400nm:0.9;");
    text("cameraResponse", "400nm:0.8;");
    text("T.800,000000nm", "a curve of a channel that went before");
    picture_.header.insert("EV", Imf::FloatAttribute(1.5F));
  }
  Imf::Header header_of(const std::string& name, const Result<ImageReport>& report) {
    EXPECT_TRUE(report) << report.error().message;
    report_ = report ? *report : ImageReport{};
    return report ? test::read_picture(folder_ / name).header : Imf::Header();
  }
  Imf::Header upsampled() {
    test::write_scanlines(folder_ / "in.exr", picture_);
    UpsampleImageOptions options;
    options.bands = *Bands::uniform(400, 700, 25);
    return header_of("up.exr", upsample_image(folder_ / "in.exr", folder_ / "up.exr", options));
  }
  Imf::Header relit() {
    test::write_scanlines(folder_ / "in.exr", picture_);
    const RelightImageOptions options(*find_light("A"));
    return header_of("lit.exr", relight_image(folder_ / "in.exr", folder_ / "lit.exr", options));
  }
  Imf::Header projected() {
    test::write_scanlines(folder_ / "in.exr", picture_);
    return header_of("p.exr", project_image(folder_ / "in.exr", folder_ / "p.exr", test::kProject));
  }
  static bool has(const Imf::Header& header, const std::string& name) {
    return header.find(name) != header.end();
  }
  std::string notes() const {
    std::string out;
    for (const std::string& note : report_.notes) out += note + "\n";
    return out;
  }

  const test::TempFolder folder_;
  test::Picture picture_;
  ImageReport report_;
};

TEST_F(ImageAttributes, OfPixelsGoWhereColoursAreNew) {
  describe_pixels();
  const Imf::Header out = relit();
  for (const char* name : {"oiio:SHA-1", "oiio:AverageColor", "oiio:ConstantColor", "oiio:ColorSpace",
                           "acesImageContainerFlag", "adoptedNeutral", "whiteLuminance", "preview"}) {
    EXPECT_FALSE(has(out, name)) << name;
  }
  EXPECT_TRUE(has(out, "owner"));
  EXPECT_EQ(report_.notes.size(), 1U);
  for (const char* name : {"oiio:SHA-1", "acesImageContainerFlag", "adoptedNeutral", "preview"}) {
    EXPECT_THAT(notes(), HasSubstr(name));
  }
  EXPECT_THAT(notes(), Not(HasSubstr("owner")));
}

TEST_F(ImageAttributes, OfTheColoursStayWhereTheyDo) {
  describe_pixels();
  const Imf::Header out = upsampled();
  for (const char* name : {"oiio:SHA-1", "oiio:AverageColor", "oiio:ConstantColor", "acesImageContainerFlag"})
    EXPECT_FALSE(has(out, name)) << name << ": there are more channels now";
  for (const char* name : {"oiio:ColorSpace", "adoptedNeutral", "whiteLuminance", "preview", "owner"})
    EXPECT_TRUE(has(out, name)) << name;
}

TEST_F(ImageAttributes, OfTheLayoutGoWithItsChannels) {
  make_spectral();
  const Imf::Header out = projected();
  for (auto it = out.begin(); it != out.end(); ++it) {
    const std::string name = it.name();
    EXPECT_FALSE(name.starts_with("T.") || name == "EV" || name == "lensTransmission" ||
                 name == "cameraResponse" || name == "polarisationHandedness" ||
                 name == "spectralLayoutVersion")
        << name;
  }
  EXPECT_THAT(notes(), HasSubstr("EV"));
  EXPECT_THAT(notes(), HasSubstr(" more"));
}

TEST_F(ImageAttributes, OfAnotherLayoutAreNotThoseOfNewSpectra) {
  text("T.400,000000nm", "a curve");
  text("lensTransmission", "400nm:0.9;");
  picture_.header.insert("EV", Imf::FloatAttribute(1.5F));
  const Imf::Header out = upsampled();
  EXPECT_FALSE(has(out, "T.400,000000nm"));
  EXPECT_FALSE(has(out, "lensTransmission"));
  EXPECT_FALSE(has(out, "EV"));
}

TEST_F(ImageAttributes, NamedAfterAChannelThatIsGoneAreGone) {
  make_spectral();
  text("T.450,000000nm.wavelength", "4.5e-7");
  text("fog.density", "3");
  picture_.add("fog", Imf::HALF, [](int, int) { return 0.5; });
  const Imf::Header out = projected();
  EXPECT_FALSE(has(out, "T.450,000000nm.wavelength"));
  EXPECT_TRUE(has(out, "fog.density"));
}

TEST_F(ImageAttributes, HintsInACommentGoWithoutTheComment) {
  text("comments", "by me oiio:SHA-1=0123ABCD at night oiio:ConstantColor=1,1,1");
  EXPECT_EQ(relit().typedAttribute<Imf::StringAttribute>("comments").value(), "by me at night");
}

TEST_F(ImageAttributes, MultiViewNamesTheViewThatIsLeft) {
  picture_.header.insert("multiView", Imf::StringVectorAttribute({"left", "right", "top"}));
  test::add_rgb_noise(picture_, Imf::HALF, 1, "right.");
  const Imf::Header out = upsampled();
  ASSERT_TRUE(has(out, "multiView"));
  EXPECT_THAT(out.typedAttribute<Imf::StringVectorAttribute>("multiView").value(),
              testing::ElementsAre("left"));
}

TEST_F(ImageAttributes, ManifestsGoWithTheirChannels) {
  text("cryptomatte/0a1b2c3/name", "Objects");
  text("cryptomatte/0a1b2c3/hash", "MurmurHash3_32");
  text("cryptomatte/d4e5f60/name", "Materials");
  picture_.add("Objects00.R", Imf::FLOAT, [](int, int) { return 1e20; });
  const Imf::Header out = upsampled();
  EXPECT_TRUE(has(out, "cryptomatte/0a1b2c3/name"));
  EXPECT_TRUE(has(out, "cryptomatte/0a1b2c3/hash"));
  EXPECT_FALSE(has(out, "cryptomatte/d4e5f60/name"));
}

TEST_F(ImageAttributes, AveragesKeepWhatIsSaidOfTheirKind) {
  describe_pixels();
  picture_.header.insert("EV", Imf::FloatAttribute(1.5F));
  test::write_scanlines(folder_ / "a.exr", picture_);
  const std::vector<std::string> inputs(2, folder_ / "a.exr");
  const Imf::Header out = header_of("mean.exr", average_images(inputs, folder_ / "mean.exr", {}));
  for (const char* name :
       {"oiio:SHA-1", "oiio:AverageColor", "oiio:ConstantColor", "acesImageContainerFlag", "preview"}) {
    EXPECT_FALSE(has(out, name)) << name;
    EXPECT_THAT(notes(), HasSubstr(name));
  }
  for (const char* name : {"oiio:ColorSpace", "adoptedNeutral", "whiteLuminance", "EV", "owner"})
    EXPECT_TRUE(has(out, name)) << name;
}

}  // namespace
}  // namespace spectile
