// Mip levels: an output's smaller levels, filtered from what its job makes of the input, in bounded memory.
#include "src/io/convert/frame/mip_levels.hpp"

#include <algorithm>
#include <optional>

#include "src/base/errors.hpp"
#include "src/io/convert/frame/area_filter.hpp"
#include "src/lanes/tiles.hpp"
#include "src/reference/half.hpp"

namespace spectile::io {
namespace {

// Memory for levels that are made together.
constexpr std::size_t kKeptBytes = std::size_t{64} << 20;
// For the lines of the image that are averaged at once, and for a strip of a level.
constexpr std::size_t kBatchBytes = std::size_t{8} << 20;

// Samples of a batch that are worth more than one thread.
constexpr std::size_t kWorthThreads = std::size_t{1} << 18;

/// Bytes of a line of a strip, whose rows are padded to whole blocks.
std::size_t line_bytes(const std::vector<PlaneSpec>& planes, int width) {
  std::size_t bytes = 0;
  for (const PlaneSpec& plane : planes) bytes += plane.sample_bytes();
  return bytes * blocks_for(static_cast<std::size_t>(width)) * kLanesPerBlock;
}

int fitting_lines(std::size_t line_bytes, int most) {
  const std::size_t lines = kBatchBytes / std::max<std::size_t>(line_bytes, 1);
  return static_cast<int>(std::clamp<std::size_t>(lines, 1, static_cast<std::size_t>(most)));
}

template <class Sample>
void store(const double* row, std::size_t n, std::byte* out) {
  auto* const samples = reinterpret_cast<Sample*>(out);
  for (std::size_t x = 0; x < n; ++x) {
    const auto sample = static_cast<float>(row[x]);
    if constexpr (sizeof(Sample) == 2) {
      samples[x] = reference::half_from_float(sample);
    } else {
      samples[x] = sample;
    }
  }
}

/// The levels as a job: its strips are averages.
class LevelMaker : public LineJob {
 public:
  LevelMaker(FilteredJob& job, const ExrWriter& writer, std::size_t slots, int strip_lines,
             const ImageOptions& options, const std::vector<std::string>& nearest)
      : job_(job),
        writer_(writer),
        options_(options),
        image_(writer.size(0)),
        first_slot_(slots),
        workers_(filter_slots(options)),
        source_lines_(strip_lines),
        rows_(job.filtered_rows()) {
    for (const auto& [plane, spec] : job.passing()) {
      planes_.push_back(spec);
      passing_.push_back(plane);
      picked_.push_back(std::find(nearest.begin(), nearest.end(), spec.name) != nearest.end());
    }
    planes_.resize(planes_.size() + rows_, {"", SampleType::kFloat});
    stride_ = blocks_for(static_cast<std::size_t>(image_.width)) * kLanesPerBlock;
  }

  Result<void> prepare(const ExrWriter& /*writer*/, std::size_t /*slots*/) override {
    const std::size_t line = rows_ * stride_;
    // At least a line for each thread.
    batch_lines_ = std::max(fitting_lines(line * sizeof(float), 64), static_cast<int>(workers_));
    SPECTILE_ASSIGN(batch_, FloatBuffer::create(line * static_cast<std::size_t>(batch_lines_)));
    return {};
  }

  /// Lines of the present level's strips.
  int strip_lines(int /*chunk_lines*/) const override {
    return fitting_lines(line_bytes(planes_, writer_.width()), 256);
  }

  /// Goes on to the writer's present level.
  Result<void> begin() {
    const int level = writer_.level();
    if (kept_from_ > 0) return {};
    const bool keep = bytes_from(level) <= kKeptBytes;
    tree_.emplace(image_, level, keep ? writer_.levels() - level : 1);
    filters_.clear();
    for (std::size_t i = 0; i < planes_.size(); ++i) filters_.emplace_back(*tree_);
    next_ = 0;
    targets_.clear();
    if (!keep) return {};
    kept_from_ = level;
    for (const LevelTree::Level& one : tree_->levels()) {
      SPECTILE_ASSIGN(auto strip, make_strip(planes_, one.size.width, 0, one.size.height));
      targets_.push_back(std::move(strip));
    }
    return advance(image_.height, true);
  }

  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    if (kept_from_ > 0) return targets_[static_cast<std::size_t>(writer_.level() - kept_from_)];
    SPECTILE_ASSIGN(auto strip, make_strip(planes_, writer_.width(), first_line, lines));
    targets_ = {strip};
    SPECTILE_TRY(advance(lines_needed(image_.height, writer_.height(), first_line + lines), false));
    targets_.clear();
    return strip;
  }

  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed,
            LineStats& /*stats*/) override {
    if (packed != nullptr) job_.level_line(slot, strip, line, packed);
  }

  bool repeats() const override { return job_.repeats(); }

 private:
  std::size_t bytes_from(int level) const {
    std::size_t bytes = 0;
    for (; level < writer_.levels(); ++level) {
      const LevelSize size = writer_.size(level);
      bytes += line_bytes(planes_, size.width) * static_cast<std::size_t>(size.height);
    }
    return bytes;
  }

  /// Takes the image's lines before `end`. Progress is told where nobody else tells it meanwhile.
  Result<void> advance(int end, bool tells) {
    while (next_ < end) {
      if (!source_ || !source_->holds(next_, 1)) {
        source_.reset();
        SPECTILE_ASSIGN(source_, job_.read(next_, std::min(source_lines_, image_.height - next_)));
        if (tells && options_.progress && !options_.progress(writer_.progress())) {
          return make_error(ErrorCode::kCancelled, "stopped on request");
        }
      }
      const int lines = std::min({batch_lines_, source_->first_line + source_->lines - next_, end - next_});
      take(lines);
      next_ += lines;
    }
    if (next_ == image_.height) source_.reset();
    return {};
  }

  /// First the rows of all lines, side by side; then each plane's averages, in the order of the lines.
  void take(int lines) {
    // Of narrow images, batches are worth no threads: starting them took most of the time, and memory.
    const std::size_t samples = static_cast<std::size_t>(lines) * stride_ * planes_.size();
    const Execution execution = {samples < kWorthThreads ? 1 : options_.threads, 1};
    tiles::for_blocks(workers_, execution, [&](std::size_t first, std::size_t count) {
      for (std::size_t w = first; w < first + count; ++w) {
        const auto part = [&](std::size_t i) {
          return static_cast<int>(i * static_cast<std::size_t>(lines) / workers_);
        };
        std::vector<float*> rows(rows_);
        for (int i = part(w); i < part(w + 1); ++i) {
          for (std::size_t r = 0; r < rows_; ++r) rows[r] = batch_row(i, r);
          job_.filter_rows(first_slot_ + w, *source_, next_ + i, rows.data());
        }
      }
    });
    tiles::for_blocks(planes_.size(), execution, [&](std::size_t first, std::size_t count) {
      for (std::size_t p = first; p < first + count; ++p) {
        for (int i = 0; i < lines; ++i) take(p, i);
      }
    });
  }

  void take(std::size_t plane, int i) {
    const int y = next_ + i;
    const AreaFilter::Emit emit = [&](std::size_t level, int line, const double* row) {
      Strip& target = *targets_[level];
      const auto width = static_cast<std::size_t>(target.width);
      std::byte* const out = target.row(plane, line);
      planes_[plane].type == SampleType::kHalf ? store<std::uint16_t>(row, width, out)
                                               : store<float>(row, width, out);
    };
    if (plane >= passing_.size()) {
      filters_[plane].add(y, static_cast<const float*>(batch_row(i, plane - passing_.size())), emit);
      return;
    }
    const std::byte* const row = source_->row(passing_[plane], y);
    if (picked_[plane]) {
      return planes_[plane].type == SampleType::kHalf
                 ? pick(plane, y, reinterpret_cast<const std::uint16_t*>(row))
                 : pick(plane, y, reinterpret_cast<const std::uint32_t*>(row));
    }
    switch (planes_[plane].type) {
      case SampleType::kHalf:
        return filters_[plane].add(y, reinterpret_cast<const std::uint16_t*>(row), emit);
      case SampleType::kFloat:
        return filters_[plane].add(y, reinterpret_cast<const float*>(row), emit);
      default:
        return pick(plane, y, reinterpret_cast<const std::uint32_t*>(row));
    }
  }

  /// Names of objects have no averages. Sample: as many bits.
  template <class Sample>
  void pick(std::size_t plane, int y, const Sample* row) {
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      const LevelSize size = tree_->levels()[i].size;
      const auto before = static_cast<int>(std::int64_t{y} * size.height / image_.height);
      for (int line = before; line < std::min(before + 2, size.height); ++line) {
        if (nearest(image_.height, size.height, line) != y) continue;
        auto* const out = reinterpret_cast<Sample*>(targets_[i]->row(plane, line));
        for (int x = 0; x < size.width; ++x) out[x] = row[nearest(image_.width, size.width, x)];
      }
    }
  }

  float* batch_row(int i, std::size_t row) {
    return batch_.data() + (static_cast<std::size_t>(i) * rows_ + row) * stride_;
  }

  FilteredJob& job_;
  const ExrWriter& writer_;
  const ImageOptions& options_;
  LevelSize image_;
  std::size_t first_slot_;
  std::size_t workers_;
  int source_lines_;
  std::size_t rows_;
  std::vector<PlaneSpec> planes_;     // of a level's strips
  std::vector<std::size_t> passing_;  // planes of the image's strips
  std::vector<bool> picked_;          // of these
  std::size_t stride_ = 0;
  FloatBuffer batch_;  // [line][row][x]
  int batch_lines_ = 1;
  int kept_from_ = 0;  // level; 0 where none is kept yet
  std::optional<LevelTree> tree_;
  std::vector<AreaFilter> filters_;
  std::vector<std::shared_ptr<Strip>> targets_;  // one for each level of the tree
  std::shared_ptr<Strip> source_;
  int next_ = 0;  // line of the image
};

}  // namespace

std::size_t filter_slots(const ImageOptions& options) {
  return options.mipmap ? static_cast<std::size_t>(tiles::thread_count(options.threads)) : 0;
}

std::vector<std::string> nearest_channels(const FilteredJob& job, const PartHeader& source) {
  const std::vector<std::string> ids = source.object_ids();
  std::vector<std::string> out;
  for (const auto& [plane, spec] : job.passing()) {
    const StoredChannel* const stored = source.find(spec.name);
    // Integers that are read as numbers are a colour's.
    const bool number = stored == nullptr || stored->type == SampleType::kUint32;
    const bool names = !number && std::find(ids.begin(), ids.end(), spec.name) != ids.end();
    if (names || spec.type == SampleType::kUint32) out.push_back(spec.name);
  }
  return out;
}

std::optional<std::array<int, 2>> tiles_of(const ImageOptions& options) {
  // Of OpenEXR's own mip-mapped samples, and of other tools that make textures.
  constexpr std::array kUsual = {64, 64};
  if (options.mipmap && !options.tile) return kUsual;
  return options.tile;
}

Result<void> write_levels(FilteredJob& job, ExrWriter& writer, std::size_t slots, int strip_lines,
                          const ImageOptions& options, const std::vector<std::string>& nearest) {
  LevelMaker maker(job, writer, slots, strip_lines, options, nearest);
  SPECTILE_TRY(maker.prepare(writer, slots));
  for (int level = 1; level < writer.levels(); ++level) {
    writer.begin_level(level);
    SPECTILE_TRY(maker.begin());
    const auto run = run_conversion(maker, writer, slots, maker.strip_lines(writer.lines_per_chunk()),
                                    options, [](const LineStats&) { return false; });
    if (!run) return run.error();
  }
  return {};
}

}  // namespace spectile::io
