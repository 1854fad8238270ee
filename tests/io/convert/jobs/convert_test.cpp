// Conversion of spectral images: names, bits, what is chosen and refused, and what passes through.
#include <OpenEXR/ImfTiledInputFile.h>

#include <limits>

#include "tests/io/convert/jobs/convert_files.hpp"

namespace spectile::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kDoubleNan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> names_of(const Picture& picture) {
  std::vector<std::string> out;
  for (const auto& [name, plane] : picture.planes) out.push_back(name);
  return out;
}

TEST_F(ConvertImages, OfEveryDialectKeepTheirBitsInEveryOther) {
  for (const std::string& from : spectral_dialects()) {
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
      for (const std::string& to : spectral_dialects()) {
        Picture picture = spectral_picture(from, type);
        ConvertImageOptions options;
        options.dialect = to;
        const ImageReport report = convert(picture, options);
        EXPECT_EQ(report.bands, 3U);
        EXPECT_EQ(report.quantity, Quantity::kIlluminant);
        const Picture got = output();
        ASSERT_THAT(names_of(got), testing::UnorderedElementsAreArray(three_names(to))) << from << " " << to;
        for (std::size_t b = 0; b < 3; ++b) {
          EXPECT_TRUE(got.planes.at(three_names(to)[b]) == picture.planes.at(three_names(from)[b]))
              << from << " to " << to << ", band " << b;
        }
        // Read back, they are the same bands.
        const auto info = inspect_image(out_);
        ASSERT_TRUE(info) << info.error().message;
        for (std::size_t b = 0; b < 3; ++b) {
          EXPECT_NEAR((*info->bands)[b].lower_nm, 400 + 10.0 * static_cast<double>(b), 1e-6);
          EXPECT_NEAR((*info->bands)[b].upper_nm, 410 + 10.0 * static_cast<double>(b), 1e-6);
        }
      }
    }
  }
}

TEST_F(ConvertImages, ToTheLayoutFollowIt) {
  for (const std::string& from : spectral_dialects()) {
    Picture picture = spectral_picture(from, Imf::HALF);
    convert(picture);
    EXPECT_EQ(text("spectralLayoutVersion"), "1.0");
    EXPECT_EQ(text("emissiveUnits"), "W.m^-2.sr^-1");
    const auto findings = validate_image(out_);
    ASSERT_TRUE(findings);
    for (const LayoutFinding& finding : *findings) {
      EXPECT_TRUE(finding.remark) << finding.rule << ": " << finding.detail;
    }
    EXPECT_FALSE(has_attribute("wl0.wavelength"));
  }
}

TEST_F(ConvertImages, SayWhatIsGuessed) {
  Picture picture = spectral_picture("mitsuba06", Imf::HALF);
  EXPECT_THAT(convert(picture).notes, ElementsAre(HasSubstr("Mitsuba 0.6's channels are taken for light"),
                                                  HasSubstr("the units of emission, which the file does not "
                                                            "state, are taken for W.m^-2.sr^-1")));
  ConvertImageOptions options;
  options.quantity = Quantity::kReflectance;
  EXPECT_THAT(convert(options).notes, IsEmpty());
  EXPECT_THAT(names_of(output()), ElementsAre("T.405,000000nm", "T.415,000000nm", "T.425,000000nm"));
  EXPECT_EQ(text("emissiveUnits"), "none");
}

TEST_F(ConvertImages, TakeMappedChannelsWithTheirEdges) {
  Picture picture = blank(5, 4);
  for (const char* name : {"a", "b", "c"}) picture.add(name, Imf::FLOAT, [](int x, int) { return 0.25 * x; });
  ConvertImageOptions options;
  options.channels.map = {{"a", {400, 410, 420}}, {"b", {430, 435, 440}}};
  const ImageReport report = convert(picture, options);
  EXPECT_THAT(names_of(output()), ElementsAre("S0.410,000000nm", "S0.435,000000nm", "c"));
  EXPECT_THAT(report.notes, Contains(HasSubstr("mapped channels are taken for light")));
  EXPECT_THAT(report.notes,
              Contains(HasSubstr("that changes 2 of 2 bands: 400.00 to 420.00 nm becomes 397.50 "
                                 "to 422.50 nm")));
}

TEST_F(ConvertImages, HoldReflectanceAndEmissionTogether) {
  Picture picture = blank(7, 5);
  for (const char* name :
       {"T.500nm", "T.510nm", "S0.500,0nm", "S0.510,0nm", "S1.500nm", "S1.510nm", "S2.500nm", "S2.520nm",
        "T.500nm.510nm", "R", "G", "B", "A", "Z", "fog.S0.500nm"}) {
    picture.add(name, Imf::FLOAT, [=](int x, int y) { return noise(x, y, name[1]) - 0.1; });
  }
  picture.header.insert("emissiveUnits", Imf::StringAttribute("W.m^-2"));
  picture.header.insert("polarisationHandedness", Imf::StringAttribute("left"));
  const ImageReport report = convert(picture);
  const Picture got = output();
  EXPECT_THAT(names_of(got), ElementsAre("A", "B", "G", "R", "S0.500,000000nm", "S0.510,000000nm",
                                         "S1.500,000000nm", "S1.510,000000nm", "T.500,000000nm",
                                         "T.500,000000nm.510,000000nm", "T.510,000000nm", "Z"));
  EXPECT_TRUE(got.planes.at("S1.510,000000nm") == picture.planes.at("S1.510nm"));
  EXPECT_TRUE(got.planes.at("T.500,000000nm.510,000000nm") == picture.planes.at("T.500nm.510nm"));
  EXPECT_TRUE(got.planes.at("T.510,000000nm") == picture.planes.at("T.510nm"));
  EXPECT_TRUE(got.planes.at("Z") == picture.planes.at("Z"));
  EXPECT_EQ(text("emissiveUnits"), "W.m^-2");
  EXPECT_EQ(text("polarisationHandedness"), "left");
  EXPECT_EQ(report.bands, 2U);
  EXPECT_THAT(
      report.notes,
      ElementsAre(HasSubstr("left out: 1 band of emission, layer \"fog\""),
                  "left out: 2 channels of S2, whose wavelengths are not those of S0",
                  "both are converted: 2 bands of reflectance with re-radiation and 2 bands of emission"));
  // One of them, when it is asked for.
  ConvertImageOptions options;
  options.quantity = Quantity::kReflectance;
  EXPECT_THAT(convert(options).notes,
              Contains(HasSubstr("left out: 2 bands of emission; 1 band of emission, layer \"fog\"")));
  EXPECT_THAT(names_of(output()), Not(Contains(HasSubstr("S0"))));
  EXPECT_EQ(text("polarisationHandedness"), "none");
  EXPECT_EQ(text("emissiveUnits"), "none");
  // A layer becomes plain.
  options = {};
  options.channels.layer = "fog";
  EXPECT_THAT(convert(options).notes,
              Contains("the channels of layer \"fog\" become plain ones; R, G, B stay what they are"));
  EXPECT_TRUE(output().planes.at("S0.500,000000nm") == picture.planes.at("fog.S0.500nm"));
}

TEST_F(ConvertImages, WithoutHandednessSaySo) {
  Picture picture = blank(2, 2);
  for (const char* name : {"S0.500nm", "S1.500nm"}) picture.add(name, Imf::HALF, [](int, int) { return 1; });
  EXPECT_THAT(convert(picture).notes, Contains(HasSubstr("the handedness of polarised light is not stated")));
}

TEST_F(ConvertImages, DialectsOfLightRefuseOtherThings) {
  Picture picture = blank(2, 2);
  for (const char* name : {"T.500nm", "S0.500nm"}) picture.add(name, Imf::HALF, [](int, int) { return 1; });
  write_scanlines(in_, picture);
  ConvertImageOptions options;
  options.dialect = "indigo";
  EXPECT_THAT(error_of(options).message,
              HasSubstr("holds reflectance and emission, and Indigo's channels are "
                        "light alone; --quantity illuminant takes the emission"));
  options.quantity = Quantity::kReflectance;
  EXPECT_THAT(error_of(options).message, HasSubstr("reflectances would be read as that"));
  options.quantity = {};
  Picture polarised = blank(2, 2);
  for (const char* name : {"S0.500nm", "S1.500nm"})
    polarised.add(name, Imf::HALF, [](int, int) { return 1; });
  write_scanlines(in_, polarised);
  const Error error = error_of(options);
  EXPECT_EQ(error.code, ErrorCode::kBadArgument);
  EXPECT_THAT(error.message, HasSubstr("Indigo has no names for Stokes components"));
  // A channel that passes through has the name already.
  Picture taken = blank(2, 2);
  for (const char* name : {"S0.500nm", "wl0"}) taken.add(name, Imf::HALF, [](int, int) { return 1; });
  options.dialect = "ocean";
  write_scanlines(in_, taken);
  EXPECT_THAT(error_of(options).message, HasSubstr("two channels of the output would be named \"wl0\""));
  options.dialect = "pbrt";
  EXPECT_EQ(error_of(options).code, ErrorCode::kUnknownName);
}

TEST_F(ConvertImages, ScaleMultipliesSpectraAlone) {
  Picture picture = spectral_picture("layout", Imf::FLOAT);
  picture.add("R", Imf::FLOAT, [](int x, int y) { return noise(x, y, 9); });
  ConvertImageOptions options;
  options.scale = 0.01;
  const ImageReport report = convert(picture, options);
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("taken for W.m^-2.sr^-1"),
                                        "emission is multiplied by 0.01, and emissiveUnits still says "
                                        "W.m^-2.sr^-1; --units states others",
                                        HasSubstr("R, G, B stay as they are")));
  const Picture got = output();
  const std::string name = three_names("layout")[1];
  for (int x = 0; x < 83; ++x) {
    EXPECT_EQ(static_cast<float>(got.at(name, x, 3)),
              static_cast<float>(picture.at(name, x, 3)) * static_cast<float>(0.01));
  }
  EXPECT_TRUE(got.planes.at("R") == picture.planes.at("R"));
  options.units = "kW.m^-2.sr^-1";
  EXPECT_THAT(convert(options).notes, ElementsAre(HasSubstr("R, G, B stay as they are")));
  EXPECT_EQ(text("emissiveUnits"), "kW.m^-2.sr^-1");
}

TEST_F(ConvertImages, WrongScalesAndUnitsAreRefused) {
  Picture picture = blank(2, 2);
  picture.add("T.500nm", Imf::HALF, [](int, int) { return 1; });
  write_scanlines(in_, picture);
  for (const double scale : {0.0, -1.0, kDoubleNan, std::numeric_limits<double>::infinity(), 1e60, 1e-60}) {
    ConvertImageOptions options;
    options.scale = scale;
    EXPECT_EQ(error_of(options).code, ErrorCode::kBadArgument) << scale;
  }
  ConvertImageOptions options;
  options.units = "lx";
  EXPECT_THAT(error_of(options).message, HasSubstr("has no emission, whose units --units would state"));
}

TEST_F(ConvertImages, OfOtherDepthRoundAndClamp) {
  Picture picture = blank(70, 2);
  picture.add("S0.500nm", Imf::FLOAT, [](int x, int) { return x == 65 ? -1e6 : x == 66 ? 65504 : x * 0.1F; });
  picture.add("S0.510nm", Imf::HALF, [](int, int) { return 1; });
  ConvertImageOptions options;
  ImageReport report = convert(picture, options);
  EXPECT_EQ(report.clamped_pixels, 0U);
  EXPECT_EQ(output().planes.at("S0.500,000000nm").type, Imf::FLOAT);
  EXPECT_EQ(output().planes.at("S0.510,000000nm").type, Imf::HALF);
  options.keep_depth = false;
  options.pixel = SampleType::kHalf;
  report = convert(options);
  EXPECT_EQ(report.clamped_pixels, 2U);
  const Picture got = output();
  EXPECT_EQ(got.planes.at("S0.500,000000nm").type, Imf::HALF);
  EXPECT_EQ(got.at("S0.500,000000nm", 65, 1), -65504);
  EXPECT_EQ(got.at("S0.500,000000nm", 3, 0), static_cast<double>(static_cast<float>(half(3 * 0.1F))));
  options.pixel = SampleType::kFloat;
  convert(options);
  EXPECT_EQ(output().planes.at("S0.510,000000nm").type, Imf::FLOAT);
}

TEST_F(ConvertImages, NonFiniteSamplesStopOrBlackenTheirPixel) {
  for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
    Picture picture = blank(70, 3);
    picture.add("S0.500nm", type, [](int x, int y) { return x == 68 && y == 1 ? kDoubleNan : 0.5; });
    picture.add("S0.510nm", type, [](int, int) { return 0.25; });
    picture.add("Z", Imf::FLOAT, [](int, int) { return kDoubleNan; });
    write_scanlines(in_, picture);
    const Error error = error_of();
    EXPECT_EQ(error.code, ErrorCode::kNonFinite);
    EXPECT_THAT(error.message, HasSubstr("1 non-finite pixel, the first at 68,1"));
    ConvertImageOptions options;
    options.nonfinite = NonFinite::kZero;
    EXPECT_EQ(convert(options).nonfinite_pixels, 1U);
    EXPECT_EQ(output().at("S0.510,000000nm", 68, 1), 0);
    EXPECT_EQ(output().at("S0.510,000000nm", 67, 1), 0.25);
    EXPECT_TRUE(output().planes.at("Z") == picture.planes.at("Z"));
    std::filesystem::remove(out_);
  }
  // Products beyond the range of float are infinite.
  Picture huge = blank(2, 2);
  huge.add("S0.500nm", Imf::FLOAT, [](int, int) { return 1e38; });
  write_scanlines(in_, huge);
  ConvertImageOptions options;
  options.scale = 10;
  EXPECT_EQ(error_of(options).code, ErrorCode::kNonFinite);
}

TEST_F(ConvertImages, KeepAttributesThatStillHold) {
  Picture picture = spectral_picture("layout", Imf::HALF);
  for (const auto& [name, value] :
       std::vector<std::pair<const char*, const char*>>{{"owner", "me"},
                                                        {"lensTransmission", "400nm:0.5;"},
                                                        {"cameraResponse", "400nm:1;"},
                                                        {"S0.405,000000nm", "400nm:1;410nm:1;"},
                                                        {"S0.999,000000nm", "999nm:1;"},
                                                        {"spectileMethod", "smits"},
                                                        {"oiio:SHA-1", "0123"},
                                                        {"polarisationHandedness", "left"}}) {
    picture.header.insert(name, Imf::StringAttribute(value));
  }
  picture.header.insert("EV", Imf::FloatAttribute(1.5F));
  ConvertImageOptions options;
  options.units = "W.m^-2.sr^-1";
  const ImageReport report = convert(picture, options);
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("polarisationHandedness"),
                                        "attributes left out, since they describe what the output does not "
                                        "hold: S0.999,000000nm, oiio:SHA-1"));
  EXPECT_EQ(text("owner"), "me");
  EXPECT_EQ(text("lensTransmission"), "400nm:0.5;");
  EXPECT_EQ(text("cameraResponse"), "400nm:1;");
  EXPECT_EQ(text("S0.405,000000nm"), "400nm:1;410nm:1;");
  EXPECT_EQ(text("spectileMethod"), "smits");
  EXPECT_TRUE(has_attribute("EV"));
  // New samples are no longer those of the method, nor of the filter.
  options.bands = *Bands::parse("400:430:5");
  const ImageReport resampled = convert(options);
  EXPECT_EQ(text("S0.405,000000nm"), "none");
  EXPECT_EQ(text("spectileMethod"), "none");
  EXPECT_EQ(text("lensTransmission"), "400nm:0.5;");
  EXPECT_THAT(resampled.notes, Contains("left out: the filter curve of 1 channel"));
  EXPECT_THAT(resampled.notes, Contains(HasSubstr("spectileMethod")));
}

TEST_F(ConvertImages, OfOneViewAreItsOwn) {
  Picture picture = blank(3, 2);
  for (const char* name : {"S0.500nm", "right.S0.500nm"}) {
    picture.add(name, Imf::HALF, [=](int, int) { return name[0] == 'r' ? 2 : 1; });
  }
  picture.header.insert("multiView", Imf::StringVectorAttribute({"left", "right"}));
  ConvertImageOptions options;
  EXPECT_THAT(convert(picture, options).notes,
              Contains(HasSubstr("left out: 1 band of emission, view \"right\"")));
  EXPECT_EQ(output().at("S0.500,000000nm", 0, 0), 1);
  options.channels.view = "right";
  EXPECT_THAT(convert(options).notes, Contains("the channels of view \"right\" become plain ones"));
  EXPECT_EQ(output().at("S0.500,000000nm", 0, 0), 2);
  EXPECT_FALSE(has_attribute("multiView"));
}

TEST_F(ConvertImages, InTilesRegionsAndThreadsHaveTheSameBits) {
  Picture picture = spectral_picture("indigo", Imf::HALF, 200, 150);
  convert(picture);
  const Picture whole = output();
  for (const int threads : {1, 3}) {
    ConvertImageOptions options;
    options.threads = threads;
    options.tile = {48, 32};
    options.compression = {CompressionKind::kPiz, -1};
    convert(options);
    EXPECT_TRUE(output().planes == whole.planes);
  }
  ConvertImageOptions options;
  options.region = PixelWindow::inclusive(70, 20, 140, 60);
  convert(options);
  const Picture part = output();
  for (const auto& [name, plane] : part.planes) {
    for (int x = 0; x < part.width(); ++x) {
      EXPECT_EQ(part.at(name, x, 5), whole.at(name, x + 70, 25)) << name;
    }
  }
}

TEST_F(ConvertImages, MipLevelsAreAverages) {
  Picture picture = blank(4, 4);
  picture.add("S0.500nm", Imf::FLOAT, [](int x, int y) { return x + 4 * y; });
  picture.add("A", Imf::HALF, [](int x, int) { return x; });
  ConvertImageOptions options;
  options.mipmap = true;
  options.scale = 2;
  convert(picture, options);
  Imf::TiledInputFile file(out_.c_str());
  ASSERT_EQ(file.numLevels(), 3);
  float samples[4] = {};
  Imf::FrameBuffer frame;
  frame.insert("S0.500,000000nm", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples), 4, 8));
  file.setFrameBuffer(frame);
  file.readTiles(0, 0, 0, 0, 1);
  EXPECT_THAT(samples, ElementsAre(5, 9, 21, 25));
}

}  // namespace
}  // namespace spectile::test
