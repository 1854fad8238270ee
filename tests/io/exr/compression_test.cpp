// Every compression gives back what was packed, or loses what it says it loses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

constexpr CompressionKind kAllKinds[] = {
    CompressionKind::kNone, CompressionKind::kRle,   CompressionKind::kZips, CompressionKind::kZip,
    CompressionKind::kPiz,  CompressionKind::kPxr24, CompressionKind::kB44,  CompressionKind::kB44a,
    CompressionKind::kDwaa, CompressionKind::kDwab};

Imf::Compression in_file(CompressionKind kind) {
  constexpr Imf::Compression kMethods[] = {
      Imf::NO_COMPRESSION,   Imf::RLE_COMPRESSION,   Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
      Imf::PIZ_COMPRESSION,  Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION,  Imf::B44A_COMPRESSION,
      Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION};
  return kMethods[static_cast<std::size_t>(kind)];
}

/// True if a spectral channel comes back to the bit: DWA loses only in R, G, B and Y, B44 only in half, PXR24
/// in float.
bool keeps_bits(CompressionKind kind, SampleType pixel) {
  switch (kind) {
    case CompressionKind::kPxr24:
      return pixel == SampleType::kHalf;
    case CompressionKind::kB44:
    case CompressionKind::kB44a:
      return pixel == SampleType::kFloat;
    default:
      return true;
  }
}

bool is_dwa(CompressionKind kind) {
  return kind == CompressionKind::kDwaa || kind == CompressionKind::kDwab;
}

class Compressions : public testing::Test {
 protected:
  test::Picture convert(const std::string& input, Compression compression, SampleType pixel,
                        Quantity quantity = Quantity::kReflectance, const char* bands = "400:700:37.5") {
    UpsampleImageOptions options;
    options.compression = compression;
    options.method = Method::kSmits;  // which takes bands as wide as these
    options.pixel = pixel;
    options.quantity = quantity;
    options.bands = *Bands::parse(bands);
    const auto report = upsample_image(input, folder_ / "out.exr", options);
    EXPECT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->bytes_written, std::filesystem::file_size(folder_ / "out.exr"));
    try {
      test::Picture out = test::read_picture(folder_ / "out.exr");
      EXPECT_EQ(out.header.compression(), in_file(compression.kind));
      return out;
    } catch (const std::exception& error) {
      ADD_FAILURE() << compression.description() << " cannot be read back: " << error.what();
      return {};
    }
  }

  /// Compares the file in every compression with the one in none.
  void check_all(const std::string& input, const std::string& what) {
    for (const auto pixel : {SampleType::kHalf, SampleType::kFloat}) {
      const test::Picture plain = convert(input, {CompressionKind::kNone, -1}, pixel);
      for (const auto kind : kAllKinds) {
        const test::Picture out = convert(input, {kind, -1}, pixel);
        EXPECT_EQ(out.planes.size(), plain.planes.size())
            << what << ", " << Compression{kind, -1}.description();
        if (out.planes.size() != plain.planes.size()) continue;
        for (const auto& [name, plane] : plain.planes) {
          const bool spectral = name.starts_with("T.");
          // The preview is half, whatever the spectra are.
          if (!keeps_bits(kind, spectral ? pixel : SampleType::kHalf) || (!spectral && is_dwa(kind)))
            continue;
          EXPECT_TRUE(out.planes.at(name) == plane)
              << what << ", " << name << ", " << Compression{kind, -1}.description();
        }
      }
    }
  }

  test::TempFolder folder_;
};

TEST_F(Compressions, GiveBackImagesOfEveryShape) {
  // Heights: less than a chunk, one line more than one of 16, 32 and 256 lines.
  const std::pair<int, int> shapes[] = {{1, 1},   {1, 257},  {15, 33}, {16, 17},
                                        {17, 31}, {63, 257}, {65, 37}, {4099, 33}};
  for (const auto& [width, height] : shapes) {
    test::Picture picture = test::blank(width, height, {-3, 11});
    test::add_rgb_noise(picture, Imf::HALF, 2);
    test::write_scanlines(folder_ / "in.exr", picture);
    check_all(folder_ / "in.exr", fmt::format("{} x {}", width, height));
  }
}

TEST_F(Compressions, GiveBackSmoothAndFlatImages) {
  test::Picture picture = test::blank(130, 70);
  // Long runs and small differences take other paths through the compressors than noise does.
  picture.add("R", Imf::HALF, [](int x, int) { return x / 130.0; });
  picture.add("G", Imf::HALF, [](int, int y) { return y < 40 ? 0.0 : 0.5; });
  picture.add("B", Imf::HALF, [](int, int) { return 0.0; });
  test::write_scanlines(folder_ / "in.exr", picture);
  check_all(folder_ / "in.exr", "smooth");
}

TEST_F(Compressions, ZipLevelsChangeTheSizeOnly) {
  test::Picture picture = test::blank(200, 64);
  int channel = 0;
  for (const char* name : {"R", "G", "B"}) {
    const int c = channel++;
    // Few different colours, so that there is something to find for a compressor that looks longer.
    picture.add(name, Imf::HALF,
                [c](int x, int y) { return std::floor(8 * test::noise(x / 3, y / 2, c)) / 8; });
  }
  test::write_scanlines(folder_ / "in.exr", picture);
  for (const auto kind : {CompressionKind::kZip, CompressionKind::kZips}) {
    const test::Picture first = convert(folder_ / "in.exr", {kind, 1}, SampleType::kHalf);
    const auto fast = std::filesystem::file_size(folder_ / "out.exr");
    for (int level = 2; level <= 9; ++level) {
      const test::Picture out = convert(folder_ / "in.exr", {kind, level}, SampleType::kHalf);
      EXPECT_TRUE(out.planes == first.planes) << level;
    }
    EXPECT_LT(std::filesystem::file_size(folder_ / "out.exr"), fast);
  }
}

TEST_F(Compressions, Pxr24KeepsFifteenBitsOfFloatMantissas) {
  test::Picture picture = test::blank(100, 20);
  test::add_rgb_noise(picture, Imf::HALF, 40);
  test::write_scanlines(folder_ / "in.exr", picture);
  const test::Picture plain = convert(folder_ / "in.exr", {CompressionKind::kNone, -1}, SampleType::kFloat);
  const test::Picture out = convert(folder_ / "in.exr", {CompressionKind::kPxr24, -1}, SampleType::kFloat);
  for (const auto& [name, plane] : plain.planes) {
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      // 24 bits: sign, 8 of exponent, 15 of mantissa; rounded to the nearest.
      ASSERT_NEAR(out.planes.at(name).at(i), plane.at(i), 0x1p-16 * std::abs(plane.at(i)))
          << name << " " << i;
    }
  }
}

TEST_F(Compressions, B44KeepsBlocksOfOneColorExactlyHoweverBright) {
  // Without differences inside a block of 4 x 4 there is nothing that B44 could lose.
  test::Picture picture = test::blank(64, 64);
  int channel = 0;
  for (const char* name : {"R", "G", "B"}) {
    const int c = channel++;
    picture.add(name, Imf::HALF, [c](int x, int y) {
      return std::exp2(20 * test::noise(x / 4, y / 4, 7) - 8) * (1 + test::noise(x / 4, y / 4, c));
    });
  }
  test::write_scanlines(folder_ / "in.exr", picture);
  for (const auto kind : {CompressionKind::kB44, CompressionKind::kB44a}) {
    const auto quantity = Quantity::kIlluminant;
    const test::Picture plain =
        convert(folder_ / "in.exr", {CompressionKind::kNone, -1}, SampleType::kHalf, quantity);
    const test::Picture out = convert(folder_ / "in.exr", {kind, -1}, SampleType::kHalf, quantity);
    for (const auto& [name, plane] : plain.planes) {
      double worst = 0;
      for (std::size_t i = 0; i < picture.pixels(); ++i) {
        worst = std::max(worst, std::abs(out.planes.at(name).at(i) - plane.at(i)) / plane.at(i));
      }
      EXPECT_EQ(worst, 0.0) << name << ", " << Compression{kind, -1}.description();
    }
  }
}

TEST_F(Compressions, DwaLevelSetsTheLossOfThePreview) {
  test::Picture picture = test::blank(96, 64);
  int channel = 0;
  for (const char* name : {"R", "G", "B"}) {
    const int c = channel++;
    picture.add(name, Imf::HALF, [c](int x, int y) { return 0.5 + 0.4 * std::sin(0.3 * x + 0.2 * y + c); });
  }
  test::write_scanlines(folder_ / "in.exr", picture);
  double before = -1;
  for (const int level : {1, 45, 500}) {
    const test::Picture out = convert(folder_ / "in.exr", {CompressionKind::kDwaa, level}, SampleType::kHalf);
    double sum = 0;
    for (const char* name : {"R", "G", "B"}) {
      for (std::size_t i = 0; i < picture.pixels(); ++i) {
        sum += std::abs(out.planes.at(name).at(i) - picture.planes.at(name).at(i));
      }
    }
    EXPECT_GT(sum, before) << level;
    EXPECT_LT(sum / (3 * static_cast<double>(picture.pixels())), 0.05) << level;
    before = sum;
  }
}

TEST(CompressionNames, AreParsedWithTheirLevels) {
  for (const char* text :
       {"none", "rle", "zips:3", "zip:9", "piz", "pxr24", "b44", "b44a", "dwaa:45", "dwab:500"}) {
    const auto parsed = Compression::parse(text);
    ASSERT_TRUE(parsed) << text;
    EXPECT_EQ(parsed->description(), text);
  }
  EXPECT_EQ(Compression::parse("zip")->level, Compression{}.level);
  for (const char* bad : {"zip:0", "zip:10", "zip:-1", "zip:", "zip:2x", "zip:1.5", "none:1", "piz:3",
                          "dwaa:501", "dwab:0", "zip:99999999999999999999"}) {
    const auto parsed = Compression::parse(bad);
    ASSERT_FALSE(parsed) << bad;
    EXPECT_EQ(parsed.error().code, ErrorCode::kBadArgument) << bad;
  }
  for (const char* unknown : {"", "lzma", "ZIP", "zip ", ":2"}) {
    const auto parsed = Compression::parse(unknown);
    ASSERT_FALSE(parsed) << unknown;
    EXPECT_EQ(parsed.error().code, ErrorCode::kUnknownName) << unknown;
  }
}

}  // namespace
}  // namespace spectile
