// Mip levels: each pixel of each level is the average of the area that it covers of the spectra, or colours,
// of level 0, which is what it is without them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/image.hpp>
#include <spectile/image/settings.hpp>

#include "tests/io/convert/frame/mipmap_support.hpp"

namespace spectile {
namespace {

using test::kMixing;
using test::Mipmap;
using test::Picture;
using test::Plane;
using test::read_levels;
using testing::HasSubstr;

TEST_F(Mipmap, LevelsAreAveragesOfSpectraForEveryMethodAndQuantity) {
  make(37, 23);
  for (const std::string& name : method_names()) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
      for (const SampleType pixel : {SampleType::kHalf, SampleType::kFloat}) {
        SCOPED_TRACE(name + " " + std::string(to_string(quantity)) +
                     (pixel == SampleType::kHalf ? " half" : " float"));
        UpsampleImageOptions options;
        options.bands = *Bands::uniform(400, 700, 25);
        options.method = *parse_method(name);
        options.quantity = quantity;
        options.pixel = pixel;
        // Samples of the sigmoid are averaged themselves.
        check(converter(in_, options, &upsample_image), options,
              options.method == Method::kSigmoid ? 0 : kMixing);
      }
    }
  }
}

TEST_F(Mipmap, SizesThatDoNotHalveAreCoveredExactly) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 13}, {19, 1}, {2, 3}, {64, 32}, {97, 101}, {100, 60}, {127, 2}, {129, 65}}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    make(width, height, width % 2 == 0 ? Imf::FLOAT : Imf::HALF);
    for (const Method method : {Method::kSmitsExact, Method::kSigmoid, Method::kTetrahedral}) {
      UpsampleImageOptions options;
      options.bands = *Bands::uniform(400, 700, 25);
      options.method = method;
      options.pixel = SampleType::kFloat;
      options.tile = {16, 32};
      check(converter(in_, options, &upsample_image), options, method == Method::kSigmoid ? 0 : kMixing);
    }
  }
}

TEST_F(Mipmap, OfSamplesThatAreLimitedAreAveragesOfThose) {
  make(37, 23);
  for (const GamutPolicy policy : {GamutPolicy::kClip, GamutPolicy::kKeep}) {
    for (const NegativeInput negative : {NegativeInput::kGamut, NegativeInput::kClip, NegativeInput::kKeep}) {
      for (const Method method :
           {Method::kSmits, Method::kSmits1999, Method::kMallett, Method::kTetrahedral}) {
        SCOPED_TRACE(to_string(method));
        UpsampleImageOptions options;
        options.bands = *Bands::uniform(400, 700, 25);
        options.method = method;
        options.out_of_gamut = policy;
        options.negative = negative;
        check(converter(in_, options, &upsample_image), options, kMixing);
      }
    }
  }
}

TEST_F(Mipmap, OfExpandedImagesAreThoseOfUpsampledOnes) {
  make(37, 23);
  for (const std::string& name : method_names()) {
    SCOPED_TRACE(name);
    UpsampleImageOptions up;
    up.bands = *Bands::uniform(400, 700, 25);
    up.method = *parse_method(name);
    up.store = Store::kCoefficients;
    ASSERT_TRUE(upsample_image(in_, folder_ / "c.exr", up));
    const ExpandImageOptions options;
    check(converter(folder_ / "c.exr", options, &expand_image), options,
          up.method == Method::kSigmoid ? 0 : kMixing);
    up.store = Store::kSpectra;
    up.mipmap = true;
    ASSERT_TRUE(upsample_image(in_, folder_ / "s.exr", up));
    ExpandImageOptions expand;
    expand.mipmap = true;
    ASSERT_TRUE(expand_image(folder_ / "c.exr", folder_ / "e.exr", expand));
    const auto a = read_levels(folder_ / "s.exr");
    const auto b = read_levels(folder_ / "e.exr");
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i].planes == b[i].planes) << i;
  }
}

TEST_F(Mipmap, OfExpandedImagesWithComponentsBelowZeroAreAveragesOfLimitedSpectra) {
  make(37, 23);
  UpsampleImageOptions up;
  up.bands = *Bands::uniform(400, 700, 25);
  up.store = Store::kCoefficients;
  ASSERT_TRUE(upsample_image(in_, folder_ / "c.exr", up));
  Picture picture = test::read_picture(folder_ / "c.exr");
  for (std::size_t i = 0; i < picture.pixels(); i += 3) picture.planes.at("spectile.c1").set(i, -0.3);
  test::write_scanlines(folder_ / "below.exr", picture);
  const ExpandImageOptions options;
  check(converter(folder_ / "below.exr", options, &expand_image), options, 0);
}

TEST_F(Mipmap, OfProjectedAndRelitImagesAreAveragesOfColours) {
  make(45, 70);
  UpsampleImageOptions up;
  up.bands = *Bands::uniform(400, 700, 25);
  ASSERT_TRUE(upsample_image(in_, folder_ / "s.exr", up));
  for (const ColorTarget target : {ColorTarget::kSrgb, ColorTarget::kXyz, ColorTarget::kLuminance}) {
    for (const SampleType pixel : {SampleType::kHalf, SampleType::kFloat}) {
      ProjectImageOptions project;
      project.target = target;
      project.pixel = pixel;
      check(converter(folder_ / "s.exr", project, &project_image), project, 0);
      RelightImageOptions relight({"A", *illuminant("A")});
      relight.target = target;
      relight.pixel = pixel;
      check(converter(in_, relight, &relight_image), relight, 0);
    }
  }
}

TEST_F(Mipmap, WithARegionAreThoseOfThePartAlone) {
  make(90, 70);
  Picture mask = test::blank(90, 70);
  mask.add("A", Imf::FLOAT, [](int x, int y) { return (x / 5 + y / 3) % 2; });
  test::write_scanlines(folder_ / "mask.exr", mask);
  UpsampleImageOptions options;
  options.bands = *Bands::uniform(400, 700, 25);
  options.masking = Masking::kFile;
  options.mask = folder_ / "mask.exr";
  options.region = {6, 9, 61, 42};
  check(converter(in_, options, &upsample_image), options, kMixing);
  Imf::TiledInputFile file((folder_ / "mip.exr").c_str());
  EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({6, 9}, {60, 41}));
}

TEST_F(Mipmap, WhatIsMaskedCountsAsBlack) {
  Picture picture = test::blank(2, 2);
  for (const char* name : {"R", "G", "B"}) {
    picture.add(name, Imf::FLOAT, [](int x, int) { return x == 0 ? 0.5 : std::nan(""); });
  }
  picture.add("A", Imf::HALF, [](int x, int) { return x == 0 ? 1 : 0; });
  test::write_scanlines(in_, picture);
  for (const Method method :
       {Method::kSmitsExact, Method::kMallett, Method::kSigmoid, Method::kTetrahedral}) {
    UpsampleImageOptions options;
    options.method = method;
    options.masking = Masking::kAlpha;
    options.pixel = SampleType::kFloat;
    options.mipmap = true;
    const auto report = upsample_image(in_, folder_ / "out.exr", options);
    ASSERT_TRUE(report) << report.error().message;
    const auto levels = read_levels(folder_ / "out.exr");
    ASSERT_EQ(levels.size(), 2U);
    for (const auto& [name, plane] : levels[1].planes) {
      if (!name.starts_with("T.")) continue;
      EXPECT_NEAR(plane.at(0), 0.25, 1e-3) << name;
    }
    EXPECT_EQ(levels[1].at("A", 0, 0), 0.5);
    EXPECT_EQ(levels[1].at("R", 0, 0), 0.25);
  }
}

/// Levels too large to be kept, 64 MiB, are made strip by strip in passes of their own.
}  // namespace
}  // namespace spectile
