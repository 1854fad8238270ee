// SpectralWriter: a spectral image on its way into a file, row by row.
#include "src/io/write/spectral_writer.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <spectile/spectra/named_spectra.hpp>

#include "src/io/channels/dialect_names.hpp"
#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/stages/band_channels.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile::io {
namespace {

// Memory for rows that wait for a chunk for each thread.
constexpr std::size_t kKeptBytes = std::size_t{192} << 20;

ImageOptions frame_options_of(const SpectralImageOptions& options) {
  ImageOptions out;
  out.pixel = options.pixel;
  out.compression = options.compression;
  out.nonfinite = options.nonfinite;
  out.tile = options.tile;
  out.mipmap = options.mipmap;
  out.threads = options.threads;
  out.durable = options.durable;
  out.progress = options.progress;
  return out;
}

Result<void> check_image(const std::string& path, int width, int height,
                         const SpectralImageOptions& options) {
  for (const int side : {width, height}) {
    if (side >= 1 && side <= PartHeader::kMaxSide) continue;
    return make_error(ErrorCode::kBadArgument, "{}: an image of {} x {} pixels; sides are 1 to {}", path,
                      width, height, PartHeader::kMaxSide);
  }
  if (options.pixel == SampleType::kUint32) {
    return make_error(ErrorCode::kBadArgument, "{}: samples are written as half or float", path);
  }
  if (!options.units.empty() && options.quantity != Quantity::kIlluminant) {
    return make_error(ErrorCode::kBadArgument, "{}: the spectra are {}, and have no units such as \"{}\"",
                      path, to_string(options.quantity), options.units);
  }
  return {};
}

Result<Projector> preview_of(const std::string& path, const Bands& bands, Quantity quantity) {
  auto projector = [&]() -> Result<Projector> {
    if (quantity == Quantity::kIlluminant) return Projector::emissive(bands);
    SPECTILE_ASSIGN(const auto d65, illuminant("D65"));
    return Projector::reflective(bands, d65);
  }();
  if (projector) return projector;
  return make_error(projector.error().code, "{}: no preview: {}", path, projector.error().message);
}

TextAttributes texts_of(const SpectralImageOptions& options, const Bands& bands) {
  TextAttributes out;
  if (options.preview) add_color_tag(out, ColorTarget::kSrgb);
  add_layout_attributes(out, options.quantity, bands);
  if (options.units.empty()) return out;
  for (auto& [name, text] : out) {
    if (name == "emissiveUnits") text = options.units;
  }
  return out;
}

/// Chunks are counted in int. Sides out of range are another check's.
Result<void> check_tiles(const std::string& path, const std::optional<std::array<int, 2>>& tile,
                         const LevelSize& image) {
  if (!tile || (*tile)[0] < 1 || (*tile)[1] < 1) return {};
  const auto count = [](int side, int of) { return (std::int64_t{side} + of - 1) / of; };
  const std::int64_t tiles = count(image.width, (*tile)[0]) * count(image.height, (*tile)[1]);
  constexpr int kMaxTiles = std::numeric_limits<int>::max();
  if (tiles <= kMaxTiles) return {};
  return make_error(ErrorCode::kBadArgument, "{}: {} tiles of {} x {}, at most {}", path, tiles, (*tile)[0],
                    (*tile)[1], kMaxTiles);
}

}  // namespace

SpectralWriter::SpectralWriter(std::string path, int width, int height, Bands bands,
                               SpectralImageOptions options)
    : path_(std::move(path)),
      width_(width),
      height_(height),
      bands_(std::move(bands)),
      options_(std::move(options)),
      frame_options_(frame_options_of(options_)) {
  report_.bands = bands_.count();
  report_.quantity = options_.quantity;
}

Result<std::unique_ptr<SpectralWriter>> SpectralWriter::create(const std::string& path, int width, int height,
                                                               const Bands& bands,
                                                               const SpectralImageOptions& options) {
  SPECTILE_TRY(check_image(path, width, height, options));
  std::unique_ptr<SpectralWriter> writer(new SpectralWriter(path, width, height, bands, options));
  SPECTILE_TRY(writer->start());
  return writer;
}

Result<void> SpectralWriter::start() {
  SPECTILE_ASSIGN(const auto setup, set_up_job({}, path_, frame_options_));
  // For its checks and its note: the names are those of the job's channels.
  SPECTILE_ASSIGN(const auto names,
                  dialect_names(*find_dialect("layout"), bands_, options_.quantity, path_, report_.notes));
  std::optional<Projector> preview;
  if (options_.preview) {
    SPECTILE_ASSIGN(preview, preview_of(path_, bands_, options_.quantity));
    note_white(preview->white_compensation(), report_.notes);
  }
  job_ = std::make_unique<SpectraJob>(width_, bands_, options_, std::move(preview), setup.kernels);
  const PixelWindow window = {0, 0, width_, height_};
  const PartHeader header(window, window);
  ImageSpec spec;
  spec.source = &header;
  spec.channels = job_->channels();
  spec.compression = options_.compression;
  spec.tile = tiles_of(frame_options_);
  spec.mipmap = options_.mipmap;
  spec.text_attributes = texts_of(options_, bands_);
  slots_ = slot_count(spec, width_, setup.threads);
  SPECTILE_TRY(check_tiles(path_, spec.tile, {width_, height_}));
  SPECTILE_ASSIGN(file_, ExrWriter::create(path_, spec, slots_));
  SPECTILE_TRY(job_->prepare(*file_, slots_ + filter_slots(frame_options_)));
  const std::size_t chunk_row_bytes =
      file_->line_bytes(width_) * static_cast<std::size_t>(file_->lines_per_chunk());
  const auto fitting = static_cast<int>(std::clamp<std::size_t>(kKeptBytes / chunk_row_bytes, 1, 1 << 16));
  const int across = file_->chunks_across();
  chunk_rows_kept_ = std::min((setup.threads + across - 1) / across, fitting);
  job_->keep_at_most(static_cast<std::size_t>(
      std::min<std::int64_t>(std::int64_t{chunk_rows_kept_} * file_->lines_per_chunk(), height_)));
  return {};
}

Result<void> SpectralWriter::check(const RowRange& range) const {
  if (failed_) return *failed_;
  const auto refuse = [&](const std::string& why) {
    return make_error(ErrorCode::kBadArgument, "{}: {}", path_, why);
  };
  if (!file_) return refuse("the image is complete, and takes no more rows");
  if (range.count < 1)
    return refuse(fmt::format("{} rows at row {}, not 1 or more", range.count, range.first));
  const std::int64_t last = std::int64_t{range.first} + range.count - 1;
  if (range.first != next_row_) {
    return refuse(fmt::format("rows {} to {} came, and row {} is the next", range.first, last, next_row_));
  }
  if (last >= height_)
    return refuse(fmt::format("rows {} to {} came, and the last is {}", range.first, last, height_ - 1));
  return {};
}

/// An error of the action is the answer to all later calls, and ends the file.
Result<void> SpectralWriter::lasting(const std::function<Result<void>()>& action) {
  const auto start = std::chrono::steady_clock::now();
  auto result = contained<void>(path_, action);
  report_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (result) return {};
  failed_ = result.error();
  job_.reset();
  file_.reset();
  return result;
}

Result<void> SpectralWriter::take(const SpectraRows& rows) {
  const int end = rows.range().first + rows.range().count;
  const int lines = file_->lines_per_chunk();
  const int complete = end == height_ ? (end + lines - 1) / lines : end / lines;
  job_->take(rows);
  LineStats found;
  int kept_from = rows.range().first;
  if (end == height_ || complete - next_chunk_row_ >= chunk_rows_kept_) {
    SPECTILE_TRY(encode(complete, found));
    kept_from = std::max(kept_from, std::min(complete * lines, height_));
  }
  for (int row = kept_from; row < end; ++row) job_->keep(row, found);
  if (options_.nonfinite == NonFinite::kStop && found.nonfinite.count > 0) {
    return stopped_at(path_, ErrorCode::kNonFinite, "non-finite", found.nonfinite,
                      "NonFinite::kZero makes them black");
  }
  stats_.add(found);
  next_row_ = end;
  if (!options_.mipmap) return {};
  return write_levels(*job_, *file_, slots_, height_, frame_options_, {});
}

Result<void> SpectralWriter::encode(int end_chunk_row, LineStats& found) {
  const int across = file_->chunks_across();
  const auto stops = [stop = options_.nonfinite == NonFinite::kStop](const LineStats& stats) {
    return stop && stats.nonfinite.count > 0;
  };
  SPECTILE_ASSIGN(found, run_chunks(*job_, *file_, {next_chunk_row_ * across, end_chunk_row * across}, slots_,
                                    frame_options_, stops));
  job_->drop_kept();
  next_chunk_row_ = end_chunk_row;
  return {};
}

Result<ImageReport> SpectralWriter::finish() {
  return contained<ImageReport>(path_, [&] { return complete(); });
}

Result<ImageReport> SpectralWriter::complete() {
  if (failed_) return *failed_;
  if (!file_) return make_error(ErrorCode::kBadArgument, "{}: the image is complete already", path_);
  if (next_row_ < height_) {
    return make_error(ErrorCode::kBadArgument, "{}: {} of {} rows came, and row {} is the next", path_,
                      next_row_, height_, next_row_);
  }
  SPECTILE_TRY(lasting([&] { return file_->commit(options_.durable); }));
  add_counts(report_, stats_, *file_);
  job_.reset();
  file_.reset();
  return report_;
}

}  // namespace spectile::io
