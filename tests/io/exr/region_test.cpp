// Regions: their pixels are those of the whole conversion, and what they do not touch is not read.
#include <OpenEXR/ImfRgbaFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

using test::Picture;
using testing::HasSubstr;
/// The first and the last pixel, both included.
using Region = std::array<int, 4>;

PixelWindow window_of(const Region& r) {
  return PixelWindow::inclusive(r[0], r[1], r[2], r[3]);
}

constexpr int kWidth = 150;
constexpr int kHeight = 97;

/// How an input is stored.
struct Storage {
  const char* name;
  unsigned tile;  // side; 0: lines
  bool mipmaps = false;
  Imath::V2i origin = {0, 0};
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  Imf::LineOrder order = Imf::INCREASING_Y;
};

std::ostream& operator<<(std::ostream& to, const Storage& storage) {
  return to << storage.name;
}

void write(const std::string& path, Picture& picture, const Storage& storage) {
  picture.header.compression() = storage.compression;
  picture.header.lineOrder() = storage.order;
  if (storage.tile > 0) {
    test::write_tiles(path, picture, storage.tile, storage.mipmaps);
  } else {
    test::write_scanlines(path, picture);
  }
}

Picture rgb_picture(const Storage& storage) {
  Picture picture = test::blank(kWidth, kHeight, storage.origin);
  test::add_rgb_noise(picture, Imf::HALF);
  picture.add("A", Imf::FLOAT, [](int x, int y) { return test::noise(x, y, 7); });
  picture.add("id", Imf::UINT, [](int x, int y) { return 1000 * y + x; });
  picture.header.displayWindow() = Imath::Box2i({-1000, -1000}, {1000, 1000});
  return picture;
}

/// Expects a file to hold the region of another, all channels bit for bit.
void expect_crop(const std::string& part, const std::string& whole, const PixelWindow& region) {
  const Picture got = test::read_picture(part);
  const Picture want = test::read_picture(whole);
  const Imath::Box2i window = got.header.dataWindow();
  EXPECT_EQ((PixelWindow{window.min.x, window.min.y, window.max.x + 1, window.max.y + 1}), region);
  EXPECT_EQ(got.header.displayWindow(), want.header.displayWindow());
  const int left = region.x0 - want.header.dataWindow().min.x;
  const int top = region.y0 - want.header.dataWindow().min.y;
  ASSERT_EQ(got.planes.size(), want.planes.size());
  for (const auto& [name, plane] : got.planes) {
    const test::Plane& from = want.planes.at(name);
    ASSERT_EQ(plane.type, from.type);
    const std::size_t bytes = test::Plane::sample_bytes(plane.type) * static_cast<std::size_t>(got.width());
    for (int y = 0; y < got.height(); ++y) {
      const std::size_t at = got.index(0, y) * test::Plane::sample_bytes(plane.type);
      const std::size_t there = want.index(left, top + y) * test::Plane::sample_bytes(plane.type);
      ASSERT_EQ(std::memcmp(plane.bytes.data() + at, from.bytes.data() + there, bytes), 0)
          << name << " " << y;
    }
  }
}

class Regions : public testing::TestWithParam<Storage> {
 protected:
  /// Regions of all kinds: one pixel, an edge, lines across tiles, all of it.
  std::vector<Region> regions() const {
    const auto [x, y] = std::pair(GetParam().origin.x, GetParam().origin.y);
    return {{x + 70, y + 40, x + 70, y + 40},
            {x, y, x + 1, y + kHeight - 1},
            {x + 31, y + 33, x + 33, y + 65},
            {x + kWidth - 1, y + kHeight - 1, x + kWidth - 1, y + kHeight - 1},
            {x, y + 96, x + kWidth - 1, y + 96},
            {x, y, x + kWidth - 1, y + kHeight - 1},
            {x + 3, y + 5, x + 148, y + 90}};
  }
  test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string all_ = folder_ / "all.exr";
  const std::string part_ = folder_ / "part.exr";
};

TEST_P(Regions, HaveThePixelsOfTheWholeConversion) {
  Picture picture = rgb_picture(GetParam());
  write(in_, picture, GetParam());
  UpsampleImageOptions upsample;
  upsample.input_space = RgbSpace();  // stated, so that there is nothing to note
  upsample.alpha = AlphaMeaning::kIgnored;
  ASSERT_TRUE(upsample_image(in_, all_, upsample));
  for (const Region& region : regions()) {
    for (const int threads : {1, 3}) {
      upsample.region = window_of(region);
      upsample.threads = threads;
      const auto report = upsample_image(in_, part_, upsample);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_EQ(report->width, region[2] - region[0] + 1);
      EXPECT_EQ(report->height, region[3] - region[1] + 1);
      EXPECT_TRUE(report->notes.empty());
      expect_crop(part_, all_, window_of(region));
    }
  }
}

TEST_P(Regions, AreThoseOfEveryConversion) {
  Picture picture = rgb_picture(GetParam());
  write(in_, picture, GetParam());
  RelightImageOptions relight({"A", *illuminant("A")});
  ASSERT_TRUE(relight_image(in_, all_, relight));
  relight.region = window_of(regions().back());
  ASSERT_TRUE(relight_image(in_, part_, relight));
  expect_crop(part_, all_, *relight.region);

  UpsampleImageOptions upsample;
  ASSERT_TRUE(upsample_image(in_, folder_ / "spectral.exr", upsample));
  Picture spectral = test::read_picture(folder_ / "spectral.exr");
  write(folder_ / "spectral.exr", spectral, GetParam());
  ProjectImageOptions project;
  ASSERT_TRUE(project_image(folder_ / "spectral.exr", all_, project));
  project.region = window_of(regions()[2]);
  ASSERT_TRUE(project_image(folder_ / "spectral.exr", part_, project));
  expect_crop(part_, all_, *project.region);

  upsample.store = Store::kCoefficients;
  ASSERT_TRUE(upsample_image(in_, folder_ / "compact.exr", upsample));
  Picture compact = test::read_picture(folder_ / "compact.exr");
  write(folder_ / "compact.exr", compact, GetParam());
  ExpandImageOptions expand;
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", all_, expand));
  expand.region = window_of(regions()[6]);
  ASSERT_TRUE(expand_image(folder_ / "compact.exr", part_, expand));
  expect_crop(part_, all_, *expand.region);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Regions,
    testing::Values(Storage{"lines", 0}, Storage{"uncompressed", 0, false, {5, -70}, Imf::NO_COMPRESSION},
                    Storage{"piz", 0, false, {-100000, 99}, Imf::PIZ_COMPRESSION},
                    Storage{"upwards", 0, false, {1, 2}, Imf::ZIP_COMPRESSION, Imf::DECREASING_Y},
                    Storage{"tiles", 32}, Storage{"tiles3", 3, false, {-7, -7}, Imf::NO_COMPRESSION},
                    Storage{"large", 128, false, {-75, -50}}, Storage{"larger", 1000, false, {40, 40}},
                    Storage{"mipmaps", 32, true, {17, -3}}),
    [](const auto& of) { return std::string(of.param.name); });

class RegionTool : public testing::Test {
 protected:
  /// Overwrites all bytes of a tile's or chunk's data that is not in `keep`.
  static void damage(const std::string& path, const std::function<bool(const std::vector<int>&)>& keep,
                     std::size_t coordinates) {
    std::string bytes = test::file_bytes(path);
    // The offsets' table follows the header, which ends with an empty name.
    std::size_t chunks = 0;
    std::size_t table = 0;
    {
      Imf::MultiPartInputFile file(path.c_str());
      const Imf::Header& header = file.header(0);
      if (header.hasTileDescription()) {
        const int side = static_cast<int>(header.tileDescription().xSize);
        chunks = static_cast<std::size_t>((kWidth + side - 1) / side * ((kHeight + side - 1) / side));
      } else {
        chunks = (kHeight + 15) / 16;
      }
    }
    // The first chunk lies right after the table: its offset tells where the table begins.
    for (std::size_t at = 8; at + 8 < bytes.size() && table == 0; ++at) {
      std::uint64_t offset = 0;
      std::memcpy(&offset, bytes.data() + at, 8);
      if (offset == at + 8 * chunks) table = at;
    }
    ASSERT_GT(table, 0U);
    int damaged = 0;
    for (std::size_t i = 0; i < chunks; ++i) {
      std::uint64_t offset = 0;
      std::memcpy(&offset, bytes.data() + table + 8 * i, 8);
      std::vector<int> where(coordinates);
      std::memcpy(where.data(), bytes.data() + offset, 4 * coordinates);
      if (keep(where)) continue;
      std::int32_t size = 0;
      std::memcpy(&size, bytes.data() + offset + 4 * coordinates, 4);
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset + 4 * coordinates + 4), size, '\xFF');
      ++damaged;
    }
    ASSERT_GT(damaged, 0);
    test::write_text(path, bytes);
  }
  test::TempFolder folder_;
  const std::string in_ = folder_ / "in.exr";
  const std::string out_ = folder_ / "out.exr";
};

TEST_F(RegionTool, TilesOutsideAreNotRead) {
  Picture picture = rgb_picture({"", 32, false, {-10, 20}});
  write(in_, picture, {"", 32, false, {-10, 20}});
  UpsampleImageOptions options;
  ASSERT_TRUE(upsample_image(in_, folder_ / "all.exr", options));
  damage(
      in_, [](const std::vector<int>& tile) { return tile[0] == 1 && (tile[1] == 1 || tile[1] == 2); }, 4);
  EXPECT_FALSE(upsample_image(in_, out_, options)) << "the damage must be one";
  // Tiles 1 in x; 1 and 2 in y.
  options.region = window_of({22, 52, 53, 115});
  const auto report = upsample_image(in_, out_, options);
  ASSERT_TRUE(report) << report.error().message;
  expect_crop(out_, folder_ / "all.exr", *options.region);
  for (const Region& further :
       {Region{21, 52, 53, 115}, Region{22, 51, 53, 115}, Region{22, 52, 54, 115}, Region{22, 52, 53, 116}}) {
    options.region = window_of(further);
    EXPECT_FALSE(upsample_image(in_, folder_ / "none.exr", options));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.exr"));
}

TEST_F(RegionTool, LinesOutsideAreNotRead) {
  Picture picture = rgb_picture({"", 0, false, {0, -40}});
  write(in_, picture, {"", 0, false, {0, -40}});
  UpsampleImageOptions options;
  ASSERT_TRUE(upsample_image(in_, folder_ / "all.exr", options));
  // Chunks of sixteen lines.
  damage(
      in_, [](const std::vector<int>& chunk) { return chunk[0] == -24 || chunk[0] == -8; }, 1);
  options.region = window_of({10, -24, 20, 7});
  const auto report = upsample_image(in_, out_, options);
  ASSERT_TRUE(report) << report.error().message;
  expect_crop(out_, folder_ / "all.exr", *options.region);
  options.region = window_of({10, -25, 20, 7});
  EXPECT_FALSE(upsample_image(in_, out_, options));
  options.region = window_of({10, -24, 20, 8});
  EXPECT_FALSE(upsample_image(in_, out_, options));
}

TEST_F(RegionTool, IsLimitedToTheDataWindowWithANote) {
  Picture picture = rgb_picture({"", 0, false, {10, 10}});
  test::write_scanlines(in_, picture);
  UpsampleImageOptions options;
  options.input_space = RgbSpace();
  options.method = Method::kSmitsExact;  // has nothing to say of alpha
  ASSERT_TRUE(upsample_image(in_, folder_ / "all.exr", options));
  options.region = window_of({-2147483647 - 1, 100, 2147483647, 2147483647});
  const auto report = upsample_image(in_, out_, options);
  ASSERT_TRUE(report) << report.error().message;
  expect_crop(out_, folder_ / "all.exr", {10, 100, 160, 107});
  ASSERT_EQ(report->notes.size(), 1U);
  EXPECT_EQ(
      report->notes[0],
      "the region -2147483648,100,2147483646,2147483646 is limited to 10,100,159,106: the data window is "
      "10,10,159,106");
}

TEST_F(RegionTool, OutsideOrEmptyIsAnError) {
  Picture picture = rgb_picture({"", 0, false, {10, 10}});
  test::write_scanlines(in_, picture);
  UpsampleImageOptions options;
  for (const Region& outside : {Region{0, 0, 9, 200}, Region{160, 0, 170, 200}, Region{0, 107, 200, 300}}) {
    options.region = window_of(outside);
    const auto report = upsample_image(in_, out_, options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
    EXPECT_THAT(report.error().message, HasSubstr("lies outside of the data window 10,10,159,106"));
  }
  for (const Region& empty : {Region{50, 50, 49, 60}, Region{50, 50, 60, 49}}) {
    options.region = window_of(empty);
    EXPECT_THAT(upsample_image(in_, out_, options).error().message, HasSubstr("is empty"));
  }
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(RegionTool, WhatIsFoundIsCountedFromTheDataWindow) {
  Picture picture = rgb_picture({"", 0, false, {100, 100}});
  picture.planes["G"].set(picture.index(60, 50), NAN);
  picture.planes["G"].set(picture.index(2, 2), NAN);
  test::write_scanlines(in_, picture);
  UpsampleImageOptions options;
  options.region = window_of({110, 110, 180, 180});
  EXPECT_THAT(upsample_image(in_, out_, options).error().message,
              HasSubstr("1 non-finite pixel, the first at 60,50"));
  options.region = window_of({110, 110, 150, 180});
  EXPECT_TRUE(upsample_image(in_, out_, options));
}

TEST_F(RegionTool, ReachesLuminanceAndChroma) {
  {
    const Imath::Box2i window({-20, 30}, {99, 109});
    Imf::RgbaOutputFile file(in_.c_str(), window, window, Imf::WRITE_YC);
    std::vector<Imf::Rgba> pixels(120 * 80);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const float v = 0.2F + 0.6F * static_cast<float>(i % 120) / 120;
      pixels[i] = Imf::Rgba(v, 0.5F, 1 - v);
    }
    file.setFrameBuffer(pixels.data() + 20 - std::ptrdiff_t{30} * 120, 1, 120);
    file.writePixels(80);
  }
  UpsampleImageOptions options;
  ASSERT_TRUE(upsample_image(in_, folder_ / "all.exr", options));
  options.region = window_of({-3, 37, 44, 101});
  const auto report = upsample_image(in_, out_, options);
  ASSERT_TRUE(report) << report.error().message;
  expect_crop(out_, folder_ / "all.exr", *options.region);
}

}  // namespace
}  // namespace spectile
