// Strips: runs of lines of some channels of one part, each channel a plane in its own sample type.
#pragma once

#include <cstddef>
#include <memory>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>
#include <string>
#include <vector>

#include "src/io/exr/exr_input.hpp"

namespace spectile::io {

/// A channel to read, in the type it is read as.
struct PlaneSpec {
  std::string name;
  SampleType type = SampleType::kHalf;
  std::size_t sample_bytes() const { return io::sample_bytes(type); }
};

/// Lines first_line to first_line + lines - 1, counted from 0 at the top of the data window.
struct Strip {
  int first_line = 0;
  int lines = 0;
  int width = 0;    ///< pixels of a line
  int first_x = 0;  ///< of a part of another strip: where it starts there
  std::vector<FloatBuffer> planes;
  std::vector<std::size_t> stride_bytes;
  std::vector<std::size_t> row_bytes;  ///< of a line's pixels, without what pads it

  bool holds(int first, int count) const {
    return first >= first_line && first + count <= first_line + lines;
  }
  /// Start of a plane's line; 64-byte aligned, readable up to whole blocks of lanes.
  const std::byte* row(std::size_t plane, int line) const {
    return reinterpret_cast<const std::byte*>(planes[plane].data()) +
           static_cast<std::size_t>(line - first_line) * stride_bytes[plane];
  }
  std::size_t sample_bytes(std::size_t plane) const {
    return row_bytes[plane] / static_cast<std::size_t>(width);
  }
  std::byte* row(std::size_t plane, int line) {
    return const_cast<std::byte*>(static_cast<const Strip*>(this)->row(plane, line));
  }
};

/// Memory for a strip of `width` pixels a line. Errors: kOutOfMemory.
Result<std::shared_ptr<Strip>> make_strip(const std::vector<PlaneSpec>& planes, int width, int first_line,
                                          int lines);

/// A copy of a strip's part, as a strip of its own: `width` pixels from pixel `x` on of its lines.
/// Errors: kOutOfMemory.
Result<std::shared_ptr<Strip>> cut_strip(const Strip& from, int x, int width, int first_line, int lines);

/// Lines worth reading at once: several of the input's chunks, some 16 MiB, never more than `height`; as many
/// as `at_least`, unless these take more than 128 MiB.
int strip_lines(const PartHeader& header, const std::vector<PlaneSpec>& planes, int at_least);

/// Adds a strip's planes to what a read fills: `width` pixels a line, the first at x, y. For this room only.
void add_slices(Imf::FrameBuffer& target, const std::vector<PlaneSpec>& planes, int x, int y, int width,
                Strip& strip);

/// Fills a strip's planes; an empty name leaves its plane alone. Errors: kBadFile.
Result<void> fill_strip(ExrInput& input, int part, const std::vector<PlaneSpec>& planes, Strip& strip);

/// The same from whole tiles of one level, the first of which begin at pixel x of it. Errors: kBadFile.
Result<void> fill_tiles(ExrInput& input, int part, const std::vector<PlaneSpec>& planes,
                        const ExrInput::TileRange& tiles, int x, Strip& strip);

/// Reads luminance with subsampled chroma, channels Y, RY, BY of a file's first part, which OpenEXR puts
/// together as RGB.
class LumaChromaReader {
 public:
  /// Errors: kBadFile.
  static Result<std::unique_ptr<LumaChromaReader>> open(const std::string& path, int threads);
  ~LumaChromaReader();

  /// Fills the first three planes of a strip, of halves, whose upper left corner is at `left`, `top` within
  /// the part's data window. Errors: kBadFile.
  Result<void> fill(const PartHeader& header, int left, int top, Strip& strip);

 private:
  LumaChromaReader();
  struct File;
  std::string path_;
  std::unique_ptr<File> file_;
};

}  // namespace spectile::io
