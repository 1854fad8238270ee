// ConvertJob: spectral samples under other names, in other bands and units, line by line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <spectile/image/image.hpp>
#include <string>
#include <utility>
#include <vector>

#include "src/io/convert/frame/mip_levels.hpp"
#include "src/io/convert/sources/sets_source.hpp"

namespace spectile::io {

/// An output channel: the sum of weights[i] * plane[first + i] of the source's strips. One weight of 1 keeps
/// every bit.
struct SampleSum {
  ChannelSpec channel;
  std::size_t first = 0;
  std::vector<float> weights;
};

class ConvertJob : public FilteredJob {
 public:
  /// All references must outlive it.
  ConvertJob(SetsSource& source, std::vector<SampleSum> sums, const ImageOptions& options,
             const kernels::KernelTable& kernels);

  /// Output channels: the sums, then those that pass through.
  std::vector<ChannelSpec> channels() const;

  Result<void> prepare(const ExrWriter& writer, std::size_t slots) override;
  int strip_lines(int chunk_lines) const override { return source_.strip_lines(chunk_lines); }
  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override {
    return source_.read(first_line, lines);
  }
  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override;
  std::vector<PlaneSpec> strip_planes() const override { return source_.planes(); }
  std::vector<std::pair<std::size_t, PlaneSpec>> passing() const override;
  std::size_t filtered_rows() const override { return sums_.size(); }
  void filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) override;
  void level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) override;

 private:
  /// Work space of one slot.
  struct Work {
    FloatBuffer block;         // [sample][64]
    FloatBuffer rows;          // [channel][x]
    std::vector<float*> each;  // row of each channel
    FloatBuffer halves;
  };
  void make_rows(Work& work, const Strip& strip, int line, float* const* rows, LineStats& stats) const;
  void make_block(const float* block, std::size_t at, float* const* rows) const;
  std::uint64_t pack(Work& work, std::size_t width, std::byte* packed) const;
  void pass(const Strip& strip, int line, std::size_t first_plane, std::byte* packed) const;
  std::size_t passing_count() const { return source_.planes().size() - source_.samples(); }

  SetsSource& source_;
  const std::vector<SampleSum> sums_;
  const ImageOptions& options_;
  const kernels::KernelTable& kernels_;
  const ExrWriter* writer_ = nullptr;
  std::vector<Work> works_;
};

}  // namespace spectile::io
