// Spectral images from memory: what is refused, what is made black, and that nothing is left of a failure.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/io/write/written_spectra.hpp"

namespace spectile {
namespace {

using test::code;
using test::code_of;
using test::noise_spectra;
using test::rows_of;
using testing::EndsWith;
using testing::HasSubstr;

class SpectralImageErrors : public testing::Test {
 protected:
  static constexpr int kWidth = 70;
  static constexpr int kHeight = 40;

  SpectralImageWriter writer(const SpectralImageOptions& options = test::kSpectralImage) const {
    return *SpectralImageWriter::create(out_, kWidth, kHeight, bands_, options);
  }
  Result<void> write(SpectralImageWriter& writer, int first, int rows) const {
    return writer.write_rows(first, rows, rows_of(spectra_, kWidth, first, rows));
  }
  template <class T>
  void expect(const Result<T>& result, ErrorCode expected, const std::string& end) const {
    ASSERT_FALSE(result) << end;
    EXPECT_EQ(code_of(result), code(expected)) << result.error().message;
    EXPECT_THAT(result.error().message, HasSubstr(out_));
    EXPECT_THAT(result.error().message, EndsWith(end));
  }
  Result<ImageReport> write_whole(const SpectralImageOptions& options = test::kSpectralImage) const {
    return write_spectral_image(out_, spectra_, kWidth, kHeight, options);
  }
  Result<SpectralImageWriter> create(int width, int height, const Bands& bands,
                                     const SpectralImageOptions& options = test::kSpectralImage) const {
    return SpectralImageWriter::create(out_, width, height, bands, options);
  }

  const test::TempFolder folder_;
  const std::string out_ = folder_ / "out.exr";
  const Bands bands_ = *Bands::parse("400:700:50");
  SampledSpectra spectra_ = noise_spectra(bands_, kWidth, kHeight);
};

TEST_F(SpectralImageErrors, RowsMustBeTheNextOnes) {
  SpectralImageWriter to = writer();
  expect(write(to, 1, 2), ErrorCode::kBadArgument, "rows 1 to 2 came, and row 0 is the next");
  ASSERT_TRUE(write(to, 0, 20));
  expect(write(to, 19, 2), ErrorCode::kBadArgument, "rows 19 to 20 came, and row 20 is the next");
  expect(write(to, 21, 1), ErrorCode::kBadArgument, "rows 21 to 21 came, and row 20 is the next");
  expect(to.write_rows(20, 21, rows_of(spectra_, kWidth, 0, 21)), ErrorCode::kBadArgument,
         "rows 20 to 40 came, and the last is 39");
  expect(to.write_rows(20, 0, rows_of(spectra_, kWidth, 0, 1)), ErrorCode::kBadArgument,
         "0 rows at row 20, not 1 or more");
  expect(to.write_rows(20, std::numeric_limits<int>::max(), rows_of(spectra_, kWidth, 0, 1)),
         ErrorCode::kBadArgument, "rows 20 to 2147483666 came, and the last is 39");
  expect(to.finish(), ErrorCode::kBadArgument, "20 of 40 rows came, and row 20 is the next");
  EXPECT_EQ(to.next_row(), 20);
  // The right ones are still taken, and what was refused has left no trace.
  ASSERT_TRUE(write(to, 20, 20));
  expect(write(to, 0, 1), ErrorCode::kBadArgument, "rows 0 to 0 came, and row 40 is the next");
  ASSERT_TRUE(to.finish());
  const std::string bytes = test::file_bytes(out_);
  ASSERT_TRUE(write_whole());
  EXPECT_TRUE(test::file_bytes(out_) == bytes);
  expect(to.finish(), ErrorCode::kBadArgument, "the image is complete already");
  expect(write(to, 0, 1), ErrorCode::kBadArgument, "the image is complete, and takes no more rows");
}

TEST_F(SpectralImageErrors, SizesMustAgree) {
  SpectralImageWriter to = writer();
  expect(to.write_rows(0, 2, rows_of(spectra_, kWidth, 0, 1)), ErrorCode::kSizeMismatch,
         "70 lanes are not 2 rows of 70 pixels");
  expect(to.write_rows(0, 1, rows_of(spectra_, kWidth, 0, 2)), ErrorCode::kSizeMismatch,
         "140 lanes are not 1 row of 70 pixels");
  expect(to.write_rows(0, 1, SampledSpectraView{nullptr, 70, bands_}), ErrorCode::kBadArgument,
         "no data for 70 lanes");
  const std::vector<float> alpha(70);
  expect(to.write_rows(0, 1, rows_of(spectra_, kWidth, 0, 1), alpha), ErrorCode::kSizeMismatch,
         "70 samples of alpha, the image expects 0 for 70 pixels, as its options ask for no alpha");
  expect(write_spectral_image(out_, spectra_, 71, kHeight), ErrorCode::kSizeMismatch,
         "2800 lanes are not 40 rows of 71 pixels");
  SpectralImageOptions options;
  options.alpha = true;
  expect(write_whole(options), ErrorCode::kSizeMismatch,
         "0 samples of alpha, the image expects 2800 for 2800 pixels");
  EXPECT_EQ(to.next_row(), 0);
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(SpectralImageErrors, DataMustBeLongEnoughForItsStrides) {
  SpectralImageWriter to = writer();
  const std::vector<float> data(2 * 70 * 6);
  const auto view = StridedSpectraView::interleaved(data, 6, 70);
  ASSERT_TRUE(to.write_rows(0, 2, view));
  expect(to.write_rows(2, 3, view), ErrorCode::kSizeMismatch,
         "840 floats are too few for 3 rows of 70 pixels in 6 bands, at strides of 420, 6 and 1");
  const std::size_t huge = std::numeric_limits<std::size_t>::max() / 2 + 2;
  for (const StridedSpectraView& wrong : {StridedSpectraView{data, 6, huge, 6, 1},
                                          {data, 6, 420, huge, 1},
                                          {data, 6, 420, 6, huge},
                                          {{data.data(), 839}, 6, 420, 6, 1},
                                          {{}, 6, 0, 0, 0}}) {
    EXPECT_EQ(code_of(to.write_rows(2, 2, wrong)), code(ErrorCode::kSizeMismatch));
  }
  // Twice as much is 2 in 64 bits.
  EXPECT_EQ(code_of(to.write_rows(2, 3, StridedSpectraView{data, 6, huge, 6, 1})),
            code(ErrorCode::kSizeMismatch));
  expect(to.write_rows(2, 2, StridedSpectraView::interleaved(data, 5, 70)), ErrorCode::kBandsMismatch,
         "spectra of 5 bands, the image expects 6");
  EXPECT_EQ(to.next_row(), 2);
}

TEST_F(SpectralImageErrors, BandsMustBeThoseOfTheImage) {
  SpectralImageWriter to = writer();
  expect(to.write_rows(0, 1, noise_spectra(*Bands::parse("400:650:50"), kWidth, 1)),
         ErrorCode::kBandsMismatch, "spectra on bands 400:650:50, the image expects bands 400:700:50");
  const SampledSpectra own = test::own_batch(70, 6);
  expect(to.write_rows(0, 1, own), ErrorCode::kBandsMismatch,
         "spectra on 6 wavelengths of each lane's own, the image expects bands 400:700:50");
  expect(write_spectral_image(out_, own, 70, 1), ErrorCode::kBandsMismatch,
         "spectra at 6 wavelengths of each lane's own, an image's are on bands");
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(SpectralImageErrors, OptionsThatCannotBeKeptAreRefused) {
  const auto with = [](auto change) {
    SpectralImageOptions out;
    change(out);
    return out;
  };
  expect(
      create(9, 9, bands_, with([](auto& o) { o.mipmap = true; })), ErrorCode::kBadArgument,
      "mip levels are averages of rows that this writer does not keep; write_spectral_image() writes them");
  expect(create(9, 9, bands_, with([](auto& o) { o.pixel = SampleType::kUint32; })), ErrorCode::kBadArgument,
         "samples are written as half or float");
  expect(create(9, 9, bands_, with([](auto& o) { o.units = "W"; })), ErrorCode::kBadArgument,
         "the spectra are reflectance, and have no units such as \"W\"");
  expect(create(0, 9, bands_), ErrorCode::kBadArgument, "an image of 0 x 9 pixels; sides are 1 to 262144");
  expect(create(9, 262145, bands_), ErrorCode::kBadArgument,
         "an image of 9 x 262145 pixels; sides are 1 to 262144");
  EXPECT_EQ(code_of(create(9, 9, bands_, with([](auto& o) {
                             o.tile = {4097, 1};
                           }))),
            code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(create(262144, 262144, bands_, with([](auto& o) {
                             o.tile = {1, 2};
                           }))),
            code(ErrorCode::kBadArgument));
  const Bands same = *Bands::from_list({{400, 450, 450.0000001}, {450.0000001, 450.0000002, 500}});
  EXPECT_EQ(code_of(create(9, 9, same)), code(ErrorCode::kBadArgument));
  const auto infrared = create(9, 9, *Bands::parse("900:1000:10"), with([](auto& o) { o.preview = true; }));
  EXPECT_EQ(code_of(infrared), code(ErrorCode::kBadArgument));
  EXPECT_THAT(infrared.error().message, HasSubstr("no preview: "));
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(SpectralImageErrors, NonFinitePixelsStopAndLeaveTheOldFile) {
  test::write_text(out_, "precious");
  spectra_.at(37 * 70 + 69, 2) = test::kNan;
  spectra_.at(5 * 70 + 3, 1) = -test::kInf;
  spectra_.at(5 * 70 + 3, 4) = test::kNan;
  const std::string sentence = "2 non-finite pixels, the first at 3,5; NonFinite::kZero makes them black";
  for (const bool tiled : {false, true}) {
    for (const int threads : {1, 4}) {
      SpectralImageOptions options;
      options.threads = threads;
      if (tiled) options.tile = {16, 8};
      expect(write_whole(options), ErrorCode::kNonFinite, sentence);
    }
  }
  SpectralImageWriter to = writer();
  ASSERT_TRUE(write(to, 0, 3));
  // Said of rows that no chunk is complete of, and from then on.
  for (int i = 0; i < 2; ++i) {
    expect(i == 0 ? write(to, 3, 3) : write(to, 6, 1), ErrorCode::kNonFinite,
           "1 non-finite pixel, the first at 3,5; NonFinite::kZero makes them black");
  }
  expect(to.finish(), ErrorCode::kNonFinite,
         "1 non-finite pixel, the first at 3,5; NonFinite::kZero makes them black");
  EXPECT_EQ(test::file_bytes(out_), "precious");
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"out.exr"});
}

TEST_F(SpectralImageErrors, NonFinitePixelsBecomeBlackWhereAskedFor) {
  spectra_.at(70 + 3, 1) = test::kNan;
  spectra_.at(39 * 70 + 69, 0) = test::kInf;
  std::vector<float> alpha(spectra_.lanes(), 0.5F);
  alpha[8] = test::kNan;
  SpectralImageOptions options;
  options.alpha = options.preview = true;
  options.nonfinite = NonFinite::kZero;
  const auto report = write_spectral_image(out_, spectra_, kWidth, kHeight, options, alpha);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->nonfinite_pixels, 3U);
  const test::Picture picture = test::read_picture(out_);
  EXPECT_EQ(picture.planes.size(), 10U);
  for (const auto& [name, plane] : picture.planes) {
    for (std::size_t i = 0; i < spectra_.lanes(); ++i) {
      const bool black = i == 73 || i == 39 * 70 + 69 || i == 8;
      if (black) {
        EXPECT_EQ(plane.at(i), 0) << name << " " << i;
      } else if (name == "A") {
        ASSERT_EQ(plane.at(i), 0.5) << i;
      }
    }
  }
}

TEST_F(SpectralImageErrors, SamplesBeyondHalfAreClampedAndTheirPixelsCounted) {
  spectra_.at(3, 0) = 65505;
  spectra_.at(3, 1) = 1e30F;
  spectra_.at(2799, 5) = -1e6F;
  spectra_.at(9, 5) = 65504;
  for (const int rows : {kHeight, 3}) {
    SpectralImageWriter to = writer();
    for (int y = 0; y < kHeight; y += rows) ASSERT_TRUE(write(to, y, std::min(rows, kHeight - y)));
    const auto report = to.finish();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->clamped_pixels, 2U) << rows;
    const SampledSpectra read = test::read_spectra(out_);
    EXPECT_EQ(read.at(3, 0), 65504);
    EXPECT_EQ(read.at(3, 1), 65504);
    EXPECT_EQ(read.at(2799, 5), -65504);
    EXPECT_EQ(read.at(9, 5), 65504);
  }
}

TEST_F(SpectralImageErrors, PreviewBeyondHalfIsClampedToo) {
  // Below the largest half in every band, but with more red than white has.
  for (std::size_t k = 0; k < 6; ++k) spectra_.at(11, k) = k > 2 ? 65000.0F : 0.0F;
  for (std::size_t k = 0; k < 6; ++k) spectra_.at(12, k) = 65000.0F;
  SpectralImageOptions options;
  options.preview = true;
  const auto report = write_whole(options);
  ASSERT_TRUE(report);
  const test::Picture picture = test::read_picture(out_);
  EXPECT_EQ(picture.at("R", 11, 0), 65504);
  EXPECT_NEAR(picture.at("R", 12, 0), 65000, 32);
  EXPECT_EQ(report->clamped_pixels, 1U);
}

TEST_F(SpectralImageErrors, CancelledImageLeavesNothing) {
  for (const int allowed : {0, 1, 2}) {
    SpectralImageOptions options;
    int calls = 0;
    options.threads = 1;
    options.progress = [&](const Progress& progress) {
      EXPECT_LE(progress.pixels_done, progress.pixels);
      EXPECT_EQ(progress.pixels, 2800U);
      return calls++ < allowed;
    };
    const auto whole = write_whole(options);
    ASSERT_FALSE(whole);
    EXPECT_EQ(code_of(whole), code(ErrorCode::kCancelled));
    calls = 0;
    SpectralImageWriter to = writer(options);
    int row = 0;
    while (row < kHeight && write(to, row, 5)) row += 5;
    // Chunks of 16 lines are complete with rows 15 to 19, 30 to 34, and 35 to 39.
    EXPECT_EQ(row, std::vector({15, 30, 35})[static_cast<std::size_t>(allowed)]);
    EXPECT_EQ(code_of(to.finish()), code(ErrorCode::kCancelled));
    EXPECT_EQ(code_of(write(to, row, 5)), code(ErrorCode::kCancelled));
    EXPECT_TRUE(folder_.names().empty());
  }
}

TEST_F(SpectralImageErrors, ProgressEndsWithEveryPixel) {
  std::vector<std::uint64_t> done;
  SpectralImageOptions options;
  options.threads = 2;
  options.tile = {32, 16};
  options.progress = [&](const Progress& progress) {
    done.push_back(progress.pixels_done);
    return true;
  };
  SpectralImageWriter to = writer(options);
  for (int y = 0; y < kHeight; y += 8) ASSERT_TRUE(write(to, y, 8));
  ASSERT_TRUE(to.finish());
  EXPECT_EQ(done.size(), 9U);
  EXPECT_TRUE(std::ranges::is_sorted(done));
  EXPECT_EQ(done.back(), 2800U);
}

TEST_F(SpectralImageErrors, UnfinishedImageIsNoFile) {
  test::write_text(folder_ / "old.exr", "precious");
  for (const int rows : {0, 1, 20, 40}) {
    for (const std::string& path : {out_, folder_ / "old.exr"}) {
      auto to = SpectralImageWriter::create(path, kWidth, kHeight, bands_);
      ASSERT_TRUE(to);
      EXPECT_EQ(rows > 0, write(*to, 0, rows).has_value());
    }
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"old.exr"});
    EXPECT_EQ(test::file_bytes(folder_ / "old.exr"), "precious");
  }
}

TEST_F(SpectralImageErrors, PathsThatCannotBeWrittenAreErrorsBeforeAnyRow) {
  for (const std::string& path : {folder_ / "missing/out.exr", folder_.path().string()}) {
    EXPECT_EQ(code_of(SpectralImageWriter::create(path, 9, 9, bands_)), code(ErrorCode::kBadFile)) << path;
  }
}

TEST_F(SpectralImageErrors, FolderThatMayNotBeWrittenIsNoPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0500), 0);
  const auto denied = create(9, 9, bands_);
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0700), 0);
  EXPECT_EQ(code_of(denied), code(ErrorCode::kNoPermission));
}

TEST_F(SpectralImageErrors, MovedFromWriterSaysSo) {
  SpectralImageWriter first = writer();
  const SpectralImageWriter second = std::move(first);
  // NOLINTNEXTLINE(bugprone-use-after-move): that is the subject
  EXPECT_EQ(code_of(first.finish()), code(ErrorCode::kBadArgument));
  EXPECT_EQ(code_of(write(first, 0, 1)), code(ErrorCode::kBadArgument));
  EXPECT_EQ(first.next_row(), 0);
}

}  // namespace
}  // namespace spectile
