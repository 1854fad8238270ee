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
#include "src/io/exr/attributes.hpp"
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

/// All that a file's header needs. `source` gives windows, aspect and every attribute that still holds when
/// its pixels changed so; those named in `replaced` are left behind.
struct ImageSpec {
  const PartHeader* source = nullptr;
  std::vector<ChannelSpec> channels;  // names must be unique; the order is free
  Compression compression;
  std::optional<std::array<int, 2>> tile;  // width, height; scanlines where none
  bool mipmap = false;                     // of tiles: smaller levels too, rounded down
  TextAttributes text_attributes;
  std::vector<std::pair<std::string, double>> number_attributes;
  std::vector<std::string> replaced;
  PixelChange change = PixelChange::kSpectra;
  std::string view;  // of the source, from which plain R, G, B come; empty for its default one
  /// All that decides about the source's attributes.
  AttributeRules rules() const;
  /// True if a channel, an attribute or a type has a name that old versions of OpenEXR do not read.
  bool has_long_names() const;
};

/// A note that names the source's attributes which do not hold any more; none where all do.
std::optional<std::string> left_out_note(const ImageSpec& spec);

/// Encodes and writes one file. Slots are independent encoders; no two threads may use one at a time.
class ExrWriter {
 public:
  /// Packs the lines of a part of the level one after another at `packed`.
  using Pack = std::function<void(const PixelWindow& window, std::byte* packed)>;

  /// A file of a part for each spec; several are named as their sources are. Errors: those of
  /// AtomicFile::create(), kBadFile for a header that OpenEXR refuses.
  static Result<std::unique_ptr<ExrWriter>> create(const std::string& path, std::span<const ImageSpec> specs,
                                                   std::size_t slots);
  static Result<std::unique_ptr<ExrWriter>> create(const std::string& path, const ImageSpec& spec,
                                                   std::size_t slots) {
    return create(path, std::span(&spec, 1), slots);
  }
  ~ExrWriter();
  ExrWriter(const ExrWriter&) = delete;
  ExrWriter& operator=(const ExrWriter&) = delete;

  /// The part that all that follows is of, the first one at first. Parts must be written in order; no chunk
  /// may be under way.
  void begin_part(int part);

  /// Levels that must be written, 1 where there are no mip levels.
  int levels() const noexcept { return layout().levels; }
  LevelSize size(int level) const noexcept { return level_size(layout().image, level); }
  /// The level that chunks belong to, 0 at first. Levels must be written in order; no chunk may be under way.
  int level() const noexcept { return level_; }
  void begin_level(int level);
  /// Pixels of the parts and levels before the present one, and of all.
  Progress progress() const noexcept;

  /// Of the present level.
  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  int lines_per_chunk() const noexcept { return layout().lines_per_chunk; }
  int chunks() const noexcept {
    return chunks_across() * ((height_ + lines_per_chunk() - 1) / lines_per_chunk());
  }
  /// Chunks side by side: one, or the tiles of a row.
  int chunks_across() const noexcept { return (width_ + layout().chunk_width - 1) / layout().chunk_width; }
  /// The pixels of a chunk, counted from the level's upper left corner: tiles go from left to right, then
  /// down.
  PixelWindow window(int chunk) const noexcept;
  /// True if chunks are not written as they are packed.
  bool compresses() const noexcept { return layout().compression.kind != CompressionKind::kNone; }
  /// Bytes of a packed line of so many pixels.
  std::size_t line_bytes(int width) const noexcept {
    return layout().pixel_bytes * static_cast<std::size_t>(width);
  }
  /// Byte offset of a channel within a packed line of so many pixels, by its place in the spec.
  std::size_t channel_offset(std::size_t channel, std::size_t width) const {
    return layout().offsets[channel] * width;
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
  Result<void> commit(bool durable);
  std::uint64_t bytes_written() const noexcept { return bytes_written_; }

 private:
  /// How a part is stored.
  struct Layout {
    std::vector<std::size_t> offsets;  // of channels, in bytes a pixel
    std::vector<ChannelSpec> channels;
    Compression compression;
    std::size_t pixel_bytes = 0;
    bool tiled = false;
    int chunk_width = 1;
    LevelSize image;
    int levels = 1;
    int first_y = 0;
    int lines_per_chunk = 1;
  };
  struct Encoder;

  explicit ExrWriter(AtomicFile file);
  Result<void> start(const std::string& path, std::span<const ImageSpec> specs, std::size_t slots);
  Result<void> start_part(const ImageSpec& spec, const std::string& name);
  Result<void> check(exr_result_t code);
  Error failure(const char* doing, exr_result_t code);
  Error write_failure(const char* doing, exr_result_t code);
  const Layout& layout() const noexcept { return layouts_[static_cast<std::size_t>(part_)]; }
  Result<void> encode_dwa_chunk(std::size_t slot, int chunk, const Pack& pack);
  void end_encoding();

  AtomicFile file_;
  std::string path_;
  exr_context_t context_ = nullptr;
  std::vector<std::unique_ptr<Encoder>> encoders_;
  std::vector<Layout> layouts_;
  int part_ = 0;
  int level_ = 0;
  int width_ = 0;
  int height_ = 0;
  std::uint64_t bytes_written_ = 0;
  Result<void> io_result_;  // what the system said when a write failed; only the writing thread touches it
};

/// Bytes of work space one slot of an encoder needs, about.
std::size_t encoder_bytes(const ImageSpec& spec, int width);

}  // namespace spectile::io
