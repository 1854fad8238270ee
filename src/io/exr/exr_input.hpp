// ExrInput: an OpenEXR file open for reading, with exceptions turned into errors.
#pragma once

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartInputFile.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <spectile/result.hpp>
#include <string>

namespace spectile::io {

/// Runs `action`; an exception becomes an Error that names `path`.
Result<void> guarded(const std::string& path, const std::function<void()>& action);

/// A file with at least one flat (not deep) part. Not thread-safe; it decodes on several threads itself.
class ExrInput {
 public:
  /// Opens and checks the headers of every part.
  /// Errors: kBadFile (missing, a directory, not OpenEXR, damaged, deep only, larger than kMaxSide);
  /// kNoPermission.
  static Result<std::unique_ptr<ExrInput>> open(const std::string& path, int threads);

  // Pixels along a side that are believed; more is taken for damage.
  static constexpr int kMaxSide = 1 << 18;

  const std::string& path() const noexcept { return path_; }
  int parts() const { return file_->parts(); }
  const Imf::Header& header(int part) const { return file_->header(part); }
  bool deep(int part) const;

  /// Whether the path still leads to the file that was opened, as it was then; what was read is of one piece
  /// if so. Errors: kBadFile.
  Result<void> unchanged() const;

  /// Reads lines y0 to y1, both included, of a part into the frame buffer. Errors: kBadFile.
  Result<void> read(int part, const Imf::FrameBuffer& target, int y0, int y1);

  /// Reads tiles x0 to x1, both included, of a row of tiles of a tiled part at full size. A part may be read
  /// by read() or by this, not by both. Errors: kBadFile.
  Result<void> read_tiles(int part, const Imf::FrameBuffer& target, int x0, int x1, int row);

  /// Reads the last tile of a part's smallest level, to see whether it is there. Errors: kBadFile.
  Result<void> read_smallest(int part);

 private:
  explicit ExrInput(std::string path) : path_(std::move(path)) {}
  /// What tells a file from another, and from itself after a change.
  using Identity = std::array<std::int64_t, 5>;
  static Result<Identity> identify(const std::string& path);

  std::string path_;
  Identity identity_{};
  std::unique_ptr<Imf::MultiPartInputFile> file_;
};

}  // namespace spectile::io
