// SpectralImageWriter, write_spectral_image: the library's boundary of the room.
#include <spectile/image/spectral_image_writer.hpp>

#include "src/base/errors.hpp"
#include "src/io/write/spectral_writer.hpp"

namespace spectile {
namespace {

Error moved_from() {
  return make_error(ErrorCode::kBadArgument, "this writer was moved from, and has no image");
}

/// All rows in one call.
template <class Spectra>
Result<ImageReport> write_all(const std::string& path, const Spectra& spectra, const Bands& bands,
                              const io::LevelSize& size, const SpectralImageOptions& options,
                              std::span<const float> alpha) {
  return io::timed(path, [&]() -> Result<ImageReport> {
    SPECTILE_ASSIGN(const auto writer,
                    io::SpectralWriter::create(path, size.width, size.height, bands, options));
    SPECTILE_TRY(writer->write_rows({0, size.height}, spectra, alpha));
    return writer->finish();
  });
}

}  // namespace

SpectralImageWriter::SpectralImageWriter(std::unique_ptr<io::SpectralWriter> writer)
    : writer_(std::move(writer)) {}
SpectralImageWriter::SpectralImageWriter(SpectralImageWriter&&) noexcept = default;
SpectralImageWriter& SpectralImageWriter::operator=(SpectralImageWriter&&) noexcept = default;
SpectralImageWriter::~SpectralImageWriter() = default;

Result<SpectralImageWriter> SpectralImageWriter::create(const std::string& path, int width, int height,
                                                        const Bands& bands,
                                                        const SpectralImageOptions& options) {
  return io::contained<SpectralImageWriter>(path, [&]() -> Result<SpectralImageWriter> {
    if (options.mipmap) {
      return make_error(ErrorCode::kBadArgument,
                        "{}: mip levels are averages of rows that this writer does not keep; "
                        "write_spectral_image() writes them",
                        path);
    }
    SPECTILE_ASSIGN(auto writer, io::SpectralWriter::create(path, width, height, bands, options));
    return SpectralImageWriter(std::move(writer));
  });
}

int SpectralImageWriter::next_row() const noexcept {
  return writer_ ? writer_->next_row() : 0;
}

Result<void> SpectralImageWriter::write_rows(int first_row, int rows, SampledSpectraView spectra,
                                             std::span<const float> alpha) {
  if (!writer_) return moved_from();
  return writer_->write_rows({first_row, rows}, spectra, alpha);
}

Result<void> SpectralImageWriter::write_rows(int first_row, int rows, const StridedSpectraView& spectra,
                                             std::span<const float> alpha) {
  if (!writer_) return moved_from();
  return writer_->write_rows({first_row, rows}, spectra, alpha);
}

Result<ImageReport> SpectralImageWriter::finish() {
  if (!writer_) return moved_from();
  return writer_->finish();
}

Result<ImageReport> write_spectral_image(const std::string& path, SampledSpectraView spectra, int width,
                                         int height, const SpectralImageOptions& options,
                                         std::span<const float> alpha) {
  const Bands* const bands = spectra.axis.bands();
  if (bands == nullptr) {
    return make_error(ErrorCode::kBandsMismatch, "{}: spectra at {}, an image's are on bands", path,
                      spectra.axis.description());
  }
  return write_all(path, spectra, *bands, {width, height}, options, alpha);
}

Result<ImageReport> write_spectral_image(const std::string& path, const StridedImage& image,
                                         const SpectralImageOptions& options, std::span<const float> alpha) {
  return write_all(path, image.spectra, image.bands, {image.width, image.height}, options, alpha);
}

}  // namespace spectile
