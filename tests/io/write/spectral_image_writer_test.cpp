// Spectral images from memory: every sample comes back, in the same file however its rows are handed over.
#include <fmt/format.h>

#include <cmath>

#include "tests/io/convert/frame/mipmap_support.hpp"
#include "tests/io/write/written_spectra.hpp"

namespace spectile {
namespace {

using test::pixels_of;
using test::write_image;

class SpectralImageWriters : public testing::Test {
 protected:
  /// The bytes of a file whose rows come a few at a time.
  std::string bytes_by_rows(const SampledSpectra& spectra, int width, int height, int rows,
                            const SpectralImageOptions& options) {
    auto writer = SpectralImageWriter::create(out_, width, height, *spectra.axis().bands(), options);
    if (!writer) {
      ADD_FAILURE() << writer.error().message;
      return {};
    }
    for (int y = 0; y < height; y += rows) {
      EXPECT_EQ(writer->next_row(), y);
      const int count = std::min(rows, height - y);
      const auto written = writer->write_rows(y, count, test::rows_of(spectra, width, y, count));
      EXPECT_TRUE(written) << written.error().message;
      EXPECT_FALSE(std::filesystem::exists(out_));
    }
    EXPECT_EQ(writer->next_row(), height);
    const auto report = writer->finish();
    EXPECT_TRUE(report) << report.error().message;
    std::string bytes = test::file_bytes(out_);
    std::filesystem::remove(out_);
    return bytes;
  }

  const test::TempFolder folder_;
  const std::string out_ = folder_ / "out.exr";
  const Bands bands_ = *Bands::parse("400:700:25");
};

TEST_F(SpectralImageWriters, FloatsComeBackToTheBit) {
  const std::vector<float> special = {-0.0F, test::kTiny, -test::kTiny, test::kMost, -test::kMost, 65520.0F};
  for (const auto& [width, height] : {std::pair{1, 1}, {63, 3}, {64, 2}, {65, 5}, {131, 37}}) {
    for (const Quantity quantity : {Quantity::kReflectance, Quantity::kUnbounded, Quantity::kIlluminant}) {
      SCOPED_TRACE(fmt::format("{} x {} {}", width, height, to_string(quantity)));
      auto spectra = test::noise_spectra(bands_, width, height);
      for (std::size_t i = 0; i < special.size(); ++i) {
        spectra.at((7 * i) % spectra.lanes(), i % bands_.count()) = special[i];
      }
      SpectralImageOptions options = test::as_floats();
      options.quantity = quantity;
      const auto report = write_image(out_, spectra, width, height, options);
      ASSERT_TRUE(report);
      EXPECT_EQ(report->clamped_pixels, 0U);
      EXPECT_EQ(report->width, width);
      EXPECT_EQ(report->height, height);
      EXPECT_EQ(report->bands, bands_.count());
      EXPECT_EQ(report->quantity, quantity);
      EXPECT_EQ(report->bytes_written, std::filesystem::file_size(out_));
      EXPECT_TRUE(test::same_lanes(test::read_spectra(out_), spectra));
      EXPECT_EQ(SpectralTexture::open(out_)->bands(), bands_);
      EXPECT_EQ(SpectralTexture::open(out_)->quantity() == Quantity::kIlluminant,
                quantity == Quantity::kIlluminant);
    }
  }
}

TEST_F(SpectralImageWriters, HalvesAreRoundedToNearestEven) {
  const int width = 70;
  const int height = 20;
  auto spectra = test::noise_spectra(bands_, width, height);
  // Halfway between halves, and the ends of their range.
  const std::vector<float> special = {1 + 0x1p-11F, 1 + 3 * 0x1p-11F, 0x1p-25F, 3 * 0x1p-25F, -0.0F, 65504,
                                      -65504};
  for (std::size_t i = 0; i < special.size(); ++i) spectra.at(i, i) = special[i];
  ASSERT_TRUE(write_image(out_, spectra, width, height));
  const SampledSpectra read = test::read_spectra(out_);
  for (std::size_t lane = 0; lane < spectra.lanes(); ++lane) {
    for (std::size_t k = 0; k < bands_.count(); ++k) {
      const auto nearest = static_cast<float>(half(spectra.at(lane, k)));
      ASSERT_TRUE(test::same_bits(read.at(lane, k), nearest)) << lane << " " << k;
    }
  }
}

TEST_F(SpectralImageWriters, FileIsTheSameHoweverTheRowsCome) {
  const int width = 133;
  const int height = 50;
  const auto spectra = test::noise_spectra(bands_, width, height);
  for (const auto& tile : {std::optional<std::array<int, 2>>(), {{32, 16}}, {{4096, 4096}}, {{7, 3}}}) {
    SpectralImageOptions options;
    options.tile = tile;
    options.preview = true;
    options.threads = 1;
    ASSERT_TRUE(write_image(out_, spectra, width, height, options));
    const std::string whole = test::file_bytes(out_);
    std::filesystem::remove(out_);
    for (const int threads : {1, 2, 8}) {
      options.threads = threads;
      for (const int rows : {1, 3, 16, 17, 33, 49, 50}) {
        EXPECT_TRUE(bytes_by_rows(spectra, width, height, rows, options) == whole)
            << threads << " threads, " << rows << " rows, tiles " << (tile ? (*tile)[0] : 0);
      }
    }
  }
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(SpectralImageWriters, FileIsTheSameOnEveryInstructionSet) {
  const auto spectra = test::noise_spectra(bands_, 77, 5);
  SpectralImageOptions options;
  options.preview = true;
  std::string first;
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(force_isa(isa));
    EXPECT_TRUE(write_image(out_, spectra, 77, 5, options));
    if (first.empty()) first = test::file_bytes(out_);
    EXPECT_TRUE(test::file_bytes(out_) == first) << isa;
  }
  ASSERT_TRUE(force_isa(""));
}

TEST_F(SpectralImageWriters, EveryCompressionTakesRowsAndWholeImages) {
  const int width = 67;
  const int height = 40;
  const auto spectra = test::noise_spectra(bands_, width, height);
  for (const char* name :
       {"none", "rle", "zips", "zip", "zip:9", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab:90"}) {
    SCOPED_TRACE(name);
    SpectralImageOptions options;
    options.compression = *Compression::parse(name);
    ASSERT_TRUE(write_image(out_, spectra, width, height, options));
    const std::string whole = test::file_bytes(out_);
    const auto info = inspect_image(out_);
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_TRUE(options.compression.description().starts_with(info->compression)) << info->compression;
    const SampledSpectra read = test::read_spectra(out_);
    const std::string kind = name;
    const float tolerance = kind.starts_with("b44") || kind.starts_with("dwa") ? 0.2F : 0x1p-11F;
    for (std::size_t lane = 0; lane < spectra.lanes(); ++lane) {
      for (std::size_t k = 0; k < bands_.count(); ++k) {
        ASSERT_NEAR(read.at(lane, k), spectra.at(lane, k), tolerance);
      }
    }
    std::filesystem::remove(out_);
    options.threads = 3;
    EXPECT_TRUE(bytes_by_rows(spectra, width, height, 7, options) == whole);
  }
}

TEST_F(SpectralImageWriters, CallersArrangementsGiveTheSameFile) {
  const int width = 37;
  const int height = 21;
  const auto spectra = test::noise_spectra(bands_, width, height);
  ASSERT_TRUE(write_image(out_, spectra, width, height, test::as_floats()));
  const std::string expected = test::file_bytes(out_);
  const std::size_t bands = bands_.count();
  const std::vector<float> pixels = test::interleaved(spectra);
  // With a member of another meaning after each pixel's spectrum, and rows that are padded.
  const std::size_t pixel_stride = bands + 3;
  const std::size_t row_stride = pixel_stride * 40;
  std::vector<float> padded(row_stride * 21, test::kNan);
  std::vector<float> planes(pixels.size());
  for (std::size_t lane = 0; lane < spectra.lanes(); ++lane) {
    for (std::size_t k = 0; k < bands; ++k) {
      padded[lane / 37 * row_stride + lane % 37 * pixel_stride + k] = spectra.at(lane, k);
      planes[k * spectra.lanes() + lane] = spectra.at(lane, k);
    }
  }
  const StridedSpectraView views[] = {StridedSpectraView::interleaved(pixels, bands, 37),
                                      {padded, bands, row_stride, pixel_stride, 1},
                                      StridedSpectraView::planar(planes, bands, 37, 21)};
  for (const StridedSpectraView& view : views) {
    const auto report = write_spectral_image(out_, {view, bands_, width, height}, test::as_floats());
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(test::file_bytes(out_) == expected);
  }
  auto writer = SpectralImageWriter::create(out_, width, height, bands_, test::as_floats());
  ASSERT_TRUE(writer);
  for (int y = 0; y < height; y += 4) {
    const auto rows = static_cast<std::size_t>(std::min(4, height - y));
    const auto part = std::span(pixels).subspan(static_cast<std::size_t>(y) * 37 * bands, rows * 37 * bands);
    ASSERT_TRUE(
        writer->write_rows(y, static_cast<int>(rows), StridedSpectraView::interleaved(part, bands, 37)));
  }
  ASSERT_TRUE(writer->finish());
  EXPECT_TRUE(test::file_bytes(out_) == expected);
}

TEST_F(SpectralImageWriters, LinesMayBeLongerThan16384Pixels) {
  const Bands bands = *Bands::uniform(400, 700, 100);
  const int width = 16384 + 77;
  const auto spectra = test::noise_spectra(bands, width, 19);
  for (const bool tiled : {false, true}) {
    SpectralImageOptions options = test::as_floats();
    if (tiled) options.tile = {4096, 16};
    ASSERT_TRUE(write_image(out_, spectra, width, 19, options));
    EXPECT_TRUE(test::same_lanes(test::read_spectra(out_), spectra));
  }
}

TEST_F(SpectralImageWriters, LevelsAreAveragesOfSpectraPreviewAndAlpha) {
  const int width = 45;
  const int height = 70;
  const auto spectra = test::noise_spectra(bands_, width, height);
  std::vector<float> alpha(spectra.lanes());
  for (std::size_t i = 0; i < alpha.size(); ++i) alpha[i] = static_cast<float>(i % 5) / 4;
  for (const SampleType pixel : {SampleType::kFloat, SampleType::kHalf}) {
    SpectralImageOptions options = test::as_floats();
    options.preview = options.alpha = true;
    ASSERT_TRUE(write_image(out_, spectra, width, height, options, alpha));
    const test::Picture image = test::read_picture(out_);
    options.pixel = pixel;
    options.mipmap = true;
    std::string bytes;
    for (const int threads : {1, 4}) {
      options.threads = threads;
      ASSERT_TRUE(write_image(out_, spectra, width, height, options, alpha));
      if (bytes.empty()) bytes = test::file_bytes(out_);
      EXPECT_TRUE(test::file_bytes(out_) == bytes);
    }
    const auto levels = test::read_levels(out_);
    ASSERT_EQ(levels.size(), 7U);
    EXPECT_EQ(levels[0].planes.size(), bands_.count() + 4);
    test::check_averages(levels, image, 0);
  }
}

TEST_F(SpectralImageWriters, AlphaStandsBesideTheSpectra) {
  const auto spectra = test::noise_spectra(bands_, 66, 18);
  std::vector<float> alpha(spectra.lanes());
  for (std::size_t i = 0; i < alpha.size(); ++i) alpha[i] = static_cast<float>(i) / 4096;
  SpectralImageOptions options = test::as_floats();
  options.alpha = options.preview = true;
  ASSERT_TRUE(write_image(out_, spectra, 66, 18, options, alpha));
  const test::Picture picture = test::read_picture(out_);
  for (std::size_t i = 0; i < alpha.size(); ++i) ASSERT_EQ(picture.planes.at("A").at(i), alpha[i]);
  EXPECT_EQ(inspect_image(out_)->alpha, "A");
  EXPECT_TRUE(test::same_lanes(test::read_spectra(out_), spectra));
}

TEST_F(SpectralImageWriters, MovedWriterGoesOn) {
  const auto spectra = test::noise_spectra(bands_, 5, 2);
  auto first = *SpectralImageWriter::create(out_, 5, 2, bands_);
  ASSERT_TRUE(first.write_rows(0, 1, test::rows_of(spectra, 5, 0, 1)));
  SpectralImageWriter second = std::move(first);
  ASSERT_TRUE(second.write_rows(1, 1, test::rows_of(spectra, 5, 1, 1)));
  ASSERT_TRUE(second.finish());
  EXPECT_TRUE(std::filesystem::exists(out_));
}

}  // namespace
}  // namespace spectile
