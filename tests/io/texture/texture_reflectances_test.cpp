// texture_reflectances: few reflectances stand for a texture's colours.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/plan_file.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::blank;
using test::Picture;
using Color = std::array<double, 3>;

/// A picture whose pixel i has the colour colors[i % size], over several strips.
void write_colors(const std::string& path, const std::vector<Color>& colors, int width, int height) {
  Picture picture = blank(width, height, {-3, 5});
  int c = 0;
  for (const char* name : {"R", "G", "B"}) {
    const auto at = static_cast<std::size_t>(c++);
    picture.add(name, Imf::FLOAT, [&, at](int x, int y) {
      return colors[static_cast<std::size_t>(y * width + x) % colors.size()][at];
    });
  }
  test::write_scanlines(path, picture);
}

Color rgb_of(const Spectrum& spectrum) {
  return std::get<UpsampledSpectrum>(spectrum.kind()).rgb();
}

TEST(TextureReflectances, FewColorsComeBackMostFrequentFirst) {
  test::TempFolder folder;
  const Color red = {0.8, 0.1, 0.1};
  const Color grey = {0.5, 0.5, 0.5};
  const Color blue = {0.05, 0.1, 0.7};
  write_colors(folder / "in.exr", {grey, blue, grey, {0, 0, 0}, red, grey, blue}, 70, 500);
  const auto found = texture_reflectances(folder / "in.exr", 16);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 3U);
  const Color expected[] = {grey, blue, red};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb_of((*found)[i])[c], expected[i][c], 1e-6) << i;
    // Over the whole range of the observers.
    for (double nm = 360; nm <= 830; nm += 10) {
      EXPECT_GE((*found)[i](nm), 0);
      EXPECT_LE((*found)[i](nm), 1.0001);
    }
  }
}

TEST(TextureReflectances, ManyColorsAreStoodForAllOverTheirRange) {
  test::TempFolder folder;
  Picture picture = blank(300, 200);
  test::add_rgb_noise(picture, Imf::HALF);
  // A rare colour far from all others.
  for (const char* name : {"R", "G", "B"}) {
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      picture.planes[name].set(i, 0.2 * picture.planes[name].at(i));
    }
    picture.planes[name].set(777, name[0] == 'R' ? 1.0 : 0.0);
  }
  test::write_scanlines(folder / "in.exr", picture);
  for (const std::size_t most : {1U, 7U, 64U}) {
    const auto found = texture_reflectances(folder / "in.exr", most);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_EQ(found->size(), most);
    if (most < 7) continue;
    const bool has_red = std::any_of(found->begin(), found->end(), [](const Spectrum& s) {
      return rgb_of(s)[0] > 0.9 && rgb_of(s)[1] < 0.02;
    });
    EXPECT_TRUE(has_red);
    double least = 1;
    double largest = 0;
    for (const Spectrum& s : *found) {
      if (rgb_of(s)[0] > 0.9) continue;
      least = std::min(least, rgb_of(s)[1]);
      largest = std::max(largest, rgb_of(s)[1]);
    }
    EXPECT_LT(least, most == 64 ? 0.04 : 0.1);
    EXPECT_GT(largest, most == 64 ? 0.15 : 0.1);
  }
}

TEST(TextureReflectances, AreTheSameWhateverTheThreads) {
  test::TempFolder folder;
  Picture picture = blank(123, 321);
  test::add_rgb_noise(picture, Imf::HALF);
  test::write_scanlines(folder / "in.exr", picture);
  MethodOptions options;
  options.threads = 1;
  const auto one = texture_reflectances(folder / "in.exr", 50, options);
  options.threads = 3;
  const auto three = texture_reflectances(folder / "in.exr", 50, options);
  ASSERT_TRUE(one && three);
  ASSERT_EQ(one->size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(rgb_of((*one)[i]), rgb_of((*three)[i]));
}

TEST(TextureReflectances, WorkByEveryMethod) {
  test::TempFolder folder;
  write_colors(folder / "in.exr", {{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0.5, -0.2}}, 20, 20);
  for (const std::string& name : method_names()) {
    MethodOptions options;
    options.method = *parse_method(name);
    const auto found = texture_reflectances(folder / "in.exr", 16, options);
    ASSERT_TRUE(found) << name << found.error().message;
    EXPECT_EQ(found->size(), 5U) << name;
  }
}

TEST(TextureReflectances, ErrorsAreThoseOfUpsampling) {
  test::TempFolder folder;
  write_colors(folder / "in.exr", {{0.5, 0.5, 0.5}, {NAN, 0, 0}}, 20, 20);
  const auto nan = texture_reflectances(folder / "in.exr", 16);
  ASSERT_FALSE(nan);
  EXPECT_EQ(nan.error().code, ErrorCode::kNonFinite);
  MethodOptions options;
  options.nonfinite = NonFinite::kZero;
  EXPECT_EQ(texture_reflectances(folder / "in.exr", 16, options)->size(), 1U);
  EXPECT_EQ(texture_reflectances(folder / "none.exr", 16).error().code, ErrorCode::kBadFile);
  EXPECT_EQ(texture_reflectances(folder / "in.exr", 0).error().code, ErrorCode::kBadArgument);
  options.quantity = Quantity::kIlluminant;
  EXPECT_EQ(texture_reflectances(folder / "in.exr", 16, options).error().code, ErrorCode::kBadArgument);
  options.quantity = Quantity::kReflectance;
  options.progress = [](const Progress&) { return false; };
  EXPECT_EQ(texture_reflectances(folder / "in.exr", 16, options).error().code, ErrorCode::kCancelled);
  write_colors(folder / "black.exr", {{0, 0, 0}}, 20, 20);
  EXPECT_TRUE(texture_reflectances(folder / "black.exr", 16)->empty());
}

}  // namespace
}  // namespace spectile
