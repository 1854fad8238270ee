// SpectralWriter: a spectral image on its way into a file, row by row.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <spectile/image/spectral_image_writer.hpp>
#include <string>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/write/spectra_job.hpp"

namespace spectile::io {

class SpectralWriter {
 public:
  /// Mip levels need all rows in one call. Errors: those of SpectralImageWriter::create().
  static Result<std::unique_ptr<SpectralWriter>> create(const std::string& path, int width, int height,
                                                        const Bands& bands,
                                                        const SpectralImageOptions& options);

  int next_row() const noexcept { return next_row_; }

  /// Spectra: one of the views. Errors: those of SpectralImageWriter::write_rows().
  template <class Spectra>
  Result<void> write_rows(const RowRange& range, const Spectra& spectra, std::span<const float> alpha) {
    return contained<void>(path_, [&]() -> Result<void> {
      SPECTILE_TRY(check(range));
      SPECTILE_ASSIGN(const auto rows,
                      SpectraRows::of({path_, width_, bands_, options_.alpha}, range, spectra, alpha));
      return lasting([&] { return take(rows); });
    });
  }

  /// Errors: those of SpectralImageWriter::finish().
  Result<ImageReport> finish();

 private:
  SpectralWriter(std::string path, int width, int height, Bands bands, SpectralImageOptions options);
  Result<void> start();
  Result<void> check(const RowRange& range) const;
  Result<void> take(const SpectraRows& rows);
  Result<void> encode(int end_chunk_row, LineStats& found);
  Result<ImageReport> complete();
  Result<void> lasting(const std::function<Result<void>()>& action);

  std::string path_;
  int width_;
  int height_;
  Bands bands_;
  SpectralImageOptions options_;
  ImageOptions frame_options_;  // the same for what all images have in common
  ImageReport report_;
  std::size_t slots_ = 1;
  int chunk_rows_kept_ = 1;  // that are worth waiting for, so that every thread has a chunk
  int next_row_ = 0;
  int next_chunk_row_ = 0;  // rows of chunks before it are encoded
  LineStats stats_;
  std::optional<Error> failed_;
  // The job refers to the file.
  std::unique_ptr<ExrWriter> file_;
  std::unique_ptr<SpectraJob> job_;
};

}  // namespace spectile::io
