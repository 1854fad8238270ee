// Mip levels: reading every level, averages of areas straight from the definition, and textures to try.
#pragma once

#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile::test {

/// Reads every level, tile by tile, with OpenEXR's own class; only channels of `wanted` where there are some.
inline std::vector<Picture> read_levels(const std::string& path, std::array<int, 2> tile = {64, 64},
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
    Picture picture = blank(file.levelWidth(level), file.levelHeight(level), window.min);
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
inline std::vector<std::pair<int, double>> covered(int image, int level, int j) {
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
inline double area_average(const Picture& image, const std::string& channel, const Picture& level, int x,
                           int y) {
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
inline void check_averages(const std::vector<Picture>& levels, const Picture& image, double mixing) {
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

/// A folder with a texture, and what every conversion with levels is held to.
class Mipmap : public testing::Test {
 protected:
  /// A texture with black, noise, a colour of its own, alpha 0 here and there, depth, and names of objects.
  void make(int width, int height, Imf::PixelType type = Imf::HALF) {
    Picture picture = blank(width, height, {-5, 3});
    int channel = 0;
    for (const char* name : {"R", "G", "B"}) {
      const int c = channel++;
      picture.add(name, type, [=](int x, int y) {
        if (x < width / 2 && y < height / 3) return 0.0;
        return x > 3 * width / 4 ? 0.1 + 0.2 * c : noise(x, y, c) * 1.2 - 0.1;
      });
    }
    picture.add("A", Imf::HALF, [=](int x, int y) { return x > 2 && (x + y) % 7 == 0 ? 0 : 1; });
    picture.add("Z", Imf::FLOAT, [=](int x, int y) { return 100 * noise(x, y, 5); });
    picture.add("id", Imf::UINT, [](int x, int y) { return 1000 * y + x; });
    picture.header.insert("wrapmodes", Imf::StringAttribute("periodic,periodic"));
    write_scanlines(in_, picture);
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
    EXPECT_EQ(report->clamped_pixels, plain->clamped_pixels);
    EXPECT_EQ(report->skipped.masked_pixels, plain->skipped.masked_pixels);
    EXPECT_EQ(report->skipped.chunks, plain->skipped.chunks);
    const std::string bytes = file_bytes(folder_ / "mip.exr");
    EXPECT_EQ(report->bytes_written, bytes.size());
    for (const auto& [threads, skip] : {std::pair{1, true}, {4, false}, {3, true}}) {
      ASSERT_TRUE(run("again.exr", with(options, true, threads, skip)));
      EXPECT_TRUE(file_bytes(folder_ / "again.exr") == bytes) << threads << " threads, skip " << skip;
    }
    const auto levels = read_levels(folder_ / "mip.exr", options.tile.value_or(std::array{64, 64}));
    EXPECT_TRUE(levels[0].planes == read_picture(folder_ / "plain.exr").planes);
    options.pixel = SampleType::kFloat;
    options.compression = *Compression::parse("none");
    ASSERT_TRUE(run("float.exr", with(options, false)));
    check_averages(levels, read_picture(folder_ / "float.exr"), mixing);
  }

  const TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
};

// Of averages of weights or RGB: they are floats, of which samples are made by up to eight more operations.
inline constexpr double kMixing = 8 * 0x1p-24;

}  // namespace spectile::test
