// SpectraJob: rows of spectra in memory as lines of a spectral image, with preview and alpha.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <spectile/color/colorimetry.hpp>
#include <utility>
#include <vector>

#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/write/spectra_rows.hpp"

namespace spectile::io {

/// Lines as they are packed, of rows that no chunk is complete of.
class KeptLines {
 public:
  /// At most so many bytes are added from now on.
  void reserve(std::size_t bytes) { max_bytes_ = bytes; }
  /// The place of the line after the last. Lines are added in order.
  std::byte* add(int line, std::size_t line_bytes);
  bool holds(int line) const noexcept { return range_.holds(line); }
  const std::byte* line(int line) const;
  void clear() noexcept { range_ = {}; }

 private:
  RowRange range_;
  std::size_t line_bytes_ = 0;
  std::size_t max_bytes_ = 0;
  std::vector<std::byte> bytes_;
};

class SpectraJob : public FilteredJob {
 public:
  /// `preview`: makes R, G, B where it is given. The kernels must outlive the job.
  SpectraJob(int width, const Bands& bands, const SpectralImageOptions& options,
             std::optional<Projector> preview, const kernels::KernelTable& kernels);

  /// Output channels: the bands, A, then R, G, B.
  const std::vector<ChannelSpec>& channels() const noexcept { return channels_; }

  /// The rows that lines are made of from now on; they must stay where they are while any is made.
  void take(const SpectraRows& rows) { rows_ = rows; }
  /// At most so many lines are kept at a time.
  void keep_at_most(std::size_t lines) { kept_.reserve(lines * writer_->line_bytes(width_)); }
  /// Makes a line of these rows now, and keeps it. In order; not beside any other call.
  void keep(int line, LineStats& stats);
  /// Forgets the lines that were kept. They were counted when they were made.
  void drop_kept() noexcept { kept_.clear(); }

  Result<void> prepare(const ExrWriter& writer, std::size_t slots) override;
  int strip_lines(int /*chunk_lines*/) const override { return writer_->size(0).height; }
  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override;
  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override;
  std::vector<PlaneSpec> strip_planes() const override { return {}; }
  std::vector<std::pair<std::size_t, PlaneSpec>> passing() const override { return {}; }
  std::size_t filtered_rows() const override { return channels_.size(); }
  void filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) override;
  void level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) override;

 private:
  /// Work space of one slot.
  struct Work {
    FloatBuffer block;         // [band][64]
    FloatBuffer rows;          // [channel][x]
    std::vector<float*> each;  // row of each channel
    FloatBuffer halves;
  };
  /// Pixels of a line.
  struct Part {
    int line = 0;
    std::size_t x = 0;
    std::size_t width = 0;
  };
  void make_rows(Work& work, const Part& part, float* const* rows, LineStats& stats) const;
  void add_preview(Work& work, std::size_t width, float* const* rows) const;
  std::uint64_t pack(Work& work, std::size_t width, std::byte* packed) const;

  int width_;
  std::size_t bands_;
  SampleType pixel_;
  NonFinite nonfinite_;
  std::optional<Projector> preview_;
  std::array<float, 9> to_srgb_{};
  const kernels::KernelTable& kernels_;
  std::vector<ChannelSpec> channels_;
  const ExrWriter* writer_ = nullptr;
  std::vector<Work> works_;
  SpectraRows rows_;
  KeptLines kept_;
};

}  // namespace spectile::io
