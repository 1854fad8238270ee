// Lines of so many samples that a chunk of the output does not fit in a strip of the input: the same pixels
// as from parts of the image whose strips hold whole chunks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <spectile/image/image.hpp>

#include "tests/support/exr_files.hpp"

namespace spectile {
namespace {

constexpr int kLongWidth = 4096;
constexpr int kLongHeight = 37;  // two chunks of 16 lines and a part of one
constexpr int kBands = 300;      // 32 lines of floats are 157 MB

class LongLines : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TempFolder>();
    write(input(), 0.25);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string input() { return *folder_ / "in.exr"; }

  /// Bands of a nanometre; `at_end` is a sample of the last pixel.
  static void write(const std::string& path, double at_end) {
    test::Picture picture = test::blank(kLongWidth, kLongHeight);
    picture.header.compression() = Imf::RLE_COMPRESSION;
    for (int band = 0; band < kBands; ++band) {
      picture.add(fmt::format("T.{},000000nm", 400 + band), Imf::FLOAT, [=](int x, int y) {
        if (band == 0 && x == kLongWidth - 1 && y == kLongHeight - 1) return at_end;
        return (x / 16 * 7 + y * 13 + band / 8) % 32 / 32.0;
      });
    }
    test::write_scanlines(path, picture);
  }
  static ProjectImageOptions options(int threads) {
    ProjectImageOptions out;
    out.pixel = SampleType::kFloat;
    out.threads = threads;
    return out;
  }
  static inline std::unique_ptr<test::TempFolder> folder_;
};

TEST_F(LongLines, GiveThePixelsOfShortOnes) {
  for (const int threads : {1, 3}) {
    ASSERT_TRUE(project_image(input(), *folder_ / "whole.exr", options(threads)));
    const test::Picture whole = test::read_picture(*folder_ / "whole.exr");
    for (const int x0 : {0, kLongWidth / 2}) {
      ProjectImageOptions half = options(2);
      half.region = PixelWindow{x0, 0, x0 + kLongWidth / 2, kLongHeight};
      ASSERT_TRUE(project_image(input(), *folder_ / "half.exr", half));
      const test::Picture part = test::read_picture(*folder_ / "half.exr");
      for (const char* channel : {"R", "G", "B"}) {
        for (int y = 0; y < kLongHeight; ++y) {
          for (int x = 0; x < kLongWidth / 2; ++x) {
            ASSERT_EQ(whole.planes.at(channel).at(static_cast<std::size_t>(y * kLongWidth + x0 + x)),
                      part.planes.at(channel).at(static_cast<std::size_t>(y * kLongWidth / 2 + x)))
                << channel << " " << x0 + x << ", " << y;
          }
        }
      }
    }
  }
}

TEST_F(LongLines, StopAtWhatIsNotFinite) {
  write(*folder_ / "nan.exr", std::numeric_limits<double>::quiet_NaN());
  const auto stopped = project_image(*folder_ / "nan.exr", *folder_ / "none.exr", options(2));
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kNonFinite);
  EXPECT_NE(stopped.error().message.find("4095,36"), std::string::npos) << stopped.error().message;
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "none.exr"));
}

}  // namespace
}  // namespace spectile
