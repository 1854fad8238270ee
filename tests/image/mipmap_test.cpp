// Mip levels: each pixel of each level is the average of the area that it covers of the spectra, or colours,
// of level 0, which is what it is without them.
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <spectile/image.hpp>
#include <spectile/settings.hpp>

#include "tests/image/exr_files.hpp"

namespace spectile {
namespace {

using test::Picture;
using test::Plane;
using testing::HasSubstr;

/// Reads every level, tile by tile, with OpenEXR's own class; only channels of `wanted` where there are some.
std::vector<Picture> read_levels(const std::string& path, std::array<int, 2> tile = {64, 64},
                                 const std::set<std::string>& wanted = {}) {
  Imf::TiledInputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const int width = window.max.x - window.min.x + 1;
  const int height = window.max.y - window.min.y + 1;
  EXPECT_EQ(file.header().lineOrder(), Imf::INCREASING_Y);
  EXPECT_EQ(static_cast<int>(file.tileXSize()), tile[0]);
  EXPECT_EQ(static_cast<int>(file.tileYSize()), tile[1]);
  EXPECT_EQ(file.levelMode(), Imf::MIPMAP_LEVELS);
  EXPECT_EQ(file.levelRoundingMode(), Imf::ROUND_DOWN);
  EXPECT_EQ(file.numLevels(), 1 + static_cast<int>(std::floor(std::log2(std::max(width, height)))));
  EXPECT_TRUE(file.isComplete());
  std::vector<Picture> out;
  for (int level = 0; level < file.numLevels(); ++level) {
    EXPECT_EQ(file.levelWidth(level), std::max(1, width >> level));
    EXPECT_EQ(file.levelHeight(level), std::max(1, height >> level));
    Picture picture = test::blank(file.levelWidth(level), file.levelHeight(level), window.min);
    for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
      if (!wanted.empty() && !wanted.contains(it.name())) continue;
      picture.add(it.name(), it.channel().type, [](int, int) { return 0; });
    }
    file.setFrameBuffer(picture.frame_buffer());
    for (int y = 0; y < file.numYTiles(level); ++y) {
      for (int x = 0; x < file.numXTiles(level); ++x) file.readTile(x, y, level);
    }
    out.push_back(std::move(picture));
  }
  return out;
}

/// The pixels along a side that pixel j of a level covers, and how much of each, in pixels of the image.
std::vector<std::pair<int, double>> covered(int image, int level, int j) {
  const double begin = static_cast<double>(j) * image / level;
  const double end = (j + 1.0) * image / level;
  std::vector<std::pair<int, double>> out;
  for (int i = static_cast<int>(begin); i < std::min<double>(end, image); ++i) {
    const double overlap = std::min(i + 1.0, end) - std::max<double>(i, begin);
    if (overlap > 1e-9) out.emplace_back(i, overlap);
  }
  return out;
}

/// The average of the area that a level's pixel covers, straight from the definition.
double area_average(const Picture& image, const std::string& channel, const Picture& level, int x, int y) {
  const Plane& plane = image.planes.at(channel);
  double sum = 0;
  double area = 0;
  for (const auto& [v, down] : covered(image.height(), level.height(), y)) {
    for (const auto& [u, across] : covered(image.width(), level.width(), x)) {
      sum += down * across * plane.at(image.index(u, v));
      area += down * across;
    }
  }
  return sum / area;
}

/// Checks all channels of all levels against averages of `image`, whose samples are those of level 0 before
/// rounding to the type written. `mixing`: the error, over the largest sample, of averages that were not made
/// of the samples themselves but of what they are linear in.
void check_averages(const std::vector<Picture>& levels, const Picture& image, double mixing) {
  for (std::size_t i = 1; i < levels.size(); ++i) {
    for (const auto& [name, plane] : levels[i].planes) {
      if (plane.type == Imf::UINT) continue;
      const bool spectral = name.starts_with("T.") || name.starts_with("S0.");
      double largest = 0;
      for (std::size_t p = 0; p < image.pixels(); ++p) {
        largest = std::max(largest, std::abs(image.planes.at(name).at(p)));
      }
      int bad = 0;
      for (int y = 0; y < levels[i].height(); ++y) {
        for (int x = 0; x < levels[i].width(); ++x) {
          const double expected = area_average(image, name, levels[i], x, y);
          // Half the distance of neighbouring numbers, of floats first, and what the doubles' sums lose.
          double bound = std::abs(expected) * (0x1p-24 + 1e-12) + 1e-14 * largest;
          if (plane.type == Imf::HALF) bound += std::abs(expected) * 0x1p-11 + 0x1p-25;
          if (spectral) bound += mixing * largest;
          if (std::abs(levels[i].at(name, x, y) - expected) <= bound) continue;
          if (++bad == 1) {
            ADD_FAILURE() << "level " << i << " " << name << " at " << x << "," << y << ": "
                          << levels[i].at(name, x, y) << ", expected " << expected << " +- " << bound;
          }
        }
      }
      EXPECT_EQ(bad, 0);
    }
  }
}

class Mipmap : public testing::Test {
 protected:
  /// A texture with black, noise, a colour of its own, alpha 0 here and there, depth, and names of objects.
  void make(int width, int height, Imf::PixelType type = Imf::HALF) {
    Picture picture = test::blank(width, height, {-5, 3});
    int channel = 0;
    for (const char* name : {"R", "G", "B"}) {
      const int c = channel++;
      picture.add(name, type, [=](int x, int y) {
        if (x < width / 2 && y < height / 3) return 0.0;
        return x > 3 * width / 4 ? 0.1 + 0.2 * c : test::noise(x, y, c) * 1.2 - 0.1;
      });
    }
    picture.add("A", Imf::HALF, [=](int x, int y) { return x > 2 && (x + y) % 7 == 0 ? 0 : 1; });
    picture.add("Z", Imf::FLOAT, [=](int x, int y) { return 100 * test::noise(x, y, 5); });
    picture.add("id", Imf::UINT, [](int x, int y) { return 1000 * y + x; });
    picture.header.insert("wrapmodes", Imf::StringAttribute("periodic,periodic"));
    test::write_scanlines(in_, picture);
  }

  template <class Options>
  static Options with(Options options, bool mipmap, int threads = 2, bool skip = true) {
    options.mipmap = mipmap;
    if (!options.tile && !mipmap) options.tile = {64, 64};
    options.threads = threads;
    options.skip = skip;
    return options;
  }

  using Convert = std::function<Result<ImageReport>(const std::string& output, const ImageOptions& changes)>;
  template <class Options, class Function>
  static Convert converter(const std::string& input, const Options& options, Function function) {
    return [=](const std::string& output, const ImageOptions& changes) {
      Options all = options;
      static_cast<ImageOptions&>(all) = changes;
      return function(input, output, all);
    };
  }

  /// Level 0 is the file without levels; all others are its averages; the bytes depend on no thread.
  void check(const Convert& convert, ImageOptions options, double mixing) {
    const auto run = [&](const char* name, const ImageOptions& changes) {
      auto report = convert(folder_ / name, changes);
      EXPECT_TRUE(report) << report.error().message;
      return report;
    };
    const auto report = run("mip.exr", with(options, true));
    const auto plain = run("plain.exr", with(options, false));
    ASSERT_TRUE(report && plain);
    EXPECT_EQ(report->width, plain->width);
    EXPECT_EQ(report->height, plain->height);
    EXPECT_EQ(report->nonfinite_pixels, plain->nonfinite_pixels);
    EXPECT_EQ(report->negative_pixels, plain->negative_pixels);
    EXPECT_EQ(report->out_of_gamut_pixels, plain->out_of_gamut_pixels);
    EXPECT_EQ(report->over_one_pixels, plain->over_one_pixels);
    EXPECT_EQ(report->limited_pixels, plain->limited_pixels);
    EXPECT_EQ(report->skipped.masked_pixels, plain->skipped.masked_pixels);
    EXPECT_EQ(report->skipped.chunks, plain->skipped.chunks);
    const std::string bytes = test::file_bytes(folder_ / "mip.exr");
    EXPECT_EQ(report->bytes_written, bytes.size());
    for (const auto& [threads, skip] : {std::pair{1, true}, {4, false}, {3, true}}) {
      ASSERT_TRUE(run("again.exr", with(options, true, threads, skip)));
      EXPECT_TRUE(test::file_bytes(folder_ / "again.exr") == bytes) << threads << " threads, skip " << skip;
    }
    const auto levels = read_levels(folder_ / "mip.exr", options.tile.value_or(std::array{64, 64}));
    EXPECT_TRUE(levels[0].planes == test::read_picture(folder_ / "plain.exr").planes);
    options.pixel = PixelType::kFloat;
    options.compression = *Compression::parse("none");
    ASSERT_TRUE(run("float.exr", with(options, false)));
    check_averages(levels, test::read_picture(folder_ / "float.exr"), mixing);
  }

  const test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
};

// Of averages of weights or RGB: they are floats, of which samples are made by up to eight more operations.
constexpr double kMixing = 8 * 0x1p-24;

TEST_F(Mipmap, LevelsAreAveragesOfSpectraForEveryMethodAndQuantity) {
  make(37, 23);
  for (const std::string& name : method_names()) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
      for (const PixelType pixel : {PixelType::kHalf, PixelType::kFloat}) {
        SCOPED_TRACE(name + " " + std::string(to_string(quantity)) +
                     (pixel == PixelType::kHalf ? " half" : " float"));
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
    for (const Method method : {Method::kSmitsExact, Method::kSigmoid}) {
      UpsampleImageOptions options;
      options.bands = *Bands::uniform(400, 700, 25);
      options.method = method;
      options.pixel = PixelType::kFloat;
      options.tile = {16, 32};
      check(converter(in_, options, &upsample_image), options, method == Method::kSigmoid ? 0 : kMixing);
    }
  }
}

TEST_F(Mipmap, OfSamplesThatAreLimitedAreAveragesOfThose) {
  make(37, 23);
  for (const GamutPolicy policy : {GamutPolicy::kClip, GamutPolicy::kKeep}) {
    for (const Negative negative : {Negative::kGamut, Negative::kClip, Negative::kKeep}) {
      for (const Method method : {Method::kSmits, Method::kSmits1999, Method::kMallett}) {
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
    for (const PixelType pixel : {PixelType::kHalf, PixelType::kFloat}) {
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

TEST_F(Mipmap, WorkWithEveryCompression) {
  make(131, 67);
  UpsampleImageOptions options;
  options.bands = *Bands::uniform(400, 700, 25);
  options.mipmap = true;
  options.compression = *Compression::parse("none");
  ASSERT_TRUE(upsample_image(in_, folder_ / "none.exr", options));
  const auto expected = read_levels(folder_ / "none.exr");
  for (const char* name : {"rle", "zips", "zip", "zip:4", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    SCOPED_TRACE(name);
    options.compression = *Compression::parse(name);
    ASSERT_TRUE(upsample_image(in_, folder_ / "out.exr", options));
    const auto got = read_levels(folder_ / "out.exr");
    const std::string kind = name;
    const bool loses = kind.starts_with("b44") || kind.starts_with("dwa");
    double first_error = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      double error = 0;
      for (const auto& [channel, plane] : got[i].planes) {
        const Plane& exact = expected[i].planes.at(channel);
        if (!loses && (kind != "pxr24" || plane.type != Imf::FLOAT)) {
          EXPECT_TRUE(plane == exact) << channel << " of level " << i;
        }
        for (std::size_t p = 0; plane.type == Imf::HALF && p < got[i].pixels(); ++p) {
          error = std::max(error, std::abs(plane.at(p) - exact.at(p)));
        }
      }
      // What is lost of noise is lost of its averages too, but no more.
      if (i == 0) first_error = error;
      EXPECT_LE(error, first_error) << "level " << i;
    }
  }
}

TEST_F(Mipmap, WholeNumbersAreThoseNearestToTheCentre) {
  make(37, 23);
  UpsampleImageOptions options;
  options.mipmap = true;
  ASSERT_TRUE(upsample_image(in_, folder_ / "out.exr", options));
  for (const Picture& level : read_levels(folder_ / "out.exr")) {
    for (int y = 0; y < level.height(); ++y) {
      for (int x = 0; x < level.width(); ++x) {
        const auto from = [](int image, int side, int at) {
          return static_cast<int>(std::floor((at + 0.5) * image / side + 1e-9));
        };
        EXPECT_EQ(level.at("id", x, y), 1000 * from(23, level.height(), y) + from(37, level.width(), x));
      }
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
  options.region = {6, 9, 60, 41};
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
  for (const Method method : {Method::kSmitsExact, Method::kMallett, Method::kSigmoid}) {
    UpsampleImageOptions options;
    options.method = method;
    options.pixel = PixelType::kFloat;
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
    // The preview is what it was; an average with NaN is NaN.
    EXPECT_TRUE(std::isnan(levels[1].at("R", 0, 0)));
  }
}

/// Levels too large to be kept, 64 MiB, are made strip by strip in passes of their own.
TEST_F(Mipmap, ThatDoNotFitIntoMemoryAreTheSame) {
  constexpr int kWidth = 401;
  constexpr int kHeight = 641;
  make(kWidth, kHeight);
  UpsampleImageOptions options;
  options.method = Method::kSigmoid;
  options.bands = *Bands::uniform(400, 700, 1.25);
  options.compression = *Compression::parse("none");
  options.mipmap = true;
  ASSERT_TRUE(upsample_image(in_, folder_ / "out.exr", options));
  const std::set<std::string> some = {
      "T.400,625000nm", "T.550,625000nm", "T.699,375000nm", "A", "Z", "R", "id"};
  auto levels = read_levels(folder_ / "out.exr", {64, 64}, some);
  ASSERT_EQ(levels[1].planes.size(), some.size());
  levels.resize(4);
  // The same samples, at these centres only.
  options.mipmap = false;
  options.store = Store::kCoefficients;
  ASSERT_TRUE(upsample_image(in_, folder_ / "c.exr", options));
  ExpandImageOptions expand;
  expand.pixel = PixelType::kFloat;
  expand.bands = *Bands::from_centres(std::vector<double>{400.625, 550.625, 699.375});
  ASSERT_TRUE(expand_image(folder_ / "c.exr", folder_ / "float.exr", expand));
  check_averages(levels, test::read_picture(folder_ / "float.exr"), 0);
  for (const Picture& level : levels) {
    for (int y = 0; y < level.height(); ++y) {
      const int from = (2 * y + 1) * kHeight / (2 * level.height());
      EXPECT_EQ(std::floor(level.at("id", 0, y) / 1000), from);
    }
  }
}

TEST_F(Mipmap, CoefficientsHaveSomeOnlyWhereTheyAreLinear) {
  make(37, 23);
  for (const std::string& name : method_names()) {
    SCOPED_TRACE(name);
    UpsampleImageOptions options;
    options.bands = *Bands::uniform(400, 700, 25);
    options.method = *parse_method(name);
    options.store = Store::kCoefficients;
    options.mipmap = true;
    const auto report = upsample_image(in_, folder_ / (name + ".exr"), options);
    if (options.method == Method::kMallett) {
      ASSERT_TRUE(report) << report.error().message;
      continue;
    }
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
    EXPECT_THAT(report.error().message, HasSubstr("coefficients of " + name + " have no mip levels"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / (name + ".exr")));
  }
  // Those of averages are averages.
  UpsampleImageOptions options;
  options.bands = *Bands::uniform(400, 700, 25);
  options.method = Method::kMallett;
  options.store = Store::kCoefficients;
  check(converter(in_, options, &upsample_image), options, 0);
}

TEST_F(Mipmap, StopsAtBadPixelsAndOnRequest) {
  Picture picture = test::blank(200, 130);
  test::add_rgb_noise(picture, Imf::FLOAT);
  picture.planes.at("G").set(picture.index(150, 70), std::nan(""));
  test::write_scanlines(in_, picture);
  UpsampleImageOptions options;
  options.mipmap = true;
  const auto bad = upsample_image(in_, folder_ / "out.exr", options);
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("1 non-finite pixel, the first at 150,70"));
  options.nonfinite = NonFinite::kZero;
  Progress last;
  options.progress = [&](const Progress& progress) {
    EXPECT_LE(last.pixels_done, progress.pixels_done);
    last = progress;
    return true;
  };
  const auto good = upsample_image(in_, folder_ / "out.exr", options);
  ASSERT_TRUE(good) << good.error().message;
  EXPECT_EQ(good->nonfinite_pixels, 1U);
  EXPECT_EQ(last.pixels_done, last.pixels);
  std::uint64_t pixels = 0;
  for (const Picture& level : read_levels(folder_ / "out.exr")) pixels += level.pixels();
  EXPECT_EQ(last.pixels, pixels);
  std::filesystem::remove(folder_ / "out.exr");
  options.progress = [](const Progress& progress) { return progress.pixels_done <= 200 * 130; };
  const auto cancelled = upsample_image(in_, folder_ / "out.exr", options);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
}

TEST_F(Mipmap, AttributesThatDescribeTheTexturePassThrough) {
  make(37, 23);
  UpsampleImageOptions options;
  options.mipmap = true;
  ASSERT_TRUE(upsample_image(in_, folder_ / "out.exr", options));
  const Imf::TiledInputFile file((folder_ / "out.exr").c_str());
  EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("wrapmodes").value(), "periodic,periodic");
}

TEST_F(Mipmap, FilesThatWereCutAreNotUpToDate) {
  make(200, 130);
  UpsampleImageOptions options;
  options.mipmap = true;
  const std::string out = folder_ / "out.exr";
  ASSERT_TRUE(upsample_image(in_, out, options));
  const std::vector<std::string> from = {in_};
  const auto fresh = [&] {
    std::filesystem::last_write_time(out, std::filesystem::last_write_time(in_) + std::chrono::hours(1));
    return up_to_date(out, from, settings_text(options));
  };
  EXPECT_TRUE(fresh());
  const std::string bytes = test::file_bytes(out);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{100}, bytes.size() / 5}) {
    test::write_text(out, bytes.substr(0, bytes.size() - cut));
    EXPECT_FALSE(fresh()) << cut;
  }
}

}  // namespace
}  // namespace spectile
