// Partial films: saving and loading their limbs.

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <mutex>
#include <shared_mutex>
#include <spectile/image/film_file.hpp>

#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/film/pixel.hpp"
#include "src/io/convert/frame/output.hpp"
#include "src/io/convert/stages/color_rows.hpp"
#include "src/io/film/film_channels.hpp"
#include "src/io/film/film_checksum.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

using State = FilmAccess::State;

constexpr std::size_t kPreviewChannels = 3;

/// The pixels of the tiles that hold anything; one pixel where none does, since an image is never empty.
PixelWindow touched_window(const State& s) {
  PixelWindow out = {s.window.x1, s.window.y1, s.window.x0, s.window.y0};
  for (std::size_t t = 0; t < s.tiles.size(); ++t) {
    const std::int64_t* const limbs = s.tiles[t];
    // A tile of zeros, of weights 0 or of sums that cancel, is as good as none.
    if (limbs == nullptr || std::all_of(limbs, limbs + s.layout.limbs, [](std::int64_t v) { return v == 0; }))
      continue;
    const PixelWindow w = s.tile_window(t);
    out = {std::min(out.x0, w.x0), std::min(out.y0, w.y0), std::max(out.x1, w.x1), std::max(out.y1, w.y1)};
  }
  if (out.x1 > out.x0) return out;
  return {s.window.x0, s.window.y0, s.window.x0 + 1, s.window.y0 + 1};
}

/// Lines of limbs, two channels each, and the preview behind them.
class SaveJob : public io::MemoryJob {
 public:
  SaveJob(const State& s, const PixelWindow& window, const std::vector<io::FilmLimb>& limbs, bool preview,
          const kernels::KernelTable& kernels)
      : MemoryJob(2 * kPreviewChannels * padded(window)),
        s_(s),
        window_(window),
        limbs_(limbs),
        preview_(preview),
        kernels_(kernels),
        pixels_(s) {}

  std::vector<io::ChannelSpec> channels() const {
    std::vector<io::ChannelSpec> out;
    for (const io::FilmLimb& limb : limbs_) {
      out.push_back({limb.name + ".hi", SampleType::kUint32});
      out.push_back({limb.name + ".lo", SampleType::kUint32});
    }
    for (const char* name : {"R", "G", "B"}) {
      if (preview_) out.push_back({name, SampleType::kHalf});
    }
    return out;
  }
  void line(std::size_t slot, const io::Strip& /*strip*/, int line, std::byte* packed,
            io::LineStats& /*stats*/) override {
    if (packed == nullptr) return;
    const int y = window_.y0 + line;
    std::memset(packed, 0, writer().line_bytes(writer().width()));
    for (int x = window_.x0; x < window_.x1;) {
      const int end = std::min(window_.x1, (x / kFilmTile + 1) * kFilmTile);
      const std::int64_t* const tile = s_.tiles[s_.tile_at(x, y)];
      if (tile != nullptr) pack_tile(slot, tile, x, end, y, packed);
      x = end;
    }
    if (preview_) pack_preview(slot, packed);
  }

 private:
  static std::size_t padded(const PixelWindow& window) {
    return blocks_for(static_cast<std::size_t>(window.width())) * kLanesPerBlock;
  }
  std::size_t padded() const { return padded(window_); }
  float* preview_row(std::size_t slot, std::size_t c) { return row(slot) + c * padded(); }

  void pack_tile(std::size_t slot, const std::int64_t* tile, int x0, int x1, int y, std::byte* packed) {
    const auto first = static_cast<std::size_t>(x0 - window_.x0);
    for (std::size_t i = 0; i < limbs_.size(); ++i) {
      std::byte* hi = packed + writer().channel_offset(2 * i) + first * sizeof(std::uint32_t);
      std::byte* lo = packed + writer().channel_offset(2 * i + 1) + first * sizeof(std::uint32_t);
      const std::int64_t* limb = tile + limbs_[i].at + pixel_in_tile(x0, y) * limbs_[i].per_pixel;
      for (int x = x0; x < x1; ++x, limb += limbs_[i].per_pixel) {
        const auto bits = std::bit_cast<std::uint64_t>(*limb);
        const auto high = static_cast<std::uint32_t>(bits >> 32U);
        const auto low = static_cast<std::uint32_t>(bits);
        std::memcpy(hi, &high, sizeof high);
        std::memcpy(lo, &low, sizeof low);
        hi += sizeof high;
        lo += sizeof low;
      }
    }
    for (int x = x0; preview_ && x < x1; ++x) {
      pixels_.develop(FilmLayer::kSrgb, 0, tile, pixel_in_tile(x, y),
                      preview_row(slot, 0) + static_cast<std::size_t>(x - window_.x0), padded());
    }
  }

  void pack_preview(std::size_t slot, std::byte* packed) {
    const auto width = static_cast<std::size_t>(window_.width());
    for (std::size_t c = 0; c < kPreviewChannels; ++c) {
      float* const values = preview_row(slot, c);
      io::store_row(kernels_, values, width, SampleType::kHalf, preview_row(slot, kPreviewChannels),
                    packed + writer().channel_offset(2 * limbs_.size() + c));
      std::fill_n(values, width, 0.0F);
    }
  }

  const State& s_;
  PixelWindow window_;
  const std::vector<io::FilmLimb>& limbs_;
  bool preview_;
  const kernels::KernelTable& kernels_;
  FilmPixels pixels_;
};

Result<FilmFileReport> save(const Film& film, const std::string& path, const std::string& progress,
                            const ImageOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (progress.find('\0') != std::string::npos) {
    return make_error(ErrorCode::kBadArgument,
                      "{}: the progress text holds a zero byte, which files cannot keep", path);
  }
  SPECTILE_ASSIGN(const auto kernels, dispatch::active());
  State& s = FilmAccess::state(film);
  const std::unique_lock lock(s.whole);
  for (std::size_t t = 0; t < s.tiles.size(); ++t) {
    const std::scoped_lock tile(s.tile_mutex(t));  // a development may be looking at it
    s.normalize_carries(t);
  }
  if (s.overflown) return film_overflow(s);
  const PixelWindow window = touched_window(s);
  const io::PartHeader header({0, 0, s.options.width, s.options.height}, window);
  const std::vector<io::FilmLimb> limbs = io::film_limbs(s.layout);
  SaveJob job(s, window, limbs, s.options.xyz.has_value(), *kernels);
  // OpenEXRCore counts channels in 16 bits, with a sign; beyond, it drops all without a word.
  constexpr std::size_t kMaxChannels = 32767;
  if (job.channels().size() > kMaxChannels) {
    return make_error(ErrorCode::kUnavailable, "{}: the film takes {} channels, and a file holds {}", path,
                      job.channels().size(), kMaxChannels);
  }
  io::ImageSpec spec;
  spec.source = &header;
  spec.channels = job.channels();
  spec.text_attributes = io::film_attributes(s, progress);
  spec.text_attributes.emplace_back(io::kFilmChecksum, io::film_checksum(spec.text_attributes, s));
  ImageOptions durable = options;
  durable.durable = true;
  SPECTILE_ASSIGN(const auto report, io::run_image_job({job, path, std::move(spec), durable, {}, {}}));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return FilmFileReport{report.bytes_written, seconds.count()};
}

/// Lines to read at once: a row of tiles, or as many as fit into some memory.
int lines_at_once(std::size_t channels, int width) {
  constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
  const std::size_t line = channels * sizeof(std::uint32_t) * static_cast<std::size_t>(width);
  return static_cast<int>(std::clamp<std::size_t>(kMaxBytes / line, 1, kFilmTile));
}

Result<void> read_limbs(io::ExrInput& input, State& s, const std::vector<io::FilmLimb>& limbs,
                        const PixelWindow& data, const ProgressFunction& progress) {
  std::vector<io::PlaneSpec> planes;
  for (const io::FilmLimb& limb : limbs) {
    for (const char* end : {".hi", ".lo"}) planes.push_back({limb.name + end, SampleType::kUint32});
  }
  const int step = lines_at_once(planes.size(), data.width());
  for (int first = 0; first < data.height(); first += step) {
    SPECTILE_ASSIGN(auto strip,
                    io::make_strip(planes, data.width(), first, std::min(step, data.height() - first)));
    SPECTILE_TRY(io::fill_strip(input, 0, planes, *strip));
    const auto done =
        static_cast<std::uint64_t>(data.width()) * static_cast<std::uint64_t>(first + strip->lines);
    const auto pixels = static_cast<std::uint64_t>(data.width()) * static_cast<std::uint64_t>(data.height());
    if (progress && !progress({done, pixels})) {
      return make_error(ErrorCode::kCancelled, "stopped on request");
    }
    for (int line = first; line < first + strip->lines; ++line) {
      const int y = data.y0 + line;
      for (std::size_t i = 0; i < limbs.size(); ++i) {
        const auto* const hi = reinterpret_cast<const std::uint32_t*>(strip->row(2 * i, line));
        const auto* const lo = reinterpret_cast<const std::uint32_t*>(strip->row(2 * i + 1, line));
        for (int x = data.x0; x < data.x1; ++x) {
          const auto column = static_cast<std::size_t>(x - data.x0);
          const std::uint64_t bits = (std::uint64_t{hi[column]} << 32U) | lo[column];
          if (bits == 0) continue;
          const std::size_t tile = s.tile_at(x, y);
          std::int64_t* const memory = s.touch(tile);
          if (memory == nullptr) {
            return make_error(ErrorCode::kOutOfMemory, "no memory for another tile of the film");
          }
          s.additions[tile] = 1;
          memory[limbs[i].at + pixel_in_tile(x, y) * limbs[i].per_pixel] = std::bit_cast<std::int64_t>(bits);
        }
      }
    }
  }
  return {};
}

/// Every colour's quad holds the weight, the file that of the first one.
void copy_weights(State& s) {
  for (std::int64_t* const tile : s.tiles) {
    for (std::size_t q = 0; tile != nullptr && q < s.layout.quads * kernels::kFilmTilePixels; ++q) {
      const std::size_t first = q - q % s.layout.quads;
      for (const std::size_t limb :
           {kernels::kFilmQuadWeight, kernels::kFilmQuadWeight + kernels::kFilmQuadRest}) {
        tile[kernels::kFilmQuadLimbs * q + limb] = tile[kernels::kFilmQuadLimbs * first + limb];
      }
    }
  }
}

Result<LoadedFilm> load(const std::string& path, int threads, const ProgressFunction& progress) {
  SPECTILE_ASSIGN(auto input, io::ExrInput::open(path, tiles::thread_count(threads)));
  const io::PartHeader& header = input->header(0);
  SPECTILE_ASSIGN(auto described, io::film_of(header, path));
  State& s = *described.state;
  const PixelWindow& data = header.data_window();
  if (data.x0 < s.window.x0 || data.y0 < s.window.y0 || data.x1 > s.window.x1 || data.y1 > s.window.y1) {
    return make_error(ErrorCode::kBadFile, "{}: holds pixels beyond the film's crop window", path);
  }
  const std::vector<io::FilmLimb> limbs = io::film_limbs(s.layout);
  for (const io::FilmLimb& limb : limbs) {
    for (const char* end : {".hi", ".lo"}) {
      const io::StoredChannel* const channel = header.find(limb.name + end);
      if (channel == nullptr || channel->type != SampleType::kUint32 || channel->subsampled()) {
        return make_error(ErrorCode::kBadFile, "{}: channel {}{} is missing or not of integers", path,
                          limb.name, end);
      }
    }
  }
  SPECTILE_TRY(read_limbs(*input, s, limbs, data, progress));
  copy_weights(s);
  for (std::size_t t = 0; t < s.tiles.size(); ++t) s.normalize_carries(t);
  if (s.overflown) return make_error(ErrorCode::kBadFile, "{}: {}", path, film_overflow(s).message);
  const auto checksum = header.text(io::kFilmChecksum);
  if (checksum && !io::has_checksum(*checksum, io::film_attributes(s, described.progress), s)) {
    return make_error(ErrorCode::kBadFile,
                      "{}: is damaged: its sums or options are not those of its checksum", path);
  }
  return LoadedFilm{FilmAccess::make(std::move(described.state)), std::move(described.progress),
                    checksum.has_value()};
}

}  // namespace

Result<FilmFileReport> save_film(const Film& film, const std::string& path, const std::string& progress,
                                 const ImageOptions& options) {
  return io::contained<FilmFileReport>(path, [&] { return save(film, path, progress, options); });
}

Result<LoadedFilm> load_film(const std::string& path, int threads, const ProgressFunction& progress) {
  return io::contained<LoadedFilm>(path, [&] { return load(path, threads, progress); });
}

}  // namespace spectile
