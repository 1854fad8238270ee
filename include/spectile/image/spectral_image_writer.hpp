// Spectral images from spectra in memory: whole ones, or rows of them as they are finished.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <spectile/image/image.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>

namespace spectile {

/// Options of a spectral image that is written from memory. Those that change no bit: threads, durable,
/// progress.
struct SpectralImageOptions {
  /// Light becomes channels S0.*, reflectances and unbounded ones T.*.
  Quantity quantity = Quantity::kReflectance;
  /// Unit of light, as the attribute emissiveUnits; "W.m^-2.sr^-1" where empty. For light only.
  std::string units = {};
  SampleType pixel = SampleType::kHalf;  ///< of all channels: kHalf or kFloat
  Compression compression = {};
  /// Of pixels with NaN or infinity in a sample, alpha's too: an error, or 0 in every channel, and counted.
  NonFinite nonfinite = NonFinite::kStop;
  /// Channels R, G, B: linear sRGB, of reflectances under D65, of light as it is, for CIE 1931, as
  /// project_image() has it.
  bool preview = false;
  /// A channel A, whose samples come beside the spectra: whoever hands over spectra hands over its alpha
  /// then.
  bool alpha = false;
  std::optional<std::array<int, 2>> tile = {};  ///< width and height, 1 to 4096; none: scanlines
  /// Mip levels, as ImageOptions::mipmap has them. For write_spectral_image() only, which has all rows.
  bool mipmap = false;
  int threads = 0;                 ///< 0: every core that the process may use
  bool durable = false;            ///< wait for the device, so that no loss of power takes a file back
  ProgressFunction progress = {};  ///< called when a chunk of the file is written
};

/// View of spectra in an arrangement of the caller's. Shapes: sample k of pixel x of row y is
/// data[y * row_stride_floats + x * pixel_stride_floats + k * band_stride_floats], y counted from the first
/// row of the view. No alignment is needed.
struct StridedSpectraView {
  std::span<const float> data = {};
  std::size_t bands = 0;
  std::size_t row_stride_floats = 0;
  std::size_t pixel_stride_floats = 0;
  std::size_t band_stride_floats = 1;

  /// Pixel after pixel, an array of structures. Shapes: data [row][x][band].
  static constexpr StridedSpectraView interleaved(std::span<const float> data, std::size_t bands,
                                                  std::size_t width) noexcept {
    return {data, bands, width * bands, bands, 1};
  }
  /// Plane after plane. Shapes: data [band][row][x].
  static constexpr StridedSpectraView planar(std::span<const float> data, std::size_t bands,
                                             std::size_t width, std::size_t rows) noexcept {
    return {data, bands, width, 1, width * rows};
  }
};

namespace io {
class SpectralWriter;
}  // namespace io

/// Writes a spectral image row by row, from the top, in bounded memory: a renderer hands over lines as they
/// are finished. The file is that of write_spectral_image(), whatever the numbers of rows and threads. It
/// appears at its path when finish() returns; without that there is none, nor a part of one.
///
/// Rows are kept until a chunk of the file is complete (16 lines with zip, 1 with zips, 256 with dwab, a row
/// of tiles), and until there is a chunk for each thread, unless these take more than 192 MB; what is kept is
/// packed, of the file's sample type. Chunks are encoded side by side within write_rows(). Rows cannot come
/// in another order, nor tiles one by one: all that is missing would have to be kept.
///
/// One thread at a time may use it. After an error of what was handed over (sizes, bands, order) the writer
/// is as it was before; after any other (pixels, the file, progress) it has let go of the file, and every
/// later call returns that error again.
class SpectralImageWriter {
 public:
  /// Opens the output. Units: those of the options. Errors, all naming the file: kBadArgument for sides not
  /// of 1 to 262144 pixels, for options that do not go together, for bands whose centres agree to 1e-6 nm, by
  /// which channels are named, and, with a preview, for bands without one (those of Projector); kBadFile,
  /// kNoPermission, kNoSpace for a path that cannot be written; kOutOfMemory; those of active_isa().
  static Result<SpectralImageWriter> create(const std::string& path, int width, int height,
                                            const Bands& bands, const SpectralImageOptions& options = {});

  SpectralImageWriter(SpectralImageWriter&&) noexcept;
  SpectralImageWriter& operator=(SpectralImageWriter&&) noexcept;
  SpectralImageWriter(const SpectralImageWriter&) = delete;
  SpectralImageWriter& operator=(const SpectralImageWriter&) = delete;
  ~SpectralImageWriter();

  /// The row that has to come next, 0 at first; the height when all are there.
  int next_row() const noexcept;

  /// Takes rows first_row to first_row + rows - 1, which must be the next ones. The spectra are read before
  /// it returns, and not kept.
  /// Shapes: spectra [rows * width], pixel x of row y in lane (y - first_row) * width + x; alpha
  /// [rows * width], the same way, or nothing without SpectralImageOptions::alpha.
  /// Numbers: float samples keep every bit, half ones are rounded to nearest even. Samples beyond 65504 in a
  /// half become that, and their pixels are counted. For NaN and infinities, of alpha too, see
  /// SpectralImageOptions::nonfinite. A preview beyond 2^124 is that.
  /// Errors: kBandsMismatch for other bands than those of create(), and for wavelengths of each lane's own;
  /// kSizeMismatch for another number of lanes or samples of alpha; kBadArgument for rows that are not the
  /// next ones, or no data; kNonFinite, which names the first pixel and the number among these rows;
  /// kCancelled; kNoSpace, kBadFile, kOutOfMemory.
  Result<void> write_rows(int first_row, int rows, SampledSpectraView spectra,
                          std::span<const float> alpha = {});
  /// The same from the caller's arrangement. Errors: kSizeMismatch for data too short for the strides too.
  Result<void> write_rows(int first_row, int rows, const StridedSpectraView& spectra,
                          std::span<const float> alpha = {});

  /// Completes the file and gives it its name. The report holds size, bands, quantity, nonfinite_pixels,
  /// clamped_pixels, bytes, notes, and the seconds spent in write_rows() and in here. Errors: kBadArgument
  /// where rows are missing, which can still come; kNoSpace, kNoPermission, kBadFile.
  Result<ImageReport> finish();

 private:
  explicit SpectralImageWriter(std::unique_ptr<io::SpectralWriter> writer);
  std::unique_ptr<io::SpectralWriter> writer_;
};

/// Writes spectra as a spectral image in the layout of upsample_image(), whole or not at all. Shapes: spectra
/// [width * height], pixel x, y in lane y * width + x; alpha the same, or nothing without
/// SpectralImageOptions::alpha. The bands are those of the spectra. Numbers, errors: those of
/// SpectralImageWriter; the number of pixels that are not finite is that of the whole image. Source: Fichet,
/// Pacanowski, Wilkie, An OpenEXR Layout for Spectral Images, JCGT 10(3), 2021.
Result<ImageReport> write_spectral_image(const std::string& path, SampledSpectraView spectra, int width,
                                         int height, const SpectralImageOptions& options = {},
                                         std::span<const float> alpha = {});

/// An image of spectra in the caller's arrangement.
struct StridedImage {
  StridedSpectraView spectra = {};
  Bands bands = {};
  int width = 0;
  int height = 0;
};

/// The same from the caller's arrangement. Errors: kSizeMismatch for data too short for the strides too.
Result<ImageReport> write_spectral_image(const std::string& path, const StridedImage& image,
                                         const SpectralImageOptions& options = {},
                                         std::span<const float> alpha = {});

}  // namespace spectile
