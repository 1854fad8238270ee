// Spectral images in the forms that other programs write them.
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

/// Channels of a flat spectrum of noise, one for each name.
void add_bands(test::Picture& picture, const std::vector<std::string>& names,
               Imf::PixelType type = Imf::FLOAT) {
  for (const std::string& name : names) {
    picture.add(name, type, [](int x, int y) { return test::noise(x, y, 1); });
  }
}

const std::vector<std::string> kNames = {"T.450,000000nm", "T.500,000000nm", "T.550,000000nm",
                                         "T.600,000000nm"};

class SpectralSourceImages : public testing::Test {
 protected:
  std::map<std::string, test::Plane> projected(const std::string& input,
                                               const ProjectImageOptions& options = kFloat) {
    report_ = project_image(input, folder_ / "out.exr", options);
    if (!report_) {
      ADD_FAILURE() << report_.error().message;
      return {};
    }
    return test::read_picture(folder_ / "out.exr").planes;
  }

  std::map<std::string, test::Plane> plain() {
    test::Picture picture = test::blank(70, 35);
    add_bands(picture, kNames);
    test::write_scanlines(folder_ / "plain.exr", picture);
    return projected(folder_ / "plain.exr");
  }

  static ProjectImageOptions float_options() {
    ProjectImageOptions options;
    options.pixel = SampleType::kFloat;
    return options;
  }

  static inline const ProjectImageOptions kFloat = float_options();
  test::TempFolder folder_;
  Result<ImageReport> report_ = Error{};
};

TEST_F(SpectralSourceImages, OrderAndSpellingOfNamesDoNotMatter) {
  const auto expected = plain();
  test::Picture picture = test::blank(70, 35);
  add_bands(picture, {"T.0,5um", "T.4.5e-7m", "T.600nm", "T.550.0nm"});
  test::write_scanlines(folder_ / "in.exr", picture);
  const auto other = projected(folder_ / "in.exr");
  ASSERT_EQ(other.size(), 3U);
  for (const auto& [name, plane] : expected) {
    for (std::size_t i = 0; i < 70 * 35; ++i) {
      // Wavelengths in metres are off by some 1e-16 of themselves; weights then by a rounding of float.
      ASSERT_NEAR(other.at(name).at(i), plane.at(i), 1e-6) << name;
    }
  }
}

TEST_F(SpectralSourceImages, TilesAndLaterPartsAreFound) {
  const auto expected = plain();
  test::Picture picture = test::blank(70, 35);
  add_bands(picture, kNames);
  test::write_tiles(folder_ / "tiles.exr", picture, 16, true);
  EXPECT_TRUE(projected(folder_ / "tiles.exr") == expected);

  test::Picture first = test::blank(70, 35);
  test::add_rgb_noise(first, Imf::HALF);
  test::Picture second = test::blank(70, 35);
  add_bands(second, kNames);
  first.header.setName("beauty");
  second.header.setName("spectrum");
  first.header.setType(Imf::SCANLINEIMAGE);
  second.header.setType(Imf::SCANLINEIMAGE);
  const Imf::Header headers[] = {first.header, second.header};
  {
    Imf::MultiPartOutputFile file((folder_ / "parts.exr").c_str(), headers, 2);
    int i = 0;
    for (test::Picture* picture_of_part : {&first, &second}) {
      Imf::OutputPart part(file, i++);
      part.setFrameBuffer(picture_of_part->frame_buffer());
      part.writePixels(35);
    }
  }
  EXPECT_TRUE(projected(folder_ / "parts.exr") == expected);
}

TEST_F(SpectralSourceImages, HalfSamplesAreTakenAsTheyAre) {
  test::Picture halves = test::blank(70, 35);
  add_bands(halves, kNames, Imf::HALF);
  test::write_scanlines(folder_ / "half.exr", halves);
  test::Picture floats = test::blank(70, 35);
  for (const std::string& name : kNames) {
    floats.add(name, Imf::FLOAT, [&](int x, int y) { return halves.at(name, x, y); });
  }
  test::write_scanlines(folder_ / "float.exr", floats);
  EXPECT_TRUE(projected(folder_ / "half.exr") == projected(folder_ / "float.exr"));
}

TEST_F(SpectralSourceImages, QuantityIsChosenWhereAFileHoldsBoth) {
  test::Picture picture = test::blank(70, 35);
  add_bands(picture, kNames);
  for (const char* name : {"S0.450nm", "S0.550nm", "S0.650nm"}) {
    picture.add(name, Imf::FLOAT, [](int, int) { return 2.0; });
  }
  // The other Stokes components are no colour.
  for (const char* name : {"S1.450nm", "S2.450nm", "S3.450nm"}) {
    picture.add(name, Imf::FLOAT, [](int, int) { return -1.0; });
  }
  test::write_scanlines(folder_ / "both.exr", picture);
  const auto expected = plain();
  EXPECT_TRUE(projected(folder_ / "both.exr") == expected);
  EXPECT_EQ(report_->quantity, Quantity::kReflectance);
  ProjectImageOptions options = kFloat;
  options.target = ColorTarget::kLuminance;
  options.quantity = Quantity::kIlluminant;
  const auto light = projected(folder_ / "both.exr", options);
  EXPECT_EQ(report_->bands, 3U);
  // Y is 1 for a spectrum of 1: three products and two sums, each rounded, of weights rounded once.
  EXPECT_NEAR(light.at("Y").at(0), 2, 2 * 5 * 0x1p-24);
  options.quantity = Quantity::kReflectance;
  const auto report = project_image(folder_ / "plain.exr", folder_ / "x.exr", options);
  EXPECT_TRUE(report);
  options.quantity = Quantity::kIlluminant;
  const auto none = project_image(folder_ / "plain.exr", folder_ / "y.exr", options);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, testing::HasSubstr("emission"));
}

TEST_F(SpectralSourceImages, LightTakesNoIlluminant) {
  test::Picture picture = test::blank(7, 3);
  add_bands(picture, {"S0.450nm", "S0.550nm"});
  test::write_scanlines(folder_ / "light.exr", picture);
  ProjectImageOptions options;
  options.light = *illuminant("A");
  const auto report = project_image(folder_ / "light.exr", folder_ / "out.exr", options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
}

TEST_F(SpectralSourceImages, TwoChannelsOfOneWavelengthAreAnError) {
  test::Picture picture = test::blank(7, 3);
  add_bands(picture, {"T.550nm", "T.550,0nm"});
  test::write_scanlines(folder_ / "twins.exr", picture);
  const auto report = project_image(folder_ / "twins.exr", folder_ / "out.exr", test::kProject);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadFile);
}

TEST_F(SpectralSourceImages, ABandFarBeyondSightIsVerifiedAtOnce) {
  // Would be integrated in steps of a fraction of a nanometre, for years.
  test::Picture picture = test::blank(9, 6);
  for (const char* name : {"T.500nm", "T.600nm", "T.5e+7m"}) {
    picture.add(name, Imf::FLOAT, [](int x, int y) { return test::noise(x, y, 1); });
  }
  test::write_scanlines(folder_ / "far.exr", picture);
  MethodOptions options;
  options.threads = 1;
  const auto report = verify_image(folder_ / "far.exr", options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->ok());
}

}  // namespace
}  // namespace spectile
