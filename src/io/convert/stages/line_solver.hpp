// LineSolver: from a line's RGB to a method's coefficients, without doing anything twice.
#pragma once

#include <memory>
#include <optional>
#include <spectile/image/image.hpp>
#include <vector>

#include "kernels/abi.hpp"
#include "src/io/convert/stages/band_channels.hpp"
#include "src/io/convert/stages/color_runs.hpp"
#include "src/io/convert/stages/color_stage.hpp"
#include "src/upsampling/color_table.hpp"

namespace spectile::io {

class LineSolver {
 public:
  /// Work space of one slot.
  struct Work {
    ColorLine coefficients;  // of no rows where they are the RGB
    FloatBuffer scale;       // of the method, or, where lines come with scales, those
    std::vector<std::uint64_t> unsolved;
    std::vector<std::uint8_t> outside;
    std::optional<rows::ColorTable::Batch> batch;
    std::vector<ColorRun> runs;  // of the last line; one that is all computed where nothing is skipped
  };

  /// All must outlive it. `pixels`: of the image. `scaled`: lines are straight colours, whose scales lie in
  /// the work space; for methods that have no scale of their own.
  LineSolver(const ColorStage& stage, const Upsampler& upsampler, const kernels::KernelTable& kernels,
             bool skip, std::uint64_t pixels, bool scaled = false);

  /// Errors: kOutOfMemory.
  Result<Work> work(int width) const;

  /// Coefficients of a sanitized line, in the slot's work space or the line itself.
  LineCoefficients line(Work& work, const ColorLine& rgb, std::size_t width, int line, bool may_be_outside,
                        LineStats& stats) const;

 private:
  void whole(Work& work, const ColorLine& rgb, std::size_t width, int line, bool may_be_outside,
             LineStats& stats) const;
  void by_runs(Work& work, const ColorLine& rgb, std::size_t width, int line, LineStats& stats) const;
  void solve_by_table(Work& work, const ColorLine& rgb, int line, LineStats& stats) const;
  void solve_run(Work& work, const ColorLine& rgb, const ColorRun& run, int line, LineStats& stats) const;
  rows::Coefficients at(Work& work, std::size_t first) const;
  void fill(Work& work, const ColorRun& run) const;

  const ColorStage& stage_;
  const Upsampler& upsampler_;
  const kernels::KernelTable& kernels_;
  bool stores_rgb_ = false;
  bool skip_ = false;
  bool scaled_ = false;
  std::unique_ptr<rows::ColorTable> table_;  // null for methods whose coefficients are the RGB
  float black_[4] = {0, 0, 0, 0};
};

}  // namespace spectile::io
