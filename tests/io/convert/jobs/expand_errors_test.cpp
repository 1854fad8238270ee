// A faulty image of coefficients gives one clear error, and no output appears.
#include <OpenEXR/ImfFloatAttribute.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <spectile/image/image.hpp>
#include <spectile/image/spectral_texture.hpp>

#include "tests/io/convert/jobs/compact_files.hpp"

namespace spectile {
namespace {

using testing::HasSubstr;

class ExpandErrors : public testing::Test {
 protected:
  /// A compact image of a sigmoid for light, made for a lamp, with all attributes there can be.
  ExpandErrors() {
    UpsampleImageOptions options = test::options_of({Method::kSigmoid, Quantity::kIlluminant});
    options.light = NamedLight{"lamp", *illuminant("A")};
    options.negative = NegativeInput::kKeep;
    good_ = compact(options);
  }

  test::Picture compact(const UpsampleImageOptions& options) {
    test::Picture picture = test::every_color(9, 6);
    test::write_scanlines(folder_ / "in.exr", picture);
    test::upsample_to(Store::kCoefficients, folder_ / "in.exr", folder_ / "compact.exr", options);
    return test::read_picture(folder_ / "compact.exr");
  }

  /// Writes the image and expects both readers to refuse it.
  void expect_refused(test::Picture& picture, const std::string& said) {
    test::write_scanlines(folder_ / "bad.exr", picture);
    expect_refused_file(said);
  }
  void expect_refused_file(const std::string& said) {
    const auto names = folder_.names();
    const auto report = expand_image(folder_ / "bad.exr", folder_ / "out.exr", expand_);
    ASSERT_FALSE(report) << said;
    EXPECT_EQ(test::code_of(report), test::code(ErrorCode::kBadFile)) << report.error().message;
    EXPECT_THAT(report.error().message, testing::StartsWith(folder_ / "bad.exr: "));
    EXPECT_THAT(report.error().message, HasSubstr(said));
    EXPECT_EQ(report.error().message.find('\n'), std::string::npos);
    EXPECT_EQ(folder_.names(), names);
    const auto texture = SpectralTexture::open(folder_ / "bad.exr");
    ASSERT_FALSE(texture) << said;
    EXPECT_EQ(texture.error().message, report.error().message);
  }

  /// Takes an attribute away. Not by Header::erase(), which leaks it in OpenEXR 3.1.
  static void remove(Imf::Header& header, const std::string& name) {
    Imf::Header rest;
    for (auto i = header.begin(); i != header.end(); ++i) {
      if (i.name() != name) rest.insert(i.name(), i.attribute());
    }
    header = rest;
  }
  static void set(Imf::Header& header, const std::string& name, const std::string& text) {
    remove(header, name);
    header.insert(name, Imf::StringAttribute(text));
  }

  const test::TempFolder folder_;
  const ExpandImageOptions expand_;
  test::Picture good_;
};

TEST_F(ExpandErrors, MissingAttributeIsNamed) {
  for (const char* name : {"spectileCoefficients", "spectileMethod", "spectileQuantity", "spectileBands",
                           "spectileObserver", "spectileLight", "spectileLightSamples"}) {
    test::Picture bad = good_;
    remove(bad.header, name);
    expect_refused(bad, std::string("attribute ") + name + " is missing or damaged");
  }
}

TEST_F(ExpandErrors, AttributeOfAnotherTypeIsNamed) {
  for (const char* name :
       {"spectileCoefficients", "spectileMethod", "spectileBands", "spectileLightSamples"}) {
    test::Picture bad = good_;
    remove(bad.header, name);
    bad.header.insert(name, Imf::FloatAttribute(1));
    expect_refused(bad, std::string("attribute ") + name + " is missing or damaged");
  }
}

TEST_F(ExpandErrors, NonsenseInAnAttributeIsNamed) {
  const std::string bands = test::text_of(good_.header, "spectileBands");
  const std::string samples = test::text_of(good_.header, "spectileLightSamples");
  std::string too_many;
  for (int i = 0; i <= static_cast<int>(Bands::kMaxBands); ++i) {
    too_many += fmt::format("{}{}:{}:{}", i > 0 ? " " : "", i + 1, i + 1.5, i + 2);
  }
  const std::vector<std::pair<const char*, std::string>> nonsense = {
      {"spectileCoefficients", ""},
      {"spectileCoefficients", "2.0"},
      {"spectileMethod", "sigmoid "},
      {"spectileMethod", "\xFF\xFE"},
      {"spectileQuantity", "brightness"},
      {"spectileObserver", "2006"},
      {"spectileKeepNegative", "perhaps"},
      {"spectileLight", ""},
      {"spectileBands", ""},
      {"spectileBands", "words"},
      {"spectileBands", bands.substr(0, bands.size() / 2) + ":"},
      {"spectileBands", bands.substr(0, bands.rfind(':'))},
      {"spectileBands", bands + " "},
      {"spectileBands", bands + " " + bands},
      {"spectileBands", "nan:nan:nan"},
      {"spectileBands", "400:nan:500"},
      {"spectileBands", "400:450:inf"},
      {"spectileBands", "-10:0:10"},
      {"spectileBands", "1e999:1e999:1e999"},
      {"spectileBands", too_many},
      {"spectileLightSamples", ""},
      {"spectileLightSamples", samples.substr(0, samples.rfind(':'))},
      {"spectileLightSamples", "500:nan 600:1"},
      {"spectileLightSamples", "500:1 inf:1"},
      {"spectileLightSamples", "500:1,600:1"}};
  for (const auto& [name, text] : nonsense) {
    test::Picture bad = good_;
    set(bad.header, name, text);
    expect_refused(bad, std::string("attribute ") + name + " is missing or damaged");
  }
}

TEST_F(ExpandErrors, AttributesFromWhichNoMethodCanBeMadeAreRefused) {
  for (const char* samples : {"500:0 600:0", "500:1e308 600:1e308"}) {
    test::Picture bad = good_;
    set(bad.header, "spectileLightSamples", samples);
    expect_refused(bad, "bands");
  }
  test::Picture bad = good_;
  set(bad.header, "spectileMethod", "smits");
  expect_refused(bad, "smits is published for D65");
  bad = good_;
  set(bad.header, "spectileBands", "1000:1100:1200");
  expect_refused(bad, "luminance");
}

TEST_F(ExpandErrors, MissingChannelIsNamed) {
  for (const char* name : {"spectile.c0", "spectile.c1", "spectile.c2", "spectile.scale"}) {
    test::Picture bad = good_;
    bad.header.channels() = Imf::ChannelList();
    bad.planes.erase(name);
    for (const auto& [channel, plane] : bad.planes)
      bad.header.channels().insert(channel, Imf::Channel(plane.type));
    expect_refused(bad, std::string("channel \"") + name + "\" is missing");
  }
}

TEST_F(ExpandErrors, ChannelThatIsNoCoefficientIsNamed) {
  test::Picture whole = good_;
  whole.add("spectile.c1", Imf::UINT, [](int, int) { return 1; });
  expect_refused(whole, "\"spectile.c1\" holds integers");
  test::Picture both = good_;
  both.add("S0.550nm", Imf::HALF, [](int, int) { return 1; });
  expect_refused(both, "holds spectral channels already (\"S0.550nm\")");
  // The scale of an image whose method has none says that the attributes are another image's.
  test::Picture strange = good_;
  set(strange.header, "spectileQuantity", "reflectance");
  expect_refused(strange, "\"spectile.scale\" is none of sigmoid's coefficients for reflectance");
}

TEST_F(ExpandErrors, SubsampledCoefficientsAreRefused) {
  test::Picture bad = good_;
  bad.header.channels().findChannel("spectile.c2")->xSampling = 3;
  bad.planes.erase("spectile.c2");
  Imf::FrameBuffer frame = bad.frame_buffer();
  std::vector<float> samples(std::size_t{3} * 6);
  frame.insert("spectile.c2", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), 4, 12, 3, 1));
  {
    Imf::OutputFile file((folder_ / "bad.exr").c_str(), bad.header);
    file.setFrameBuffer(frame);
    file.writePixels(6);
  }
  expect_refused_file("\"spectile.c2\" is subsampled 3 x 1");
}

TEST_F(ExpandErrors, ImageWithoutCoefficientsIsRefused) {
  const auto report = expand_image(folder_ / "in.exr", folder_ / "out.exr", expand_);
  EXPECT_EQ(test::code_of(report), test::code(ErrorCode::kBadFile));
  EXPECT_THAT(report.error().message, HasSubstr("holds no coefficients"));
  const auto missing = expand_image(folder_ / "none.exr", folder_ / "out.exr", expand_);
  EXPECT_EQ(test::code_of(missing), test::code(ErrorCode::kBadFile));
  const auto itself = expand_image(folder_ / "compact.exr", folder_ / "compact.exr", expand_);
  EXPECT_EQ(test::code_of(itself), test::code(ErrorCode::kBadArgument));
  EXPECT_THAT(folder_.names(), testing::ElementsAre("compact.exr", "in.exr"));
}

TEST_F(ExpandErrors, OtherConversionsOfACompactImagePointToExpansion) {
  const std::string compact = folder_ / "compact.exr";
  for (const Store store : {Store::kSpectra, Store::kCoefficients}) {
    UpsampleImageOptions options;
    options.store = store;
    const auto again = upsample_image(compact, folder_ / "out.exr", options);
    ASSERT_EQ(test::code_of(again), test::code(ErrorCode::kBadFile));
    EXPECT_THAT(again.error().message, HasSubstr("expanding turns them into spectra"));
  }
  const auto projected = project_image(compact, folder_ / "out.exr", test::kProject);
  ASSERT_EQ(test::code_of(projected), test::code(ErrorCode::kBadFile));
  EXPECT_THAT(projected.error().message, HasSubstr("expanding turns them into spectra"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
}

TEST_F(ExpandErrors, CutFileIsRefused) {
  const std::string bytes = test::file_bytes(folder_ / "compact.exr");
  for (const double share : {0.2, 0.6, 0.95}) {
    test::write_text(folder_ / "bad.exr",
                     bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
    const auto report = expand_image(folder_ / "bad.exr", folder_ / "out.exr", expand_);
    EXPECT_EQ(test::code_of(report), test::code(ErrorCode::kBadFile)) << share;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
  }
}

/// Values that no coefficient may have, and where a sample would overflow.
TEST_F(ExpandErrors, CoefficientsThatAreNotFiniteStopOrBecomeBlack) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const auto& [method, quantity] : {std::pair(Method::kSigmoid, Quantity::kIlluminant),
                                         std::pair(Method::kSigmoid, Quantity::kReflectance),
                                         std::pair(Method::kSmitsExact, Quantity::kReflectance)}) {
    const test::Picture whole = compact(test::options_of({method, quantity}));
    ExpandImageOptions expand;
    expand.pixel = SampleType::kFloat;
    ASSERT_TRUE(expand_image(folder_ / "compact.exr", folder_ / "whole.exr", expand));
    test::Picture want = test::read_picture(folder_ / "whole.exr");
    test::Picture bad = whole;
    bad.planes.at("spectile.c0").set(whole.index(4, 1), nan);
    bad.planes.at("spectile.c1").set(whole.index(8, 1), -infinity);
    bad.planes.at("spectile.c2").set(whole.index(0, 5), 3e38);
    for (auto& [name, plane] : want.planes) {
      if (!name.ends_with("nm")) continue;
      for (const auto& [x, y] : {std::pair(4, 1), std::pair(8, 1), std::pair(0, 5)})
        plane.set(want.index(x, y), 0);
    }
    std::uint64_t pixels = 3;
    if (whole.planes.contains("spectile.scale")) {
      bad.planes.at("spectile.scale").set(whole.index(2, 2), infinity);
      for (auto& [name, plane] : want.planes) {
        if (name.ends_with("nm")) plane.set(want.index(2, 2), 0);
      }
      ++pixels;
    }
    test::write_scanlines(folder_ / "bad.exr", bad);
    const auto stopped = expand_image(folder_ / "bad.exr", folder_ / "out.exr", expand);
    ASSERT_EQ(test::code_of(stopped), test::code(ErrorCode::kNonFinite));
    EXPECT_THAT(stopped.error().message,
                HasSubstr(fmt::format("{} non-finite pixels, the first at 4,1", pixels)));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
    expand.nonfinite = NonFinite::kZero;
    const auto zeroed = expand_image(folder_ / "bad.exr", folder_ / "out.exr", expand);
    ASSERT_TRUE(zeroed) << zeroed.error().message;
    EXPECT_EQ(zeroed->nonfinite_pixels, pixels);
    EXPECT_TRUE(test::read_picture(folder_ / "out.exr").planes == want.planes);
    std::filesystem::remove(folder_ / "out.exr");
  }
}

}  // namespace
}  // namespace spectile
