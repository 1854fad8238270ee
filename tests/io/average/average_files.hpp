// Renders of one frame for the tests of averages.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <spectile/image/average.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile::test {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline const AverageOptions kPlain;  // named, as kUpsample is

/// Images to average, and what becomes of them.
class AverageFiles : public testing::Test {
 protected:
  /// An image of noise, other with every seed: R, G, B, a spectral channel, and one of integers.
  static test::Picture render(int seed, Imf::PixelType type = Imf::FLOAT, Imath::V2i origin = {0, 0}) {
    test::Picture picture = test::blank(37, 41, origin);
    for (const char* name : {"R", "G", "B", "S0.402,500000nm"}) {
      const int channel = name[0];
      picture.add(name, type,
                  [=](int x, int y) { return 3 * test::noise(x, y, 1000 * seed + channel) - 0.5; });
    }
    picture.add("id", Imf::UINT, [](int x, int y) { return x / 5 + 1e9 * (y % 3); });
    return picture;
  }
  std::string write(const std::string& name, test::Picture picture) {
    test::write_scanlines(folder_ / name, picture);
    return folder_ / name;
  }
  std::vector<std::string> renders(int count, Imf::PixelType type = Imf::FLOAT) {
    std::vector<std::string> out;
    for (int i = 0; i < count; ++i) out.push_back(write("in" + std::to_string(i) + ".exr", render(i, type)));
    return out;
  }
  test::Picture average(const std::vector<std::string>& inputs, const AverageOptions& options = kPlain) {
    report_ = {};
    const auto report = average_images(inputs, folder_ / "out.exr", options);
    EXPECT_TRUE(report) << report.error().message;
    if (report) report_ = *report;
    return test::read_picture(folder_ / "out.exr");
  }
  void expect_error(const std::vector<std::string>& inputs, const AverageOptions& options, ErrorCode code,
                    const std::vector<std::string>& says) {
    std::filesystem::remove(folder_ / "out.exr");
    const auto report = average_images(inputs, folder_ / "out.exr", options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, code) << report.error().message;
    for (const std::string& text : says) EXPECT_THAT(report.error().message, testing::HasSubstr(text));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
  }

  test::TempFolder folder_;
  ImageReport report_;
};

inline AverageOptions weighted(std::vector<double> weights) {
  AverageOptions options;
  options.weights = std::move(weights);
  return options;
}

}  // namespace spectile::test
