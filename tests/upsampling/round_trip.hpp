// From RGB to spectra and back: grids of colours, and how far those that return are from those that went.
#pragma once

#include <gtest/gtest.h>

#include <spectile/color/color_difference.hpp>
#include <spectile/color/colorimetry.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>

#include "tests/support/lanes.hpp"

namespace spectile::test {

using Rgb = std::array<float, 3>;

/// Name of a test's parameter.
inline std::string sigmoid_method_name(const testing::TestParamInfo<Method>& method) {
  return method.param == Method::kSigmoid ? "sigmoid" : "sigmoidobserver";
}

/// The cube at n^3 even points, corners included.
inline ColorLanes cube_grid(std::size_t n) {
  auto rgb = *ColorLanes::create(n * n * n);
  const auto level = [&](std::size_t i) { return static_cast<float>(i) / static_cast<float>(n - 1); };
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    rgb.at(i, 0) = level(i / (n * n));
    rgb.at(i, 1) = level(i / n % n);
    rgb.at(i, 2) = level(i % n);
  }
  return rgb;
}

inline ColorLanes lanes_of(std::span<const Rgb> colors) {
  auto rgb = *ColorLanes::create(colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = colors[i][k];
  }
  return rgb;
}
inline ColorLanes lanes_of(std::initializer_list<Rgb> colors) {
  return lanes_of(std::span(colors.begin(), colors.size()));
}

/// The corners of the cube; bit 0 of a lane's number is red, bit 1 green, bit 2 blue.
inline ColorLanes cube_corners() {
  auto rgb = *ColorLanes::create(8);
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = static_cast<float>(i >> k & 1U);
  }
  return rgb;
}

inline ColorLanes random_colors(std::size_t lanes, std::uint32_t seed, float low = 0, float high = 1) {
  const Floats values = plain_floats(3 * lanes, seed, low, high);
  auto rgb = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < 3 * lanes; ++i) rgb.at(i / 3, i % 3) = values[i];
  return rgb;
}

inline SampledSpectra spectra_of(const Upsampler& upsampler, const ColorLanes& rgb,
                                 const Execution& execution = {}) {
  auto spectra = *SampledSpectra::create(upsampler.bands(), rgb.lanes());
  const auto done = upsample_srgb(upsampler, rgb.view(), spectra.span(), StoreHint::kAuto, execution);
  EXPECT_TRUE(done);
  return spectra;
}

/// The sensor that the upsampler was made for.
inline Projector projector_of(const Upsampler& upsampler) {
  const UpsamplerOptions& options = upsampler.options();
  if (upsampler.quantity() == Quantity::kIlluminant) {
    return *Projector::emissive(upsampler.bands(), options.observer);
  }
  const MeasuredSpectrum light = options.light ? *options.light : *illuminant("D65");
  return *Projector::reflective(upsampler.bands(), light, options.observer);
}

/// Differences of colours that went to spectra and back, by the public way: upsample_srgb(), project(), the
/// inverse of the upsampler's matrix.
struct RoundTrip {
  double rgb = 0;         ///< largest difference of a component
  double ciede2000 = 0;   ///< largest difference, relative to the perfect diffuser or light
  std::size_t worst = 0;  ///< lane of `rgb`
  float least = kInf;     ///< least and greatest sample
  float greatest = -kInf;
};

inline RoundTrip round_trip(const Upsampler& upsampler, const ColorLanes& rgb, bool differences = true) {
  const SampledSpectra spectra = spectra_of(upsampler, rgb);
  auto xyz = *ColorLanes::create(rgb.lanes());
  const Projector projector = projector_of(upsampler);
  EXPECT_TRUE(project(projector, spectra.view(), xyz.span()));
  const Matrix3 back = inverse(upsampler.rgb_to_xyz());
  const std::array<double, 3> white = times(upsampler.rgb_to_xyz(), {1, 1, 1});
  RoundTrip out;
  for (std::size_t i = 0; i < rgb.lanes(); ++i) {
    const std::array<double, 3> asked = {rgb.at(i, 0), rgb.at(i, 1), rgb.at(i, 2)};
    const std::array<double, 3> seen = {xyz.at(i, 0), xyz.at(i, 1), xyz.at(i, 2)};
    const std::array<double, 3> got = times(back, seen);
    for (std::size_t k = 0; k < 3; ++k) {
      const double difference = std::abs(got[k] - asked[k]);
      if (difference <= out.rgb) continue;
      out.rgb = difference;
      out.worst = i;
    }
    if (differences) {
      const Lab want = xyz_to_lab(times(upsampler.rgb_to_xyz(), asked), white);
      out.ciede2000 = std::max(out.ciede2000, spectile::ciede2000(want, xyz_to_lab(seen, white)));
    }
    for (std::size_t b = 0; b < upsampler.bands().count(); ++b) {
      out.least = std::min(out.least, spectra.at(i, b));
      out.greatest = std::max(out.greatest, spectra.at(i, b));
    }
  }
  return out;
}

inline CoefficientLanes coefficients_of(const Upsampler& upsampler, const ColorLanes& rgb,
                                        const Execution& execution = {}) {
  auto out = *CoefficientLanes::create(upsampler, rgb.lanes());
  EXPECT_TRUE(coefficients(upsampler, rgb.view(), out, execution));
  return out;
}

/// Colours whose components are the values, repeated.
inline ColorLanes colors(std::size_t lanes, const Floats& values) {
  auto rgb = *ColorLanes::create(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) rgb.at(i, k) = values[(3 * i + k) % values.size()];
  }
  return rgb;
}

}  // namespace spectile::test
