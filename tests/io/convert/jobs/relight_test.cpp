// Whole textures under other lights: the direct way, the long one, and upsampling followed by projecting.
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/image.hpp>
#include <spectile/upsampling/relight.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

constexpr Method kMethods[] = {Method::kSmits,      Method::kSmits1999, Method::kSmitsExact,
                               Method::kMallett,    Method::kSigmoid,   Method::kSigmoidObserver,
                               Method::kTetrahedral};

class RelitImages : public testing::Test {
 protected:
  /// A texture of every hue, with some values above 1 and below 0, and alpha.
  std::string texture() {
    test::Picture picture = test::blank(67, 5);
    const auto wave = [](double frequency, double phase, int x, int y) {
      return 0.5 + 0.5 * std::sin(frequency * (x + 67 * y) + phase);
    };
    picture.add("R", Imf::FLOAT, [&](int x, int y) { return x == 7 && y == 0 ? 2.5 : wave(0.11, 0, x, y); });
    picture.add("G", Imf::FLOAT,
                [&](int x, int y) { return x == 9 && y == 0 ? -0.125 : wave(0.17, 1, x, y); });
    picture.add("B", Imf::FLOAT, [&](int x, int y) { return wave(0.23, 2, x, y); });
    picture.add("A", Imf::HALF, [](int x, int y) { return (x + y) % 3 * 0.5; });
    test::write_scanlines(folder_ / "in.exr", picture);
    return folder_ / "in.exr";
  }

  test::Picture relit(const std::string& input, const RelightImageOptions& options) {
    const auto report = relight_image(input, folder_ / "relit.exr", options);
    EXPECT_TRUE(report) << report.error().message;
    return test::read_picture(folder_ / "relit.exr");
  }

  test::TempFolder folder_;
};

RelightImageOptions under(const char* light) {
  RelightImageOptions options({light, *illuminant(light)});
  options.pixel = SampleType::kFloat;
  return options;
}

TEST_F(RelitImages, AreWhatUpsamplingAndProjectingGive) {
  const std::string input = texture();
  for (const Method method : kMethods) {
    RelightImageOptions options = under("FL11");
    options.method = method;
    const test::Picture direct = relit(input, options);
    options.mode = RelightMode::kSpectra;
    const test::Picture by_spectra = relit(input, options);

    UpsampleImageOptions up;
    up.method = method;
    up.pixel = SampleType::kFloat;
    up.masking = Masking::kNone;  // relighting keeps colours where alpha is 0
    ASSERT_TRUE(upsample_image(input, folder_ / "spectral.exr", up));
    ProjectImageOptions down;
    down.pixel = SampleType::kFloat;
    down.light = *illuminant("FL11");
    ASSERT_TRUE(project_image(folder_ / "spectral.exr", folder_ / "projected.exr", down));
    const test::Picture projected = test::read_picture(folder_ / "projected.exr");

    const auto upsampler = *Upsampler::create(method, Quantity::kReflectance, up.bands);
    const auto projector = *Projector::reflective(up.bands, *illuminant("FL11"));
    const auto relighter = *Relighter::create(upsampler, projector, projector.xyz_to_srgb());
    std::size_t k = 0;
    for (const char* name : {"R", "G", "B"}) {
      for (std::size_t i = 0; i < direct.pixels(); ++i) {
        const double longest = projected.planes.at(name).at(i);
        ASSERT_EQ(by_spectra.planes.at(name).at(i), longest) << to_string(method) << " pixel " << i;
        ASSERT_NEAR(direct.planes.at(name).at(i), longest, 2.5 * relighter.bound()[k])
            << to_string(method) << " pixel " << i;
      }
      ++k;
    }
    for (std::size_t i = 0; i < direct.pixels(); ++i) {
      ASSERT_EQ(direct.planes.at("A").at(i), projected.planes.at("A").at(i)) << "alpha passes through";
    }
  }
}

TEST_F(RelitImages, UnderTheirOwnLightAreTheTexture) {
  const std::string input = texture();
  const test::Picture before = test::read_picture(input);
  for (const Method method : {Method::kSmitsExact, Method::kMallett, Method::kSigmoid,
                              Method::kSigmoidObserver, Method::kTetrahedral}) {
    RelightImageOptions options = under("D65");
    options.method = method;
    const test::Picture after = relit(input, options);
    for (const char* name : {"R", "G", "B"}) {
      for (std::size_t i = 0; i < after.pixels(); ++i) {
        if (i == 7 || i == 9) continue;  // outside some method's gamut
        ASSERT_NEAR(after.planes.at(name).at(i), before.planes.at(name).at(i), 2e-6) << i;
      }
    }
  }
}

TEST_F(RelitImages, AdaptedWhiteIsWhite) {
  test::Picture picture = test::blank(3, 2);
  for (const char* name : {"R", "G", "B"}) {
    picture.add(name, Imf::HALF, [](int, int) { return 1.0; });
  }
  test::write_scanlines(folder_ / "white.exr", picture);
  for (const Adaptation adaptation : {Adaptation::kBradford, Adaptation::kCat16}) {
    RelightImageOptions options = under("A");
    options.adaptation = adaptation;
    const test::Picture after = relit(folder_ / "white.exr", options);
    for (const char* name : {"R", "G", "B"}) EXPECT_NEAR(after.planes.at(name).at(0), 1.0, 2e-6);
  }
  const test::Picture orange = relit(folder_ / "white.exr", under("A"));
  EXPECT_GT(orange.planes.at("R").at(0), 1.5);
  EXPECT_LT(orange.planes.at("B").at(0), 0.5);
}

TEST_F(RelitImages, OutOfGamutIsCountedMovedOrStopped) {
  const std::string input = texture();
  RelightImageOptions options = under("A");
  const auto clipped = relight_image(input, folder_ / "out.exr", options);
  ASSERT_TRUE(clipped) << clipped.error().message;
  EXPECT_EQ(clipped->out_of_gamut_pixels, 1U);
  options.method = Method::kSigmoid;
  const auto bounded = relight_image(input, folder_ / "out.exr", options);
  ASSERT_TRUE(bounded);
  EXPECT_EQ(bounded->out_of_gamut_pixels, 2U) << "the one above 1 too";
  std::filesystem::remove(folder_ / "out.exr");
  options.out_of_gamut = GamutPolicy::kError;
  const auto stopped = relight_image(input, folder_ / "out.exr", options);
  ASSERT_FALSE(stopped);
  EXPECT_NE(stopped.error().message.find("7,0"), std::string::npos) << stopped.error().message;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
}

TEST_F(RelitImages, LightIsNotTaken) {
  RelightImageOptions options = under("A");
  options.quantity = Quantity::kIlluminant;
  const auto result = relight_image(texture(), folder_ / "out.exr", options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace spectile
