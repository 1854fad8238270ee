// FittedJob: a job's output cut, or filled up, to another window than its source's.
#pragma once

#include <utility>
#include <vector>

#include "src/io/convert/frame/mip_levels.hpp"

namespace spectile::io {

/// Readers of mip levels take every level for all of the display window, so with levels the data window has
/// to be that. Pixels that the source does not have are the job's padding; those outside are left out.
class FittedJob : public FilteredJob {
 public:
  /// The source's data window becomes `to`; the job must outlive this one.
  FittedJob(FilteredJob& job, const PixelWindow& from, const PixelWindow& to)
      : job_(job), from_(from), to_(to) {}

  Result<void> prepare(const ExrWriter& writer, std::size_t slots) override {
    return job_.prepare(writer, slots);
  }
  int strip_lines(int chunk_lines) const override;
  Result<std::shared_ptr<Strip>> read(int first_line, int lines) override;
  void line(std::size_t slot, const Strip& strip, int line, std::byte* packed, LineStats& stats) override {
    job_.line(slot, strip, line, packed, stats);
  }
  bool repeats() const override { return job_.repeats(); }
  std::vector<PlaneSpec> strip_planes() const override { return job_.strip_planes(); }
  std::vector<std::pair<std::size_t, PlaneSpec>> passing() const override { return job_.passing(); }
  std::size_t filtered_rows() const override { return job_.filtered_rows(); }
  void filter_rows(std::size_t slot, const Strip& strip, int line, float* const* rows) override {
    job_.filter_rows(slot, strip, line, rows);
  }
  void level_line(std::size_t slot, const Strip& strip, int line, std::byte* packed) override {
    job_.level_line(slot, strip, line, packed);
  }

 private:
  FilteredJob& job_;
  PixelWindow from_;
  PixelWindow to_;
};

}  // namespace spectile::io
