// Conversion: the streaming frame common to every image-to-image job.
#include "src/io/convert/frame/conversion.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <future>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/chunk_cache.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile::io {

Result<void> MemoryJob::prepare(const ExrWriter& writer, std::size_t slots) {
  writer_ = &writer;
  for (std::size_t i = 0; i < slots; ++i) {
    SPECTILE_ASSIGN(auto row, FloatBuffer::create(row_floats_));
    std::fill_n(row.data(), row.size(), 0.0F);
    rows_.push_back(std::move(row));
  }
  return {};
}

Result<std::shared_ptr<Strip>> MemoryJob::read(int first_line, int lines) {
  auto strip = std::make_shared<Strip>();
  strip->first_line = first_line;
  strip->lines = lines;
  strip->width = writer_->width();
  return strip;
}

std::size_t slot_count(const ImageSpec& spec, int width, int threads) {
  // Work space that a conversion may use beyond what its threads must have.
  constexpr std::size_t kBudget = std::size_t{192} << 20;
  const auto count = static_cast<std::size_t>(threads);
  if (count == 1) return 1;
  const std::size_t fitting = kBudget / std::max<std::size_t>(encoder_bytes(spec, width), 1);
  return std::clamp(fitting, count, 4 * count);
}

namespace {

// Memory for chunks that may come again.
constexpr std::size_t kCacheBytes = std::size_t{32} << 20;

struct Slot {
  std::shared_ptr<Strip> strip;
  std::shared_ptr<KnownChunk> known;  // what it becomes, or, where it is reused, what it became before
  int chunk = 0;
  bool reused = false;
  bool encoded = false;
  LineStats stats;
  std::vector<std::byte> packed;  // lines that are made already: see Run::pack_ahead()
};

class Run {
 public:
  Run(LineJob& job, ExrWriter& writer, std::size_t slots, int strip_lines, const ImageOptions& options,
      const std::function<bool(const LineStats&)>& stop_at)
      : job_(job),
        writer_(writer),
        slots_(slots),
        thin_(strip_lines < std::min(writer.lines_per_chunk(), writer.height()) &&
              writer.window(0).width() == writer.width()),
        // Whole chunks, so that none needs two strips, but where these would be too large.
        strip_lines_(thin_ ? strip_lines
                           : (strip_lines + writer.lines_per_chunk() - 1) / writer.lines_per_chunk() *
                                 writer.lines_per_chunk()),
        options_(options),
        stop_at_(stop_at),
        end_chunk_(writer.chunks()),
        cache_(kCacheBytes),
        counts_(options.skip && job.repeats() && !thin_),
        // A chunk that is not compressed costs little more than the search for it.
        caches_(counts_ && writer.compresses()) {}

  /// Leaves out all other chunks.
  void restrict_to(ChunkRange range) {
    next_chunk_ = range.first;
    end_chunk_ = range.end;
    const PixelWindow window = writer_.window(range.first);
    const auto lines = static_cast<std::uint64_t>(window.y0);
    done_ = lines * static_cast<std::uint64_t>(writer_.width());
    for (int i = 1; i <= range.first % writer_.chunks_across(); ++i) done_ += pixels_of(range.first - i);
  }

  Result<LineStats> run(int threads) {
    read_ahead_ = threads > 1;
    tiles::ordered_pipeline(
        slots_.size(), threads, [this](std::size_t slot) { return produce(slots_[slot]); },
        [this](std::size_t slot) { transform(slot); }, [this](std::size_t slot) { consume(slot); });
    if (error_) return *error_;
    return total_;
  }

 private:
  bool produce(Slot& slot) {
    if (failed_ || next_chunk_ >= end_chunk_) return false;
    const PixelWindow window = writer_.window(next_chunk_);
    slot.stats = {};
    slot.known.reset();
    slot.reused = false;
    if (thin_ ? !pack_ahead(slot, window) : !load(window.y0, window.height())) return false;
    if (!thin_) slot.strip = strip_;
    slot.chunk = next_chunk_++;
    // Here, where chunks come in order, so that which are reused depends on no thread.
    if (caches_) find_known(slot, window);
    return true;
  }

  /// Makes sure that the present strip holds these lines, which are in one.
  bool load(int first, int lines) {
    if (strip_ && strip_->holds(first, lines)) return true;
    strip_.reset();
    auto strip = next_strip(first);
    if (!strip) return fail(strip.error());
    strip_ = *std::move(strip);
    return true;
  }

  /// Makes a chunk's lines from strips of a few lines each, here where these come in order: lines so long
  /// take as long to decode as to convert, and many of them would not fit in memory.
  bool pack_ahead(Slot& slot, const PixelWindow& window) {
    const std::size_t line_bytes = writer_.line_bytes(window.width());
    slot.packed.resize(line_bytes * static_cast<std::size_t>(window.height()));
    std::byte* packed = slot.packed.data();
    for (int y = window.y0; y < window.y1; ++y, packed += line_bytes) {
      if (!load(y, 1)) return false;
      const auto index = static_cast<std::size_t>(&slot - slots_.data());
      job_.line(index, *strip_, y, stopped_ ? nullptr : packed, slot.stats);
    }
    return true;
  }

  void find_known(Slot& slot, const PixelWindow& window) {
    auto found = cache_.find(*slot.strip, window);
    slot.known = std::move(found.chunk);
    slot.reused = found.known;
  }

  /// The strip that starts at `first`, and the reading of the one after it under way.
  Result<std::shared_ptr<Strip>> next_strip(int first) {
    auto strip =
        ahead_.valid() ? ahead_.get() : job_.read(first, std::min(strip_lines_, writer_.height() - first));
    const int after = first + strip_lines_;
    if (strip && read_ahead_ && after < writer_.height()) {
      // Deferred where the system makes no thread.
      ahead_ = std::async(std::launch::async | std::launch::deferred, [this, after] {
        return job_.read(after, std::min(strip_lines_, writer_.height() - after));
      });
    }
    return strip;
  }

  void transform(std::size_t index) {
    Slot& slot = slots_[index];
    slot.encoded = false;
    if (failed_ || slot.reused) return;
    const auto start = std::chrono::steady_clock::now();
    if (counts_) slot.stats.costs.chunks = 1;
    const PixelWindow window = writer_.window(slot.chunk);
    if (!thin_ && window.width() < slot.strip->width) {
      // A tile is to its job an image of its own.
      auto tile = cut_strip(*slot.strip, window.x0, window.width(), window.y0, window.height());
      if (!tile) {
        fail(tile.error());
        return;
      }
      slot.strip = *std::move(tile);
    }
    if (thin_) {
      encode_ahead(index);
      return;
    }
    if (stopped_) {
      for (int i = 0; i < window.height(); ++i) {
        job_.line(index, *slot.strip, window.y0 + i, nullptr, slot.stats);
      }
      slot.stats = slot.stats.moved(window.x0, 0);
      if (slot.known) slot.known->stats = slot.stats;
      return;
    }
    const ExrWriter::Pack pack = [&](const PixelWindow& to, std::byte* packed) {
      for (int i = 0; i < to.height(); ++i, packed += writer_.line_bytes(to.width())) {
        job_.line(index, *slot.strip, to.y0 + i, packed, slot.stats);
      }
    };
    if (auto encoded = writer_.encode(index, slot.chunk, pack); !encoded) fail(encoded.error());
    slot.stats = slot.stats.moved(window.x0, 0);
    slot.encoded = true;
    if (slot.known && !failed_) {
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
      cache_.complete(*slot.known, writer_.encoded(index), slot.stats, took.count());
    }
    if (stop_at_(slot.stats)) stopped_ = true;
  }

  /// Encodes what pack_ahead() made.
  void encode_ahead(std::size_t index) {
    Slot& slot = slots_[index];
    if (!stopped_) {
      const int first = writer_.window(slot.chunk).y0;
      const ExrWriter::Pack pack = [&](const PixelWindow& to, std::byte* packed) {
        const std::size_t line_bytes = writer_.line_bytes(to.width());
        std::memcpy(packed, slot.packed.data() + line_bytes * static_cast<std::size_t>(to.y0 - first),
                    line_bytes * static_cast<std::size_t>(to.height()));
      };
      if (auto encoded = writer_.encode(index, slot.chunk, pack); !encoded) fail(encoded.error());
      slot.encoded = true;
    }
    if (stop_at_(slot.stats)) stopped_ = true;
  }

  void consume(std::size_t index) {
    Slot& slot = slots_[index];
    slot.strip.reset();
    if (failed_) return;
    if (slot.reused) reuse(slot);
    total_.add(slot.stats);
    if (slot.encoded && !stopped_) {
      const auto encoded =
          slot.reused ? std::span<const std::byte>(slot.known->output) : writer_.encoded(index);
      if (auto written = writer_.write(slot.chunk, encoded); !written) {
        fail(written.error());
        return;
      }
    }
    slot.known.reset();
    done_ += pixels_of(slot.chunk);
    Progress progress = writer_.progress();
    progress.pixels_done += done_;
    if (options_.progress && !options_.progress(progress)) {
      fail(make_error(ErrorCode::kCancelled, "stopped on request"));
    }
  }

  /// Chunks are consumed in order, so the one that was made of the same input is there.
  void reuse(Slot& slot) {
    const KnownChunk& known = *slot.known;
    const PixelWindow window = writer_.window(slot.chunk);
    slot.stats = known.stats.moved(window.x0 - known.window.x0, window.y0 - known.window.y0);
    slot.stats.costs = {};
    slot.stats.costs.chunks = slot.stats.costs.chunks_reused = 1;
    slot.stats.costs.reused_seconds = known.seconds;
    slot.encoded = known.encoded;
  }

  std::uint64_t pixels_of(int chunk) const {
    const PixelWindow window = writer_.window(chunk);
    return static_cast<std::uint64_t>(window.width()) * static_cast<std::uint64_t>(window.height());
  }

  bool fail(const Error& error) {
    const std::scoped_lock lock(mutex_);
    if (!error_) error_ = error;
    failed_ = true;
    return false;
  }

  LineJob& job_;
  ExrWriter& writer_;
  std::vector<Slot> slots_;
  bool thin_;
  int strip_lines_;
  const ImageOptions& options_;
  const std::function<bool(const LineStats&)>& stop_at_;
  int end_chunk_;
  ChunkCache cache_;
  bool counts_ = false;
  bool caches_ = false;
  std::shared_ptr<Strip> strip_;
  bool read_ahead_ = false;
  std::future<Result<std::shared_ptr<Strip>>> ahead_;  // its destructor waits for the reading to end
  int next_chunk_ = 0;
  std::uint64_t done_ = 0;  // pixels of the level
  LineStats total_;
  std::atomic<bool> failed_ = false;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::optional<Error> error_;
};

}  // namespace

Result<LineStats> run_conversion(LineJob& job, ExrWriter& writer, std::size_t slots, int strip_lines,
                                 const ImageOptions& options,
                                 const std::function<bool(const LineStats&)>& stop_at) {
  return Run(job, writer, slots, strip_lines, options, stop_at).run(tiles::thread_count(options.threads));
}

Result<LineStats> run_chunks(LineJob& job, ExrWriter& writer, ChunkRange range, std::size_t slots,
                             const ImageOptions& options,
                             const std::function<bool(const LineStats&)>& stop_at) {
  Run run(job, writer, slots, writer.height(), options, stop_at);
  run.restrict_to(range);
  return run.run(tiles::thread_count(options.threads));
}

Error stopped_at(const std::string& path, ErrorCode code, const char* what, const PixelCount& found,
                 const char* remedy) {
  return make_error(code, "{}: {} {} pixel{}, the first at {},{}; {}", path, found.count, what,
                    found.count == 1 ? "" : "s", found.first_x, found.first_y, remedy);
}

}  // namespace spectile::io
