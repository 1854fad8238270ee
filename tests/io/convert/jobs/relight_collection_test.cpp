// Relighting gives what upsampling and projecting give, on every real image at hand: alpha 0, negative and
// huge colours, NaN, windows, luminance and chroma, several parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <spectile/image/image.hpp>
#include <spectile/upsampling/relight.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> collection() {
  std::vector<std::string> out;
  const fs::path folder = fs::path(SPECTILE_TEST_SHARED) / "images" / "rgb";
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".exr") out.push_back(entry.path().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

const Bands& bands() {
  static const Bands few = *Bands::uniform(400, 700, 10);
  return few;
}

struct Both {
  ImageReport relit;
  ImageReport upsampled;
  test::Picture direct;
  test::Picture by_spectra;
};

/// The same texture both ways. Nothing where both refuse it for the same reason.
std::optional<Both> convert(const std::string& input, Method method, const test::TempFolder& folder) {
  RelightImageOptions relight({"A", *illuminant("A")});
  relight.method = method;
  relight.bands = bands();
  relight.pixel = SampleType::kFloat;
  relight.nonfinite = NonFinite::kZero;
  UpsampleImageOptions up;
  up.method = method;
  up.bands = bands();
  up.pixel = SampleType::kFloat;
  up.nonfinite = NonFinite::kZero;
  const auto relit = relight_image(input, folder / "relit.exr", relight);
  const auto upsampled = upsample_image(input, folder / "spectra.exr", up);
  EXPECT_EQ(static_cast<bool>(relit), static_cast<bool>(upsampled)) << input;
  if (!relit || !upsampled) {
    if (!relit && !upsampled) {
      EXPECT_EQ(relit.error().message, upsampled.error().message);
    }
    return std::nullopt;
  }
  ProjectImageOptions down;
  down.pixel = SampleType::kFloat;
  down.light = *illuminant("A");
  down.nonfinite = NonFinite::kZero;
  const auto projected = project_image(folder / "spectra.exr", folder / "projected.exr", down);
  EXPECT_TRUE(projected) << projected.error().message;
  if (!projected) return std::nullopt;
  return Both{*relit, *upsampled, test::read_picture(folder / "relit.exr"),
              test::read_picture(folder / "projected.exr")};
}

class RelitCollection : public testing::TestWithParam<Method> {};

TEST_P(RelitCollection, IsWhatUpsamplingAndProjectingGive) {
  const std::vector<std::string> images = collection();
  if (images.empty()) GTEST_SKIP() << "no images in " << SPECTILE_TEST_SHARED;
  const Method method = GetParam();
  const auto upsampler = *Upsampler::create(method, Quantity::kReflectance, bands());
  const auto projector = *Projector::reflective(bands(), *illuminant("A"));
  const auto relighter = *Relighter::create(upsampler, projector, projector.xyz_to_srgb());
  std::size_t compared = 0;
  for (const std::string& input : images) {
    const test::TempFolder folder;
    const auto both = convert(input, method, folder);
    if (!both) continue;
    ++compared;
    EXPECT_EQ(both->relit.negative_pixels, both->upsampled.negative_pixels) << input;
    EXPECT_EQ(both->relit.over_one_pixels, both->upsampled.over_one_pixels) << input;
    EXPECT_EQ(both->relit.nonfinite_pixels, both->upsampled.nonfinite_pixels) << input;
    EXPECT_EQ(both->relit.out_of_gamut_pixels, both->upsampled.out_of_gamut_pixels) << input;
    ASSERT_EQ(both->direct.planes.size(), both->by_spectra.planes.size()) << input;
    for (const auto& [name, plane] : both->direct.planes) {
      ASSERT_TRUE(both->by_spectra.planes.contains(name)) << input << " " << name;
      const test::Plane& longest = both->by_spectra.planes.at(name);
      const std::size_t k = name == "R" ? 0 : name == "G" ? 1 : 2;
      const bool color = name == "R" || name == "G" || name == "B";
      // The sigmoid's spectra are the same; mixtures differ in the order of sums, relative to the brightest.
      const bool exact = !color || is_sigmoid(method);
      if (exact) {
        ASSERT_EQ(plane, longest) << input << " " << name;
        continue;
      }
      for (std::size_t i = 0; i < both->direct.pixels(); ++i) {
        double brightest = 1;
        for (const char* c : {"R", "G", "B"}) {
          brightest = std::max(brightest, std::abs(both->by_spectra.planes.at(c).at(i)));
        }
        ASSERT_NEAR(plane.at(i), longest.at(i), 4 * relighter.bound()[k] * brightest)
            << input << " " << name << " pixel " << i;
      }
    }
  }
  EXPECT_GT(compared, 10U);
}

INSTANTIATE_TEST_SUITE_P(Methods, RelitCollection,
                         testing::Values(Method::kSmitsExact, Method::kMallett, Method::kSigmoid,
                                         Method::kSigmoidObserver, Method::kTetrahedral),
                         [](const auto& method) {
                           std::string name(to_string(method.param));
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace spectile
