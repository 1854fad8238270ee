// Spectral images in every dialect, and a fixture that converts them.
#pragma once

#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <spectile/image/convert.hpp>
#include <string>
#include <vector>

#include "tests/support/exr_files.hpp"

namespace spectile::test {

/// Named, since GCC 12 takes defaulted arguments with a std::function inside for uninitialised.
inline const ConvertImageOptions kConvert;

/// 3 bands of 10 nm from 400 to 430 nm, channel names as a dialect writes them.
inline std::vector<std::string> three_names(const std::string& dialect) {
  if (dialect == "mitsuba06") return {"400.00-410.00nm", "410.00-420.00nm", "420.00-430.00nm"};
  if (dialect == "indigo") return {"wavelength400", "wavelength410", "wavelength420"};
  if (dialect == "ocean") return {"wl0", "wl1", "wl2"};
  return {"S0.405,000000nm", "S0.415,000000nm", "S0.425,000000nm"};
}

/// Noise of several magnitudes, of both signs, with -0 and denormals, as halves or floats hold it.
inline double odd_sample(int x, int y, int channel) {
  if ((x + y) % 7 == 0) return -0.0;
  if ((x + y) % 11 == 0) return 0x1p-24 * (1 + channel);
  return (noise(x, y, channel) - 0.25) * std::exp2(x % 12);
}

inline Picture spectral_picture(const std::string& dialect, Imf::PixelType type, int width = 83,
                                int height = 19) {
  Picture picture = blank(width, height);
  int channel = 0;
  for (const std::string& name : three_names(dialect)) {
    const int c = channel++;
    picture.add(name, type, [=](int x, int y) { return odd_sample(x, y, c); });
    if (dialect == "ocean") {
      picture.header.insert(name + ".wavelength", Imf::DoubleAttribute((405 + 10 * c) * 1e-9));
    }
  }
  return picture;
}

class ConvertImages : public testing::Test {
 protected:
  ImageReport convert(const ConvertImageOptions& options = kConvert) {
    const auto report = convert_image(in_, out_, options);
    EXPECT_TRUE(report) << report.error().message;
    return report ? *report : ImageReport();
  }
  ImageReport convert(Picture& picture, const ConvertImageOptions& options = kConvert) {
    write_scanlines(in_, picture);
    return convert(options);
  }
  Error error_of(const ConvertImageOptions& options = kConvert) {
    const auto report = convert_image(in_, out_, options);
    EXPECT_FALSE(report);
    EXPECT_FALSE(std::filesystem::exists(out_));
    return report ? Error() : report.error();
  }
  Picture output() const { return read_picture(out_); }
  bool has_attribute(const char* name) const {
    const Picture picture = output();
    return picture.header.find(name) != picture.header.end();
  }
  std::string text(const std::string& name) const {
    const Picture picture = output();
    const auto* const found = picture.header.findTypedAttribute<Imf::StringAttribute>(name);
    return found == nullptr ? "none" : found->value();
  }

  TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

}  // namespace spectile::test
