// Upsampling and projecting a real photograph against the double oracle, pixel by pixel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <spectile/image/image.hpp>

#include "src/reference/oracle/oracle.hpp"
#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using Triple = std::array<double, 3>;

constexpr double kRounding = 0x1p-24;  // relative error of one float operation

/// The oracle's result for a picture's R, G, B, and the library's bound around it.
struct Expected {
  std::vector<Triple> rgb;
  std::vector<Triple> bound;
};

/// Oracle: clip, upsample, project under D65, to sRGB, all in double.
///
/// Bound, per component j of sRGB, with M the matrix from XYZ and w the weights:
/// - a sample is off by 6 roundings of the largest possible sample, as Upsampler states, and stored in a half
/// by
///   2^-11 of itself, or half the spacing of denormals, 2^-25, where that is more;
/// - the sum over n bands adds n + 2 roundings of the sum of magnitudes, as project() states;
/// - the matrix adds one rounding for its own entry, one for the product and two for the sums.
Expected expect(const test::Picture& picture, const Bands& bands, bool half_samples) {
  const auto basis = oracle::smits_basis(Method::kSmits, Quantity::kReflectance, bands);
  const auto d65 = illuminant("D65");
  const auto weights = oracle::projection_weights(bands, Observer::kCie1931, &*d65);
  double largest_basis = 0;
  for (const auto& band : basis) {
    for (const double v : band) largest_basis = std::max(largest_basis, std::abs(v));
  }
  const double sums = static_cast<double>(bands.count() + 2) + 4;
  // sRGB's white is D65 as the bands see it: each component over that of a perfect diffuser.
  const Triple white = oracle::xyz_to_srgb(oracle::project(weights, std::vector<double>(bands.count(), 1.0)));
  Matrix3 m = xyz_to_srgb_matrix();
  for (std::size_t i = 0; i < 9; ++i) m[i] /= white[i / 3];
  Expected out;
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    Triple color{};
    std::size_t c = 0;
    for (const char* name : {"R", "G", "B"}) color[c++] = std::max(0.0, picture.planes.at(name).at(i));
    const auto spectrum = oracle::smits_spectrum(basis, color, 0);
    Triple rgb = oracle::xyz_to_srgb(oracle::project(weights, spectrum));
    for (std::size_t j = 0; j < 3; ++j) rgb[j] /= white[j];
    out.rgb.push_back(rgb);
    const double largest = *std::max_element(color.begin(), color.end()) * largest_basis;
    Triple xyz{};
    for (std::size_t b = 0; b < bands.count(); ++b) {
      double sample = 6 * kRounding * largest + sums * kRounding * spectrum[b];
      if (half_samples) sample += std::max(0x1p-11 * spectrum[b], 0x1p-25);
      for (std::size_t k = 0; k < 3; ++k) xyz[k] += weights[b][k] * sample;
    }
    Triple bound{};
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) bound[j] += std::abs(m[3 * j + k]) * xyz[k];
    }
    out.bound.push_back(bound);
  }
  return out;
}

/// Converts there and back, compares with the oracle, and records what Smits itself loses.
void check_round_trip(SampleType pixel) {
  const std::string input = (test::shared_images("rgb") / "StillLife.exr").string();
  const test::TempFolder folder;
  UpsampleImageOptions up;
  up.method = Method::kSmits;
  up.pixel = pixel;
  up.compression = {CompressionKind::kNone, -1};
  const auto made = upsample_image(input, folder / "spectral.exr", up);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->clamped_pixels, 0U);
  ProjectImageOptions down;
  down.pixel = SampleType::kFloat;
  down.compression = up.compression;
  const auto back = project_image(folder / "spectral.exr", folder / "back.exr", down);
  ASSERT_TRUE(back) << back.error().message;

  const test::Picture before = test::read_picture(input);
  const test::Picture after = test::read_picture(folder / "back.exr");
  ASSERT_EQ(before.pixels(), after.pixels());
  const Expected expected = expect(before, up.bands, pixel == SampleType::kHalf);
  std::uint64_t outside = 0;
  double worst = 0;  // difference over its bound
  double worst_relative = 0;
  double loss = 0;
  double largest_loss = 0;
  double largest_relative_loss = 0;
  for (std::size_t i = 0; i < before.pixels(); ++i) {
    const double size =
        std::max({before.planes.at("R").at(i), before.planes.at("G").at(i), before.planes.at("B").at(i)});
    std::size_t k = 0;
    for (const char* name : {"R", "G", "B"}) {
      const double got = after.planes.at(name).at(i);
      const double difference = std::abs(got - expected.rgb[i][k]);
      outside += difference <= expected.bound[i][k] ? 0 : 1;
      if (expected.bound[i][k] > 0) worst = std::max(worst, difference / expected.bound[i][k]);
      if (size > 1e-3) worst_relative = std::max(worst_relative, difference / size);
      const double lost = std::abs(got - before.planes.at(name).at(i));
      loss += lost / (3 * static_cast<double>(before.pixels()));
      largest_loss = std::max(largest_loss, lost);
      if (size > 1e-3) largest_relative_loss = std::max(largest_relative_loss, lost / size);
      ++k;
    }
  }
  EXPECT_EQ(outside, 0U) << "components further from the oracle than the bound, the worst by " << worst;
  const auto record = [](const char* name, double v) {
    testing::Test::RecordProperty(name, fmt::format("{:.4g}", v));
  };
  record("worst_share_of_bound", worst);
  record("worst_difference_over_largest_component", worst_relative);
  record("smits_mean_loss", loss);
  record("smits_largest_loss", largest_loss);
  record("smits_largest_loss_over_largest_component", largest_relative_loss);
}

TEST(RoundTrip, FloatSpectraOfAPhotographAgreeWithTheOracle) {
  SPECTILE_NEEDS_IMAGES("rgb");
  check_round_trip(SampleType::kFloat);
}

TEST(RoundTrip, HalfSpectraOfAPhotographAgreeWithTheOracle) {
  SPECTILE_NEEDS_IMAGES("rgb");
  check_round_trip(SampleType::kHalf);
}

}  // namespace
}  // namespace spectile
