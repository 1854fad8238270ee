// ExrWriter: OpenEXR files of scanlines or tiles, with mip levels or without, their chunks packed by the
// caller, encoded in parallel, written in order.
#pragma once

#include <OpenEXR/openexr.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <spectile/image/image.hpp>
#include <spectile/result.hpp>
#include <string>
#include <vector>

#include "src/base/atomic_file.hpp"
#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// A channel to write, one sample a pixel.
struct ChannelSpec {
  std::string name;
  SampleType type = SampleType::kHalf;
  std::size_t sample_bytes() const { return io::sample_bytes(type); }
};

/// Names and texts of attributes.
using TextAttributes = std::vector<std::pair<std::string, std::string>>;

/// All that a file's header needs. `source` gives windows, aspect and every attribute that describes the
/// picture; those that describe its storage are left behind, and so are those named in `replaced`.
struct ImageSpec {
  const PartHeader* source = nullptr;
  std::vector<ChannelSpec> channels;  // names must be unique; the order is free
  Compression compression;
  std::optional<std::array<int, 2>> tile;  // width, height; scanlines where none
  bool mipmap = false;                     // of tiles: smaller levels too, rounded down
  TextAttributes text_attributes;
  std::vector<std::string> replaced;
};

/// Encodes and writes one file. Slots are independent encoders; no two threads may use one at a time.
class ExrWriter {
 public:
  /// Packs the lines of a part of the level one after another at `packed`.
  using Pack = std::function<void(const PixelWindow& window, std::byte* packed)>;

  /// Errors: those of AtomicFile::create(), kBadFile for a header that OpenEXR refuses.
  static Result<std::unique_ptr<ExrWriter>> create(const std::string& path, const ImageSpec& spec,
                                                   std::size_t slots);
  ~ExrWriter();
  ExrWriter(const ExrWriter&) = delete;
  ExrWriter& operator=(const ExrWriter&) = delete;

  /// Levels that must be written, 1 where there are no mip levels.
  int levels() const noexcept { return levels_; }
  LevelSize size(int level) const noexcept { return level_size(image_, level); }
  /// The level that chunks belong to, 0 at first. Levels must be written in order; no chunk may be under way.
  int level() const noexcept { return level_; }
  void begin_level(int level);
  /// Pixels of the levels before the present one, and of all levels.
  Progress progress() const noexcept;

  /// Of the present level.
  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  int lines_per_chunk() const noexcept { return lines_per_chunk_; }
  int chunks() const noexcept {
    return chunks_across() * ((height_ + lines_per_chunk_ - 1) / lines_per_chunk_);
  }
  /// The pixels of a chunk, counted from the level's upper left corner: tiles go from left to right, then
  /// down.
  PixelWindow window(int chunk) const noexcept;
  /// True if chunks are not written as they are packed.
  bool compresses() const noexcept { return compression_.kind != CompressionKind::kNone; }
  /// Bytes of a packed line of so many pixels.
  std::size_t line_bytes(int width) const noexcept { return pixel_bytes_ * static_cast<std::size_t>(width); }
  /// Byte offset of a channel within a packed line of so many pixels, by its place in the spec.
  std::size_t channel_offset(std::size_t channel, std::size_t width) const {
    return offsets_[channel] * width;
  }
  /// Within a line of the whole width.
  std::size_t channel_offset(std::size_t channel) const {
    return channel_offset(channel, static_cast<std::size_t>(width_));
  }

  /// Packs and compresses a chunk in a slot. May run beside encode() and write() of other slots.
  Result<void> encode(std::size_t slot, int chunk, const Pack& pack);
  /// The chunk that encode() left in the slot, as it is in the file.
  std::span<const std::byte> encoded(std::size_t slot) const;
  /// Writes an encoded chunk; chunks must come in order.
  Result<void> write(int chunk, std::span<const std::byte> encoded);
  /// Completes the file and gives it its name.
  Result<void> commit();
  std::uint64_t bytes_written() const noexcept { return bytes_written_; }

 private:
  explicit ExrWriter(AtomicFile file);
  Result<void> start(const std::string& path, const ImageSpec& spec, std::size_t slots);
  Error failure(const char* doing, exr_result_t code);
  Error write_failure(const char* doing, exr_result_t code);
  int chunks_across() const noexcept { return (width_ + chunk_width_ - 1) / chunk_width_; }
  Result<void> encode_dwa_chunk(std::size_t slot, int chunk, const Pack& pack);
  struct Encoder;

  AtomicFile file_;
  std::string path_;
  exr_context_t context_ = nullptr;
  std::vector<std::unique_ptr<Encoder>> encoders_;
  std::vector<std::size_t> offsets_;  // of channels, in bytes a pixel
  std::vector<ChannelSpec> channels_;
  Compression compression_;
  std::size_t pixel_bytes_ = 0;
  bool tiled_ = false;
  int chunk_width_ = 1;
  LevelSize image_;
  int levels_ = 1;
  int level_ = 0;
  int width_ = 0;
  int height_ = 0;
  int first_y_ = 0;
  int lines_per_chunk_ = 1;
  std::uint64_t bytes_written_ = 0;
  Result<void> io_result_;  // what the system said when a write failed; only the writing thread touches it
};

/// Bytes of work space one slot of an encoder needs, about.
std::size_t encoder_bytes(const ImageSpec& spec, int width);

}  // namespace spectile::io
