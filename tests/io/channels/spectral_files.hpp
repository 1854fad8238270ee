// Spectral images for the tests: their colours by integrals of the tests' own, and a fixture that projects
// them.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <spectile/image/image.hpp>
#include <string>
#include <utility>
#include <vector>

#include "src/data/tables.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile::test {

using Xyz = std::array<double, 3>;

inline double matching(std::size_t k, double nm) {
  const data::MatchingFunctions& f = data::kCie1931;
  const std::span<const double> bars[3] = {f.x_bar, f.y_bar, f.z_bar};
  const double place = nm - f.first_nm;
  if (place < 0 || place > static_cast<double>(f.x_bar.size() - 1)) return 0;
  const auto i = std::min(static_cast<std::size_t>(place), f.x_bar.size() - 2);
  const double t = place - static_cast<double>(i);
  return bars[k][i] * (1 - t) + bars[k][i + 1] * t;
}

template <class F>
double integral(double lower, double upper, F f) {
  constexpr int kSteps = 4000;
  const double h = (upper - lower) / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += f(lower + (i + 0.5) * h);
  return sum * h;
}

/// The XYZ of light that is `value(i)` over band i, Y of an even spectrum being 1.
inline Xyz light_of(const std::vector<std::pair<double, double>>& bands, const std::vector<double>& values) {
  Xyz out{};
  double even = 0;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = integral(bands[i].first, bands[i].second, [&](double nm) { return matching(k, nm); });
      out[k] += values[i] * w;
      if (k == 1) even += w;
    }
  }
  for (double& v : out) v /= even;
  return out;
}

class SpectralFiles : public testing::Test {
 protected:
  ImageReport project(const std::string& input, const ProjectImageOptions& options = xyz()) {
    const auto report = project_image(input, out_, options);
    EXPECT_TRUE(report) << report.error().message;
    return report ? *report : ImageReport();
  }
  static ProjectImageOptions xyz() {
    ProjectImageOptions options;
    options.target = ColorTarget::kXyz;
    options.pixel = SampleType::kFloat;
    return options;
  }
  ImageReport project(Picture& picture, const ProjectImageOptions& options = xyz()) {
    write_scanlines(in_, picture);
    return project(in_, options);
  }
  void expect_pixel(const Xyz& want, double tolerance = 2e-6) {
    const Picture got = read_picture(out_);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(got.at(std::string(1, "XYZ"[k]), 0, 0), want[k], tolerance) << "XYZ"[k];
    }
  }
  std::string error_of(const ProjectImageOptions& options = xyz()) {
    const auto report = project_image(in_, out_, options);
    EXPECT_FALSE(report);
    return report ? std::string() : report.error().message;
  }

  TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

/// Bands of 10 nm from 400 to 700, all of one value, under a prefix.
inline void add_even(Picture& picture, const std::string& prefix, double value, const char* kind = "S0") {
  for (int nm = 400; nm <= 700; nm += 10) {
    picture.add(fmt::format("{}{}.{},{:06}nm", prefix, kind, nm, 0), Imf::FLOAT,
                [=](int, int) { return value; });
  }
}

inline double luminance_at_origin(const std::string& path) {
  return read_picture(path).at("Y", 0, 0);
}

}  // namespace spectile::test
