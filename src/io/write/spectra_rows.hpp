// SpectraRows: rows of an image's spectra in a caller's memory, whatever their arrangement.
#pragma once

#include <cstddef>
#include <span>
#include <spectile/image/spectral_image_writer.hpp>
#include <string>
#include <variant>

namespace spectile::io {

/// The image that rows belong to, for checks and messages.
struct RowsOf {
  const std::string& path;
  int width;
  const Bands& bands;
  bool alpha;
};

/// Rows first to first + count - 1.
struct RowRange {
  int first = 0;
  int count = 0;
  bool holds(int row) const noexcept { return row >= first && row - first < count; }
};

class SpectraRows {
 public:
  SpectraRows() = default;
  /// Errors: kBandsMismatch, kSizeMismatch, kBadArgument, as SpectralImageWriter::write_rows() has them. The
  /// range must be one of the image.
  static Result<SpectraRows> of(const RowsOf& image, const RowRange& range, const SampledSpectraView& spectra,
                                std::span<const float> alpha);
  static Result<SpectraRows> of(const RowsOf& image, const RowRange& range, const StridedSpectraView& spectra,
                                std::span<const float> alpha);

  const RowRange& range() const noexcept { return range_; }
  /// Copies `count` pixels of a row from pixel x on: a row of samples for each band, then one of alpha where
  /// there is some.
  void load(int row, std::size_t x, std::size_t count, float* const* to) const;

 private:
  RowRange range_;
  std::size_t width_ = 0;
  std::variant<SampledSpectraView, StridedSpectraView> spectra_;
  std::span<const float> alpha_;
};

}  // namespace spectile::io
