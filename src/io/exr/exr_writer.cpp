// ExrWriter: OpenEXR files of scanlines or tiles, with mip levels or without, their chunks packed by the
// caller, encoded in parallel, written in order.
#include "src/io/exr/exr_writer.hpp"

#include <OpenEXR/ImfHeader.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "src/base/errors.hpp"
#include "src/io/exr/attributes.hpp"
#include "src/io/exr/compression.hpp"
#include "src/io/exr/encoders/dwa_encoder.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/encoders/zip_encoder.hpp"

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
thread_local std::string said_last;

// Longest name that every version of OpenEXR reads.
constexpr std::size_t kShortName = 31;

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

Result<std::unique_ptr<ExrWriter>> ExrWriter::create(const std::string& path, const ImageSpec& spec,
                                                     std::size_t slots) {
  SPECTILE_ASSIGN(auto file, AtomicFile::create(path));
  std::unique_ptr<ExrWriter> writer(new ExrWriter(std::move(file)));
  SPECTILE_TRY(writer->start(path, spec, slots));
  return writer;
}

Error ExrWriter::failure(const char* doing, exr_result_t code) {
  if (code == EXR_ERR_OUT_OF_MEMORY) return make_error(ErrorCode::kOutOfMemory, "{}: out of memory", path_);
  std::string text = said_last.empty() ? exr_get_default_error_message(code) : said_last;
  std::replace(text.begin(), text.end(), '\n', ' ');
  return make_error(ErrorCode::kBadFile, "{}: cannot {}: {}", path_, doing, text);
}

Error ExrWriter::write_failure(const char* doing, exr_result_t code) {
  return io_result_ ? failure(doing, code) : io_result_.error();
}

Result<void> ExrWriter::start(const std::string& path, const ImageSpec& spec, std::size_t slots) {
  path_ = path;
  tiled_ = spec.tile.has_value();
  for (const int side : spec.tile.value_or(std::array{1, 1})) {
    if (side >= 1 && side <= kLargestTile) continue;
    return make_error(ErrorCode::kBadArgument, "tiles of {} x {}: sides are 1 to {}", (*spec.tile)[0],
                      (*spec.tile)[1], kLargestTile);
  }
  exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
  init.user_data = this;
  init.error_handler_fn = [](exr_const_context_t, exr_result_t, const char* message) { said_last = message; };
  init.write_fn = [](exr_const_context_t, void* user, const void* data, std::uint64_t bytes,
                     std::uint64_t offset, exr_stream_error_func_ptr_t) -> std::int64_t {
    auto* self = static_cast<ExrWriter*>(user);
    if (!self->io_result_) return -1;
    self->io_result_ = self->file_.write_at(data, bytes, offset);
    if (!self->io_result_) return -1;
    self->bytes_written_ = std::max(self->bytes_written_, offset + bytes);
    return static_cast<std::int64_t>(bytes);
  };
  const auto check = [&](exr_result_t code) -> Result<void> {
    if (code != EXR_ERR_SUCCESS) return write_failure("write the header", code);
    return {};
  };
  SPECTILE_TRY(check(exr_start_write(&context_, path.c_str(), EXR_WRITE_FILE_DIRECTLY, &init)));
  int part = 0;
  SPECTILE_TRY(check(exr_add_part(context_, "", tiled_ ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part)));

  bool long_names = false;
  for (const ChannelSpec& channel : spec.channels)
    long_names = long_names || channel.name.size() > kShortName;
  const Imf::Header& source = spec.source->imf();
  for (auto it = source.begin(); it != source.end(); ++it) {
    long_names = long_names || std::strlen(it.name()) > kShortName ||
                 std::strlen(it.attribute().typeName()) > kShortName;
  }
  if (long_names) exr_set_longname_support(context_, 1);

  const PixelWindow& data = spec.source->data_window();
  const PixelWindow& display = spec.source->display_window();
  const exr_attr_box2i_t data_window = {{data.x0, data.y0}, {data.x1 - 1, data.y1 - 1}};
  const exr_attr_box2i_t display_window = {{display.x0, display.y0}, {display.x1 - 1, display.y1 - 1}};
  const exr_attr_v2f_t centre = {source.screenWindowCenter().x, source.screenWindowCenter().y};
  SPECTILE_TRY(check(exr_initialize_required_attr(
      context_, part, &display_window, &data_window, source.pixelAspectRatio(), &centre,
      source.screenWindowWidth(), EXR_LINEORDER_INCREASING_Y, compression_type(spec.compression.kind))));
  if (tiled_) {
    SPECTILE_TRY(check(exr_set_tile_descriptor(context_, part, static_cast<std::uint32_t>((*spec.tile)[0]),
                                               static_cast<std::uint32_t>((*spec.tile)[1]),
                                               spec.mipmap ? EXR_TILE_MIPMAP_LEVELS : EXR_TILE_ONE_LEVEL,
                                               EXR_TILE_ROUND_DOWN)));
  }
  SPECTILE_TRY(check(copy_attributes(source, context_, part, spec.replaced)));
  for (const auto& [name, text] : spec.text_attributes) {
    SPECTILE_TRY(check(exr_attr_set_string(context_, part, name.c_str(), text.c_str())));
  }

  image_ = {data.width(), data.height()};
  levels_ = tiled_ && spec.mipmap ? level_count(image_) : 1;
  width_ = image_.width;
  height_ = image_.height;
  first_y_ = data.y0;
  lines_per_chunk_ = tiled_ ? (*spec.tile)[1] : io::lines_per_chunk(spec.compression.kind);
  chunk_width_ = tiled_ ? (*spec.tile)[0] : width_;
  // A line's channels lie in the order of their names.
  std::vector<std::size_t> order(spec.channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return spec.channels[a].name < spec.channels[b].name; });
  offsets_.resize(order.size());
  channels_ = spec.channels;
  compression_ = spec.compression;
  for (const std::size_t i : order) {
    const ChannelSpec& channel = spec.channels[i];
    SPECTILE_TRY(check(exr_add_channel(context_, part, channel.name.c_str(), pixel_type(channel.type),
                                       EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1)));
    offsets_[i] = pixel_bytes_;
    pixel_bytes_ += channel.sample_bytes();
  }
  SPECTILE_TRY(check(exr_write_header(context_)));
  for (std::size_t i = 0; i < slots; ++i) encoders_.push_back(std::make_unique<Encoder>());
  return {};
}

ExrWriter::~ExrWriter() {
  if (context_ == nullptr) return;
  for (const auto& encoder : encoders_) {
    if (encoder->ready) exr_encoding_destroy(context_, &encoder->pipeline);
  }
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
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    channels.push_back({channels_[i].name.c_str(), channels_[i].type, channel_offset(i, width)});
  }
  return guarded(path_, [&] {
    encoder.compressed = encode_dwa(compression_, channels, line_bytes(window.width()), window.width(),
                                    window.height(), encoder.lines.data(), tiled_);
    encoder.result = std::as_bytes(std::span(encoder.compressed));
  });
}

Result<void> ExrWriter::encode(std::size_t slot, int chunk, const Pack& pack) {
  if (is_dwa(compression_.kind)) return encode_dwa_chunk(slot, chunk, pack);
  Encoder& encoder = *encoders_[slot];
  encoder.window = window(chunk);
  exr_result_t code =
      tiled_ ? exr_write_tile_chunk_info(context_, 0, chunk % chunks_across(), chunk / chunks_across(),
                                         level_, level_, &encoder.chunk)
             : exr_write_scanline_chunk_info(context_, 0, first_y_ + encoder.window.y0, &encoder.chunk);
  if (code != EXR_ERR_SUCCESS) return failure("encode", code);
  // OpenEXR 3.1 cuts tiles of every level off where level 0 ends.
  encoder.chunk.width = encoder.window.width();
  encoder.chunk.height = encoder.window.height();
  encoder.chunk.unpacked_size =
      line_bytes(encoder.window.width()) * static_cast<std::uint64_t>(encoder.window.height());
  encoder.pack = &pack;
  code = encoder.ready ? exr_encoding_update(context_, 0, &encoder.chunk, &encoder.pipeline)
                       : exr_encoding_initialize(context_, 0, &encoder.chunk, &encoder.pipeline);
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
    code = exr_encoding_choose_default_routines(context_, 0, &encoder.pipeline);
    if (code != EXR_ERR_SUCCESS) return failure("encode", code);
  }
  encoder.pipeline.encoding_user_data = &encoder;
  encoder.pipeline.convert_and_pack_fn = &Encoder::pack_step;
  encoder.pipeline.yield_until_ready_fn = nullptr;
  encoder.pipeline.write_fn = &Encoder::keep_step;
  if (is_zip(compression_.kind)) encoder.pipeline.compress_fn = nullptr;
  code = exr_encoding_run(context_, 0, &encoder.pipeline);
  if (code != EXR_ERR_SUCCESS) return failure("encode", code);
  encoder.result = {static_cast<const std::byte*>(encoder.pipeline.compressed_buffer),
                    encoder.pipeline.compressed_bytes};
  // A reader takes a chunk that is no smaller than its pixels for stored as they are; OpenEXR 3.1's B44
  // forgets it.
  if (encoder.result.size() >= encoder.pipeline.packed_bytes) {
    encoder.result = {static_cast<const std::byte*>(encoder.pipeline.packed_buffer),
                      encoder.pipeline.packed_bytes};
  }
  if (!is_zip(compression_.kind)) return {};
  return guarded(path_, [&] {
    if (!encoder.zip)
      encoder.zip = std::make_unique<ZipEncoder>(compression_.level > 0 ? compression_.level : 6);
    encoder.result = encoder.zip->encode(encoder.result);
  });
}

void ExrWriter::begin_level(int level) {
  level_ = level;
  width_ = size(level).width;
  height_ = size(level).height;
}

Progress ExrWriter::progress() const noexcept {
  Progress out;
  for (int level = 0; level < levels_; ++level) {
    out.pixels += size(level).pixels();
    if (level < level_) out.pixels_done += size(level).pixels();
  }
  return out;
}

PixelWindow ExrWriter::window(int chunk) const noexcept {
  const int x = chunk % chunks_across() * chunk_width_;
  const int y = chunk / chunks_across() * lines_per_chunk_;
  return {x, y, std::min(x + chunk_width_, width_), std::min(y + lines_per_chunk_, height_)};
}

std::span<const std::byte> ExrWriter::encoded(std::size_t slot) const {
  return encoders_[slot]->result;
}

Result<void> ExrWriter::write(int chunk, std::span<const std::byte> encoded) {
  const exr_result_t code =
      tiled_ ? exr_write_tile_chunk(context_, 0, chunk % chunks_across(), chunk / chunks_across(), level_,
                                    level_, encoded.data(), encoded.size())
             : exr_write_scanline_chunk(context_, 0, first_y_ + window(chunk).y0, encoded.data(),
                                        encoded.size());
  if (code != EXR_ERR_SUCCESS) return write_failure("write", code);
  return {};
}

Result<void> ExrWriter::commit() {
  for (const auto& encoder : encoders_) {
    if (encoder->ready) exr_encoding_destroy(context_, &encoder->pipeline);
    encoder->ready = false;
  }
  const exr_result_t code = exr_finish(&context_);
  context_ = nullptr;
  if (!io_result_) return io_result_;
  if (code != EXR_ERR_SUCCESS) return write_failure("finish", code);
  return file_.commit();
}

}  // namespace spectile::io
