// ExrWriter: OpenEXR files of scanlines or tiles, with mip levels or without, their chunks packed by the
// caller, encoded in parallel, written in order.
#include "src/io/exr/exr_writer.hpp"

#include <OpenEXR/ImfHeader.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>

#include "src/base/errors.hpp"
#include "src/io/exr/compression.hpp"
#include "src/io/exr/encoders/dwa_encoder.hpp"
#include "src/io/exr/encoders/zip_encoder.hpp"
#include "src/io/exr/exr_input.hpp"

namespace spectile::io {

static_assert(std::endian::native == std::endian::little, "packed lines are written as they are in memory");

struct ExrWriter::Encoder {
  exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
  exr_chunk_info_t chunk{};
  const Pack* pack = nullptr;
  PixelWindow window;
  bool ready = false;
  std::vector<std::byte> lines;       // for DWA, which has its own encoder
  std::vector<char> compressed;       // ... and its result
  std::unique_ptr<ZipEncoder> zip;    // for ZIP and ZIPS
  std::span<const std::byte> result;  // what is to be written

  /// The pack step of the pipeline: the caller's last kernels write straight into the packed lines.
  static exr_result_t pack_step(exr_encode_pipeline_t* pipeline) {
    auto* self = static_cast<Encoder*>(pipeline->encoding_user_data);
    (*self->pack)(self->window, static_cast<std::byte*>(pipeline->packed_buffer));
    pipeline->packed_bytes = pipeline->chunk.unpacked_size;
    return EXR_ERR_SUCCESS;
  }
  /// The write step does nothing: finished chunks wait in their slot for their turn.
  static exr_result_t keep_step(exr_encode_pipeline_t*) { return EXR_ERR_SUCCESS; }
};

namespace {

// OpenEXR's last message on this thread, which is the one that gets the failed call's code. Its
// handler may not ask the context for anything: the context is locked while it is called.
// No text with a destructor: a thread that cannot have one noted ends the process.
thread_local std::array<char, 256> said_last;

constexpr int kLargestTile = 4096;

}  // namespace

std::size_t encoder_bytes(const ImageSpec& spec, int width) {
  std::size_t pixel = 0;
  for (const ChannelSpec& channel : spec.channels) pixel += channel.sample_bytes();
  const int lines = spec.tile ? (*spec.tile)[1] : io::lines_per_chunk(spec.compression.kind);
  const int across = spec.tile ? std::min((*spec.tile)[0], width) : width;
  const std::size_t packed = pixel * static_cast<std::size_t>(across) * static_cast<std::size_t>(lines);
  // Packed lines; compressed, the result and the compressor's own copies too.
  return spec.compression.kind == CompressionKind::kNone ? packed : 4 * packed;
}

ExrWriter::ExrWriter(AtomicFile file) : file_(std::move(file)) {}

Result<std::unique_ptr<ExrWriter>> ExrWriter::create(const std::string& path,
                                                     std::span<const ImageSpec> specs, std::size_t slots) {
  SPECTILE_ASSIGN(auto file, AtomicFile::create(path));
  std::unique_ptr<ExrWriter> writer(new ExrWriter(std::move(file)));
  SPECTILE_TRY(writer->start(path, specs, slots));
  return writer;
}

Error ExrWriter::failure(const char* doing, exr_result_t code) {
  if (code == EXR_ERR_OUT_OF_MEMORY)
    return make_error(ErrorCode::kOutOfMemory, "{}: not enough memory to write it", path_);
  std::string text = said_last[0] == '\0' ? exr_get_default_error_message(code) : said_last.data();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return make_error(ErrorCode::kBadFile, "{}: cannot {}: {}", path_, doing, text);
}

Error ExrWriter::write_failure(const char* doing, exr_result_t code) {
  return io_result_ ? failure(doing, code) : io_result_.error();
}

Result<void> ExrWriter::check(exr_result_t code) {
  if (code != EXR_ERR_SUCCESS) return write_failure("write the header", code);
  return {};
}

Result<void> ExrWriter::start(const std::string& path, std::span<const ImageSpec> specs, std::size_t slots) {
  path_ = path;
  exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
  init.user_data = this;
  init.error_handler_fn = [](exr_const_context_t, exr_result_t, const char* message) {
    const std::size_t length = std::min(std::strlen(message), said_last.size() - 1);
    std::copy_n(message, length, said_last.begin());
    said_last[length] = '\0';
  };
  init.write_fn = [](exr_const_context_t, void* user, const void* data, std::uint64_t bytes,
                     std::uint64_t offset, exr_stream_error_func_ptr_t) -> std::int64_t {
    auto* self = static_cast<ExrWriter*>(user);
    if (!self->io_result_) return -1;
    self->io_result_ = self->file_.write_at(data, bytes, offset);
    if (!self->io_result_) return -1;
    self->bytes_written_ = std::max(self->bytes_written_, offset + bytes);
    return static_cast<std::int64_t>(bytes);
  };
  for (const ImageSpec& spec : specs) {
    for (const int side : spec.tile.value_or(std::array{1, 1})) {
      if (side >= 1 && side <= kLargestTile) continue;
      return make_error(ErrorCode::kBadArgument, "tiles of {} x {}: sides are 1 to {}", (*spec.tile)[0],
                        (*spec.tile)[1], kLargestTile);
    }
  }
  SPECTILE_TRY(check(exr_start_write(&context_, path.c_str(), EXR_WRITE_FILE_DIRECTLY, &init)));
  if (std::any_of(specs.begin(), specs.end(), [](const auto& spec) { return spec.has_long_names(); }))
    exr_set_longname_support(context_, 1);
  for (const ImageSpec& spec : specs) {
    SPECTILE_TRY(start_part(spec, specs.size() > 1 ? spec.source->text("name").value_or("") : ""));
  }
  SPECTILE_TRY(check(exr_write_header(context_)));
  for (std::size_t i = 0; i < slots; ++i) encoders_.push_back(std::make_unique<Encoder>());
  begin_part(0);
  return {};
}

ExrWriter::~ExrWriter() {
  if (context_ == nullptr) return;
  end_encoding();
  // Ending an unfinished file must not write to it any more.
  if (io_result_) io_result_ = make_error(ErrorCode::kCancelled, "{}: not finished", path_);
  exr_finish(&context_);
}

Result<void> ExrWriter::encode_dwa_chunk(std::size_t slot, int chunk, const Pack& pack) {
  Encoder& encoder = *encoders_[slot];
  const PixelWindow window = this->window(chunk);
  const auto width = static_cast<std::size_t>(window.width());
  encoder.lines.resize(line_bytes(window.width()) * static_cast<std::size_t>(window.height()));
  pack(window, encoder.lines.data());
  std::vector<PackedChannel> channels;
  for (std::size_t i = 0; i < layout().channels.size(); ++i) {
    channels.push_back(
        {layout().channels[i].name.c_str(), layout().channels[i].type, channel_offset(i, width)});
  }
  return guarded(path_, [&] {
    encoder.compressed = encode_dwa(layout().compression, channels, line_bytes(window.width()),
                                    window.width(), window.height(), encoder.lines.data(), layout().tiled);
    encoder.result = std::as_bytes(std::span(encoder.compressed));
  });
}

Result<void> ExrWriter::encode(std::size_t slot, int chunk, const Pack& pack) {
  if (is_dwa(layout().compression.kind)) return encode_dwa_chunk(slot, chunk, pack);
  Encoder& encoder = *encoders_[slot];
  encoder.window = window(chunk);
  exr_result_t code = layout().tiled
                          ? exr_write_tile_chunk_info(context_, part_, chunk % chunks_across(),
                                                      chunk / chunks_across(), level_, level_, &encoder.chunk)
                          : exr_write_scanline_chunk_info(
                                context_, part_, layout().first_y + encoder.window.y0, &encoder.chunk);
  if (code != EXR_ERR_SUCCESS) return failure("encode", code);
  // OpenEXR 3.1 cuts tiles of every level off where level 0 ends.
  encoder.chunk.width = encoder.window.width();
  encoder.chunk.height = encoder.window.height();
  encoder.chunk.unpacked_size =
      line_bytes(encoder.window.width()) * static_cast<std::uint64_t>(encoder.window.height());
  encoder.pack = &pack;
  code = encoder.ready ? exr_encoding_update(context_, part_, &encoder.chunk, &encoder.pipeline)
                       : exr_encoding_initialize(context_, part_, &encoder.chunk, &encoder.pipeline);
  if (code != EXR_ERR_SUCCESS) return failure("encode", code);
  encoder.ready = true;
  // The pipeline insists on a source for every channel, though only its own pack step would look at it.
  static const std::uint8_t kUnused = 0;
  for (int i = 0; i < encoder.pipeline.channel_count; ++i) {
    exr_coding_channel_info_t& channel = encoder.pipeline.channels[i];
    channel.encode_from_ptr = &kUnused;
    const int bytes = static_cast<unsigned char>(channel.bytes_per_element);
    channel.user_bytes_per_element = static_cast<std::int16_t>(bytes);
    channel.user_data_type = channel.data_type;
    channel.user_pixel_stride = bytes;
    channel.user_line_stride = bytes * channel.width;
  }
  if (encoder.pipeline.convert_and_pack_fn == nullptr) {
    code = exr_encoding_choose_default_routines(context_, part_, &encoder.pipeline);
    if (code != EXR_ERR_SUCCESS) return failure("encode", code);
  }
  encoder.pipeline.encoding_user_data = &encoder;
  encoder.pipeline.convert_and_pack_fn = &Encoder::pack_step;
  encoder.pipeline.yield_until_ready_fn = nullptr;
  encoder.pipeline.write_fn = &Encoder::keep_step;
  if (is_zip(layout().compression.kind)) encoder.pipeline.compress_fn = nullptr;
  code = exr_encoding_run(context_, part_, &encoder.pipeline);
  if (code != EXR_ERR_SUCCESS) return failure("encode", code);
  encoder.result = {static_cast<const std::byte*>(encoder.pipeline.compressed_buffer),
                    encoder.pipeline.compressed_bytes};
  // A reader takes a chunk that is no smaller than its pixels for stored as they are; OpenEXR 3.1's B44
  // forgets it.
  if (encoder.result.size() >= encoder.pipeline.packed_bytes) {
    encoder.result = {static_cast<const std::byte*>(encoder.pipeline.packed_buffer),
                      encoder.pipeline.packed_bytes};
  }
  if (!is_zip(layout().compression.kind)) return {};
  return guarded(path_, [&] {
    if (!encoder.zip)
      encoder.zip =
          std::make_unique<ZipEncoder>(layout().compression.level > 0 ? layout().compression.level : 6);
    encoder.result = encoder.zip->encode(encoder.result);
  });
}

void ExrWriter::begin_part(int part) {
  if (part != part_) end_encoding();
  part_ = part;
  begin_level(0);
}

void ExrWriter::end_encoding() {
  for (const auto& encoder : encoders_) {
    if (encoder->ready) exr_encoding_destroy(context_, &encoder->pipeline);
    encoder->pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    encoder->ready = false;
  }
}

void ExrWriter::begin_level(int level) {
  level_ = level;
  width_ = size(level).width;
  height_ = size(level).height;
}

Progress ExrWriter::progress() const noexcept {
  Progress out;
  for (int part = 0; part < static_cast<int>(layouts_.size()); ++part) {
    const Layout& one = layouts_[static_cast<std::size_t>(part)];
    for (int level = 0; level < one.levels; ++level) {
      const std::uint64_t pixels = level_size(one.image, level).pixels();
      out.pixels += pixels;
      if (part < part_ || (part == part_ && level < level_)) out.pixels_done += pixels;
    }
  }
  return out;
}

PixelWindow ExrWriter::window(int chunk) const noexcept {
  const int x = chunk % chunks_across() * layout().chunk_width;
  const int y = chunk / chunks_across() * lines_per_chunk();
  return {x, y, std::min(x + layout().chunk_width, width_), std::min(y + lines_per_chunk(), height_)};
}

std::span<const std::byte> ExrWriter::encoded(std::size_t slot) const {
  return encoders_[slot]->result;
}

Result<void> ExrWriter::write(int chunk, std::span<const std::byte> encoded) {
  const exr_result_t code =
      layout().tiled ? exr_write_tile_chunk(context_, part_, chunk % chunks_across(), chunk / chunks_across(),
                                            level_, level_, encoded.data(), encoded.size())
                     : exr_write_scanline_chunk(context_, part_, layout().first_y + window(chunk).y0,
                                                encoded.data(), encoded.size());
  if (code != EXR_ERR_SUCCESS) return write_failure("write", code);
  return {};
}

Result<void> ExrWriter::commit(bool durable) {
  end_encoding();
  const exr_result_t code = exr_finish(&context_);
  context_ = nullptr;
  if (!io_result_) return io_result_;
  if (code != EXR_ERR_SUCCESS) return write_failure("finish", code);
  return file_.commit(durable);
}

}  // namespace spectile::io
