// ImageSource: one part of an open image, or a region of it, read in strips.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/region.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

class ImageSource {
 public:
  virtual ~ImageSource() = default;

  ExrInput& input() noexcept { return *input_; }
  int part() const noexcept { return part_; }
  /// That of the part, with the region as data window.
  const PartHeader& header() const { return region_ ? region_->header() : input_->header(part_); }
  /// That of the part as it is in the file.
  const PartHeader& whole() const { return input_->header(part_); }
  /// Of the region within the data window.
  std::array<int, 2> offset() const { return region_ ? region_->offset() : std::array<int, 2>{}; }
  int width() const { return header().width(); }
  int height() const { return header().height(); }
  /// Of its strips.
  const std::vector<PlaneSpec>& planes() const noexcept { return planes_; }
  /// Notes on channels and parts that cannot pass through, and on a region that was clamped.
  const std::vector<std::string>& notes() const noexcept { return notes_; }
  /// Lines worth reading at once, given those of the output's chunks.
  int strip_lines(int chunk_lines) const { return io::strip_lines(header(), planes_, chunk_lines); }

  /// Reads lines into a new strip. Errors: kBadFile, also for a file that was changed, when its last line is
  /// read; kOutOfMemory.
  virtual Result<std::shared_ptr<Strip>> read(int first_line, int lines);

 protected:
  ImageSource() = default;
  /// Errors: those of RegionReader.
  Result<void> choose_region(const std::optional<PixelWindow>& region);
  /// Fills the planes that have a name. Errors: as for read().
  Result<void> fill(const std::vector<PlaneSpec>& planes, Strip& strip);

  std::unique_ptr<ExrInput> input_;
  std::optional<RegionReader> region_;
  int part_ = 0;
  std::vector<PlaneSpec> planes_;
  std::vector<std::string> notes_;
};

}  // namespace spectile::io
