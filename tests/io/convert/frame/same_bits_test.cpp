// The pixels of an output depend on no instruction set, thread count or tile size.
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <gtest/gtest.h>

#include <spectile/image/convert.hpp>
#include <spectile/image/image.hpp>
#include <spectile/isa.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

/// One way to run a conversion.
struct Setting {
  std::string isa;
  int threads;
  std::size_t tile_lanes;
};

/// Every way there is on this machine.
std::vector<Setting> all_settings() {
  std::vector<Setting> out;
  for (const std::string& isa : available_isas()) {
    for (const int threads : {1, 2}) {
      for (const std::size_t tile : {256U, 4096U, 65536U}) out.push_back({isa, threads, tile});
    }
  }
  return out;
}

/// Every instruction set, every thread count and every tile size, but not every combination.
std::vector<Setting> some_settings() {
  std::vector<Setting> out;
  const std::size_t tiles[] = {256, 4096, 65536};
  std::size_t i = 0;
  for (const std::string& isa : available_isas()) {
    out.push_back({isa, i % 2 == 0 ? 2 : 1, tiles[i % 3]});
    ++i;
  }
  out.push_back({available_isas().back(), 1, 65536});
  out.push_back({available_isas().back(), 2, 256});
  return out;
}

class SameBits : public testing::Test {
 protected:
  ~SameBits() override { static_cast<void>(force_isa("")); }

  /// Puts a way in force; a test that forces an instruction set fails when that one does not run.
  static void force(const Setting& setting, ImageOptions& options) {
    ASSERT_TRUE(force_isa(setting.isa));
    ASSERT_EQ(*active_isa(), setting.isa);
    options.threads = setting.threads;
    options.tile_lanes = setting.tile_lanes;
  }

  /// Converts each way and compares all channels with those of the first; false for a file that cannot be
  /// converted.
  static bool check(const std::string& input, const std::vector<Setting>& settings, const Bands& bands) {
    const test::TempFolder folder;
    UpsampleImageOptions up;
    up.bands = bands;
    up.nonfinite = NonFinite::kZero;
    up.compression = {CompressionKind::kNone, -1};
    ProjectImageOptions down;
    down.nonfinite = NonFinite::kZero;
    down.pixel = SampleType::kFloat;
    down.compression = up.compression;
    ConvertImageOptions other;
    other.nonfinite = NonFinite::kZero;
    other.bands = *Bands::uniform(380, 720, 17);
    other.scale = 0.3;
    other.compression = up.compression;
    const Setting plain = {"scalar", 1, 1024};
    force(plain, up);
    force(plain, down);
    force(plain, other);
    if (!upsample_image(input, folder / "spectral.exr", up)) return false;
    const auto projected = project_image(folder / "spectral.exr", folder / "rgb.exr", down);
    EXPECT_TRUE(projected) << input << ": " << projected.error().message;
    if (!projected) return true;
    EXPECT_TRUE(convert_image(folder / "spectral.exr", folder / "bands.exr", other)) << input;
    const test::Picture spectral = test::read_picture(folder / "spectral.exr");
    const test::Picture resampled = test::read_picture(folder / "bands.exr");
    const test::Picture rgb = test::read_picture(folder / "rgb.exr");
    EXPECT_EQ(spectral.planes.size() - read_channel_count(input), bands.count()) << input;
    for (const Setting& setting : settings) {
      const std::string what = input + " " + setting.isa + ", " + std::to_string(setting.threads) +
                               " threads, tiles of " + std::to_string(setting.tile_lanes);
      force(setting, up);
      force(setting, down);
      force(setting, other);
      EXPECT_TRUE(upsample_image(input, folder / "other.exr", up)) << what;
      EXPECT_TRUE(test::read_picture(folder / "other.exr").planes == spectral.planes) << what;
      EXPECT_TRUE(project_image(folder / "spectral.exr", folder / "other.exr", down)) << what;
      EXPECT_TRUE(test::read_picture(folder / "other.exr").planes == rgb.planes) << what;
      EXPECT_TRUE(convert_image(folder / "spectral.exr", folder / "other.exr", other)) << what;
      EXPECT_TRUE(test::read_picture(folder / "other.exr").planes == resampled.planes) << what;
    }
    return true;
  }

  /// Channels of the input that an upsampled file holds beside the bands; R, G, B where it has only
  /// luminance.
  static std::size_t read_channel_count(const std::string& input) {
    const test::Picture picture = test::read_picture(input);
    std::size_t count = picture.planes.contains("R") ? picture.planes.size() : picture.planes.size() + 2;
    // Another view's stay behind.
    const auto* const views = picture.header.findTypedAttribute<Imf::StringVectorAttribute>("multiView");
    for (std::size_t i = 1; views != nullptr && i < views->value().size(); ++i) {
      for (const auto& [name, plane] : picture.planes) {
        count -= ("." + name).find("." + views->value()[i] + ".") != std::string::npos ? 1 : 0;
      }
    }
    return count;
  }

  static void check_all(const std::vector<Setting>& settings) {
    const auto bands = Bands::uniform(400, 700, 18.75);
    int converted = 0;
    for (const std::string& input : test::shared_files("rgb"))
      converted += check(input, settings, *bands) ? 1 : 0;
    // All but the one that has no red and no blue.
    EXPECT_EQ(converted, static_cast<int>(test::shared_files("rgb").size()) - 1);
  }
};

TEST_F(SameBits, OddImageAwayFromTheOrigin) {
  const test::TempFolder folder;
  test::Picture picture = test::blank(333, 77, {-17, 23});
  test::add_rgb_noise(picture, Imf::HALF, 3);
  picture.add("A", Imf::HALF, [](int x, int y) { return test::noise(x, y, 9); });
  test::write_scanlines(folder / "in.exr", picture);
  EXPECT_TRUE(check(folder / "in.exr", all_settings(), *Bands::uniform(400, 700, 18.75)));
  EXPECT_TRUE(check(folder / "in.exr", all_settings(), Bands()));
}

TEST_F(SameBits, EveryRealImage) {
  SPECTILE_NEEDS_IMAGES("rgb");
  check_all(some_settings());
}

TEST_F(SameBits, SixtyBandsOfTwoRealImages) {
  SPECTILE_NEEDS_IMAGES("rgb");
  for (const char* name : {"Carrots.exr", "t08.exr"}) {
    EXPECT_TRUE(check((test::shared_images("rgb") / name).string(), all_settings(), Bands())) << name;
  }
}

TEST_F(SameBits, EveryRealImageEveryWay) {
  SPECTILE_NEEDS_IMAGES("rgb");
  check_all(all_settings());
}

}  // namespace
}  // namespace spectile
