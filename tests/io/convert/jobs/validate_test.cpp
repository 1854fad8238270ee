// Files against the rules of the layout: one that follows all of them, and for each rule one that breaks it.
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <spectile/image/convert.hpp>

#include "src/io/channels/layout_rules.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

void add(Picture& picture, const std::string& name, double value = 0.5) {
  picture.add(name, Imf::HALF, [=](int, int) { return value; });
}

void remove(Picture& picture, const std::string& name) {
  picture.planes.erase(name);
  Imf::ChannelList kept;
  for (auto it = picture.header.channels().begin(); it != picture.header.channels().end(); ++it) {
    if (it.name() != name) kept.insert(it.name(), it.channel());
  }
  picture.header.channels() = kept;
}

void rename(Picture& picture, const std::string& from, const std::string& to) {
  remove(picture, from);
  add(picture, to);
}

void set(Picture& picture, const char* name, const char* text) {
  picture.header.insert(name, Imf::StringAttribute(text));
}

/// Polarised light and reflectance with re-radiation, as the layout wants it.
Picture valid_picture() {
  Picture picture = blank(6, 4);
  for (const char* name :
       {"R", "G", "B", "T.500,000000nm", "T.510,000000nm", "T.500,000000nm.510,000000nm"}) {
    add(picture, name);
  }
  for (int component = 0; component < 4; ++component) {
    for (const char* nm : {"500,000000nm", "510,000000nm"}) {
      add(picture, "S" + std::to_string(component) + "." + nm, component == 0 ? 3 : -0.5);
    }
  }
  set(picture, "spectralLayoutVersion", "1.0");
  set(picture, "emissiveUnits", "W.m^-2.sr^-1");
  set(picture, "polarisationHandedness", "right");
  set(picture, "lensTransmission", "400nm:0.5;0.7um:1e-1;");
  set(picture, "cameraResponse", "400nm:1;");
  set(picture, "S0.500,000000nm", "490nm:0;500.5nm:1;");
  picture.header.insert("EV", Imf::FloatAttribute(0));
  return picture;
}

class ValidateImages : public testing::Test {
 protected:
  std::vector<LayoutFinding> findings() const {
    const auto found = validate_image(path_);
    EXPECT_TRUE(found) << found.error().message;
    return found ? *found : std::vector<LayoutFinding>();
  }
  /// "rule: detail" of each finding of a picture, "remark: rule: detail" of a remark.
  std::vector<std::string> texts(Picture& picture) const {
    write_scanlines(path_, picture);
    std::vector<std::string> out;
    for (const LayoutFinding& f : findings()) {
      out.push_back((f.remark ? "remark: " : "") + f.rule + ": " + f.detail);
    }
    return out;
  }

  TempFolder folder_;
  const std::string path_ = folder_ / "x.exr";
};

TEST_F(ValidateImages, OneFollowsAllRules) {
  Picture picture = valid_picture();
  EXPECT_THAT(texts(picture), IsEmpty());
}

TEST_F(ValidateImages, AttributesThatAreMissingOrWrong) {
  const struct {
    const char* name;
    const char* wrong;  // null: missing
    const char* finding;
  } kCases[] = {
      {"spectralLayoutVersion", nullptr, "version: no attribute spectralLayoutVersion"},
      {"spectralLayoutVersion", "2.0", "version: spectralLayoutVersion is \"2.0\", not \"1.0\""},
      {"emissiveUnits", nullptr, "units: emission without an attribute emissiveUnits"},
      {"emissiveUnits", "lx", "remark: units: emissiveUnits is \"lx\""},
      {"polarisationHandedness", nullptr, "handedness: polarised light without"},
      {"polarisationHandedness", "up", "handedness: polarisationHandedness is \"up\""},
      {"lensTransmission", "400nm=1", "curve: attribute lensTransmission is no list"},
      {"cameraResponse", "", "curve: attribute cameraResponse is no list"},
      {"S0.500,000000nm", "500,0nm:1;", "curve: attribute S0.500,000000nm is no list"},
  };
  for (const auto& c : kCases) {
    Picture picture = valid_picture();
    picture.header = test::without(picture.header, c.name);
    if (c.wrong != nullptr) set(picture, c.name, c.wrong);
    EXPECT_THAT(texts(picture), ElementsAre(HasSubstr(c.finding)));
  }
  Picture picture = valid_picture();
  picture.header = test::without(picture.header, "EV");
  picture.header.insert("EV", Imf::IntAttribute(1));
  EXPECT_THAT(texts(picture), ElementsAre("exposure: attribute EV is int, not float"));
}

TEST_F(ValidateImages, ChannelNames) {
  for (const char* name : {"T.510.5nm", "T.520nM", "S0.520", "T.500,0nm.510.0nm", "S4.500nm"}) {
    Picture picture = valid_picture();
    if (std::string(name).starts_with("T.510.5")) {
      // With the decimal point the reader here takes it, and the layout does not.
      rename(picture, "T.500,000000nm.510,000000nm", name);
    } else {
      add(picture, name);
    }
    const auto found = texts(picture);
    ASSERT_FALSE(found.empty()) << name;
    EXPECT_EQ(found[0],
              "channel-name: not S0, S1, S2, S3 or T, a point, a number with a decimal comma, m or Hz: "
              "\"" +
                  std::string(name) + "\"");
  }
}

TEST_F(ValidateImages, OtherDialectsAndLayers) {
  Picture picture = valid_picture();
  add(picture, "400.00-410.00nm");
  add(picture, "410.00-420.00nm");
  EXPECT_THAT(texts(picture), ElementsAre("dialect: channels named in another way than the layout's: "
                                          "\"400.00-410.00nm\" and 1 more"));
  Picture layered = valid_picture();
  add(layered, "fog.S0.500,000000nm");
  EXPECT_THAT(texts(layered), ElementsAre("layer: a layer or view before the names of spectral channels: "
                                          "\"fog.S0.500,000000nm\""));
}

TEST_F(ValidateImages, StokesComponents) {
  Picture picture = valid_picture();
  rename(picture, "S2.510,000000nm", "S2.520,000000nm");
  EXPECT_THAT(texts(picture), ElementsAre("stokes: the wavelengths of S2 are not those of S0"));
  Picture alone = blank(3, 2);
  for (const char* name : {"R", "G", "B", "S1.500nm"}) add(alone, name);
  set(alone, "spectralLayoutVersion", "1.0");
  set(alone, "emissiveUnits", "W.m^-2.sr^-1");
  set(alone, "polarisationHandedness", "left");
  EXPECT_THAT(texts(alone), ElementsAre("stokes: S1 without S0"));
}

TEST_F(ValidateImages, OneWavelengthTwice) {
  Picture picture = valid_picture();
  rename(picture, "T.510,000000nm", "T.0,5um");
  const auto found = texts(picture);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0], "duplicate: \"T.0,5um\" and \"T.500,000000nm\" are of one wavelength");
}

TEST_F(ValidateImages, Reradiation) {
  Picture picture = valid_picture();
  rename(picture, "T.500,000000nm.510,000000nm", "T.510,000000nm.500,000000nm");
  EXPECT_THAT(texts(picture),
              ElementsAre("reradiation: \"T.510,000000nm.500,000000nm\" does not emit at a longer "
                          "wavelength than it absorbs"));
  Picture other = valid_picture();
  add(other, "T.500nm.600nm");
  EXPECT_THAT(texts(other),
              ElementsAre("reradiation: \"T.500,000000nm.600,000000nm\" needs a channel T of both of "
                          "its wavelengths"));
}

TEST_F(ValidateImages, SubsampledChannels) {
  Picture picture = valid_picture();
  picture.planes.erase("S3.510,000000nm");
  picture.header.channels().insert("S3.510,000000nm", Imf::Channel(Imf::HALF, 2, 2));
  EXPECT_THAT(texts(picture),
              ElementsAre("subsampled: spectral channels that are subsampled: \"S3.510,000000nm\""));
}

TEST_F(ValidateImages, RemarksBreakNoRule) {
  Picture picture = valid_picture();
  for (const char* name : {"R", "G"}) remove(picture, name);
  EXPECT_THAT(texts(picture),
              ElementsAre("remark: preview: no channels R, G, B, which other programs would show"));
  Picture samples = valid_picture();
  samples.planes.at("T.500,000000nm").set(0, -1);
  samples.planes.at("T.500,000000nm").set(1, 2);
  samples.planes.at("T.510,000000nm").set(2, 1.5);
  samples.planes.at("S0.500,000000nm").set(3, -1);
  samples.planes.at("S1.500,000000nm").set(3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(texts(samples), ElementsAre("remark: samples: 1 sample not finite",
                                          "remark: samples: 1 sample of reflectance below 0",
                                          "remark: samples: 2 samples of reflectance above 1",
                                          "remark: samples: 1 sample of light below 0"));
  Picture two = blank(2, 2);
  for (const char* name : {"R", "G", "B", "T.500nm", "S0.510nm"}) add(two, name);
  set(two, "spectralLayoutVersion", "1.0");
  set(two, "emissiveUnits", "W.m^-2.sr^-1");
  EXPECT_THAT(texts(two), ElementsAre(HasSubstr("remark: wavelengths: those of T are not those of S0")));
}

TEST_F(ValidateImages, WithoutSpectra) {
  Picture picture = blank(2, 2);
  add_rgb_noise(picture, Imf::HALF);
  EXPECT_THAT(texts(picture), ElementsAre(HasSubstr("channels: no spectral channels")));
}

TEST_F(ValidateImages, DeepPartsAndOthers) {
  Picture flat = valid_picture();
  flat.header.setName("flat");
  flat.header.setType(Imf::SCANLINEIMAGE);
  flat.header = test::without(flat.header, "polarisationHandedness");
  Imf::Header deep(6, 4);
  deep.setName("deep");
  deep.setType(Imf::DEEPSCANLINE);
  deep.compression() = Imf::ZIPS_COMPRESSION;
  for (const char* name : {"R", "G", "B", "T.500nm"}) deep.channels().insert(name, Imf::Channel(Imf::HALF));
  set(flat, "owner", "me");
  deep.insert("spectralLayoutVersion", Imf::StringAttribute("1.0"));
  const std::vector<Imf::Header> headers = {flat.header, deep};
  {
    Imf::MultiPartOutputFile file(path_.c_str(), headers.data(), 2);
    Imf::OutputPart part(file, 0);
    part.setFrameBuffer(flat.frame_buffer());
    part.writePixels(4);
  }
  const auto found = findings();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].detail, "part 0: polarised light without an attribute polarisationHandedness");
  EXPECT_EQ(found[1].rule, "deep");
  EXPECT_EQ(found[1].detail, "part 1: spectral channels are in a deep part");
}

TEST_F(ValidateImages, FilesThatCannotBeReadAreErrors) {
  EXPECT_EQ(validate_image(folder_ / "none.exr").error().code, ErrorCode::kBadFile);
  write_text(path_, "not an image");
  EXPECT_EQ(validate_image(path_).error().code, ErrorCode::kBadFile);
}

TEST(LayoutCurves, AreListsOfWavelengthsAndValues) {
  for (const char* text : {"400nm:0.5;", "400nm:0.5;410.25nm:1e-3;", "4e-7m:1;", "600THz:0;", "0.5um:-1;"}) {
    EXPECT_TRUE(io::is_curve_text(text)) << text;
  }
  for (const char* text : {"", "400nm:0.5", "400:0.5;", "400nm:;", ":1;", "400nm:1,5;", "400,5nm:1;", "x",
                           "400nm:1; ", "400nm:nan;", "1.2.3nm:1;"}) {
    EXPECT_FALSE(io::is_curve_text(text)) << text;
  }
}

}  // namespace
}  // namespace spectile::test
