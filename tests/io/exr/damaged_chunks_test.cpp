// Chunks that cannot be decoded are errors, though a read that fails is tried once more.
#include <OpenEXR/ImfCompression.h>
#include <gtest/gtest.h>

#include <exception>
#include <random>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

/// True if OpenEXR itself reads all of a file.
bool is_readable(const std::string& path) {
  try {
    test::read_picture(path);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

TEST(DamagedChunks, AreErrorsWhereverOpenExrSaysSo) {
  const test::TempFolder folder;
  const std::string in = folder / "in.exr";
  int refused = 0;
  for (const Imf::Compression compression :
       {Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
        Imf::PXR24_COMPRESSION, Imf::DWAA_COMPRESSION}) {
    for (const bool tiled : {false, true}) {
      test::Picture picture = test::blank(70, 70);
      int channel = 0;
      for (const char* name : {"R", "G", "B"}) {
        const int c = channel++;
        picture.add(name, Imf::HALF, [=](int x, int y) { return test::noise(x / 8, y, c); });
      }
      picture.header.compression() = compression;
      if (tiled) {
        test::write_tiles(in, picture, 32, false);
      } else {
        test::write_scanlines(in, picture);
      }
      const std::string bytes = test::file_bytes(in);
      std::mt19937 random(static_cast<std::uint32_t>(compression));
      for (int i = 0; i < 12; ++i) {
        std::string damaged = bytes;
        // In the second half, which is samples.
        const std::size_t at = bytes.size() / 2 + random() % (bytes.size() / 2 - 40);
        for (std::size_t k = 0; k < 40; ++k) damaged[at + k] = static_cast<char>(random());
        test::write_text(in, damaged);
        if (is_readable(in)) continue;
        ++refused;
        for (const int threads : {1, 3}) {
          UpsampleImageOptions options;
          options.threads = threads;
          EXPECT_FALSE(upsample_image(in, folder / "out.exr", options))
              << "compression " << compression << ", tiled " << tiled << ", damage " << i;
        }
      }
    }
  }
  EXPECT_GT(refused, 60);
}

}  // namespace
}  // namespace spectile
