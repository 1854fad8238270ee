// ExrInput: an OpenEXR file open for reading, with exceptions turned into errors.
#pragma once

#include <OpenEXR/ImfForward.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <spectile/result.hpp>
#include <string>
#include <vector>

#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// Runs `action`; an exception becomes an Error that names `path`: kOutOfMemory, with a remark on it, or
/// kBadFile.
Result<void> guarded(const std::string& path, const std::function<void()>& action, const char* remark = "");

/// Walks over the attributes of every part's header of an open OpenEXR file. OpenEXR takes memory for the
/// size that an attribute claims, up to 2 GiB, before it finds the file to be shorter. What else may be wrong
/// is left to it. Errors: kBadFile for an attribute of more bytes than follow, or of fewer than none.
Result<void> check_attribute_sizes(int descriptor, const std::string& path);

/// A file with at least one flat (not deep) part. Not thread-safe; it decodes on several threads itself.
class ExrInput {
 public:
  /// Opens and checks the headers of every part.
  /// Errors: kBadFile (missing, a directory, not OpenEXR, damaged, deep only, larger than
  /// PartHeader::kMaxSide); kNoPermission.
  static Result<std::unique_ptr<ExrInput>> open(const std::string& path, int threads);
  ~ExrInput();

  const std::string& path() const noexcept { return path_; }
  int parts() const { return static_cast<int>(headers_.size()); }
  const PartHeader& header(int part) const { return headers_[static_cast<std::size_t>(part)]; }

  /// Checks that the path still leads to the file that was opened, as it was then, so that what was read is
  /// of one piece. Errors: kBadFile.
  Result<void> unchanged() const;

  /// Reads lines y0 to y1, both included, of a part into the frame buffer. Errors: kBadFile.
  Result<void> read(int part, const Imf::FrameBuffer& target, int y0, int y1);

  /// Sizes of a part's mip levels, the image first. Errors: kBadFile.
  Result<std::vector<LevelSize>> levels(int part);

  /// Tiles of one level, all bounds included.
  struct TileRange {
    int x0, x1;
    int y0, y1;
    int level = 0;
  };
  /// Reads tiles of a tiled part. A part may be read by read() or by this, not by both. Errors: kBadFile.
  Result<void> read_tiles(int part, const Imf::FrameBuffer& target, const TileRange& tiles);

  /// Reads what comes last of a part, which a file that was cut short lacks: the last line, or the last tile
  /// of the smallest level. Errors: kBadFile.
  Result<void> read_last(int part);

 private:
  explicit ExrInput(std::string path);
  /// Identifies a file, and its state.
  using Identity = std::array<std::int64_t, 5>;
  static Result<Identity> identify(const std::string& path);

  std::string path_;
  Identity identity_{};
  std::unique_ptr<Imf::MultiPartInputFile> file_;
  std::vector<PartHeader> headers_;
};

}  // namespace spectile::io
