// RegionReader: a part of an image as if it were an image, with no more decoded than it touches.
#pragma once

#include <array>
#include <memory>
#include <spectile/result.hpp>
#include <string>
#include <vector>

#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// Reads the lines of a region of one part. Of tiled parts the tiles that it touches are decoded, of others
/// the lines.
class RegionReader {
 public:
  /// The region of a part, in the coordinates of its data window, and clamped to it, which a note says. The
  /// input must outlive the reader. Errors: kBadArgument for a region that is empty, or outside of the data
  /// window.
  static Result<RegionReader> create(ExrInput& input, int part, const PixelWindow& region,
                                     std::vector<std::string>& notes);

  /// The part's header with the region as data window.
  const PartHeader& header() const noexcept { return header_; }
  /// The region's upper left corner, from that of the part's data window.
  std::array<int, 2> offset() const noexcept { return {x_, y_}; }

  /// Fills a strip, whose lines are counted from the region's top; see fill_strip(). The planes must be the
  /// same in every call. Errors: kBadFile, kOutOfMemory.
  Result<void> fill(const std::vector<PlaneSpec>& planes, Strip& strip);

 private:
  RegionReader() = default;
  int slab_lines(const std::vector<PlaneSpec>& planes) const;
  Result<void> load(const std::vector<PlaneSpec>& planes, int slab, int lines);

  ExrInput* input_ = nullptr;
  int part_ = 0;
  PartHeader header_;
  int x_ = 0;
  int y_ = 0;
  int first_column_ = 0;  // that is decoded, from the data window's left
  int columns_ = 0;
  int first_tile_ = 0;
  int last_tile_ = 0;
  std::shared_ptr<Strip> slab_;  // lines of the part, whole tiles or lines wide
  int loaded_ = -1;              // the slab held, -1 for none
};

}  // namespace spectile::io
