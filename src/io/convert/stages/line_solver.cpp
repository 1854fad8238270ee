// LineSolver: from a line's RGB to a method's coefficients, without doing anything twice.
#include "src/io/convert/stages/line_solver.hpp"

#include <algorithm>
#include <chrono>

#include "src/base/errors.hpp"

namespace spectile::io {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

LineSolver::LineSolver(const ColorStage& stage, const Upsampler& upsampler,
                       const kernels::KernelTable& kernels, bool skip, std::uint64_t pixels, bool scaled)
    : stage_(stage),
      upsampler_(upsampler),
      kernels_(kernels),
      stores_rgb_(rows::stores_rgb(upsampler)),
      skip_(skip),
      scaled_(scaled) {
  if (stores_rgb_ || !skip) return;
  table_ = std::make_unique<rows::ColorTable>(kernels, upsampler, stage.out_of_gamut(), pixels);
  alignas(64) float rows[4][kLanesPerBlock] = {};
  std::uint64_t unsolved = 0;
  const float* const rgb[3] = {rows[0], rows[1], rows[2]};
  float* const scale = rows::has_scale(upsampler) ? rows[3] : nullptr;
  rows::solve(kernels, upsampler, rgb, {{rows[0], rows[1], rows[2]}, scale}, &unsolved, kLanesPerBlock);
  for (std::size_t k = 0; k < 4; ++k) black_[k] = rows[k][0];
}

Result<LineSolver::Work> LineSolver::work(int width) const {
  Work work;
  const std::size_t padded = blocks_for(static_cast<std::size_t>(width)) * kLanesPerBlock;
  if (scaled_ || !stores_rgb_) {
    SPECTILE_ASSIGN(work.scale, FloatBuffer::create(padded));
  }
  if (stores_rgb_) return work;
  SPECTILE_ASSIGN(work.coefficients, ColorLine::create(width));
  work.unsolved.resize(padded / kLanesPerBlock);
  work.outside.resize(padded);
  if (table_) {
    SPECTILE_ASSIGN(work.batch, rows::ColorTable::Batch::create(padded));
  }
  return work;
}

LineCoefficients LineSolver::line(Work& work, const ColorLine& rgb, std::size_t width, int line,
                                  bool may_be_outside, LineStats& stats) const {
  if (!skip_) {
    work.runs = {{ColorRun::Kind::kComputed, 0, width}};
    whole(work, rgb, width, line, may_be_outside, stats);
  } else {
    // Methods whose coefficients are the RGB clip a line quicker than its colours can be looked up.
    if (stores_rgb_ && may_be_outside) stage_.clip_to_gamut(line, rgb, width, stats);
    const FoundRuns found = find_runs(rgb.rows, scaled_ ? work.scale.data() : nullptr, width, work.runs);
    stats.black += found.black;
    stats.constant += found.constant;
    if (!stores_rgb_) by_runs(work, rgb, width, line, stats);
  }
  if (stores_rgb_) return {{rgb.rows[0], rgb.rows[1], rgb.rows[2]}, scaled_ ? work.scale.data() : nullptr};
  const rows::Coefficients out = at(work, 0);
  return {{out.c[0], out.c[1], out.c[2]}, scaled_ ? work.scale.data() : out.scale};
}

rows::Coefficients LineSolver::at(Work& work, std::size_t first) const {
  float* const* c = work.coefficients.rows;
  return {{c[0] + first, c[1] + first, c[2] + first},
          rows::has_scale(upsampler_) ? work.scale.data() + first : nullptr};
}

void LineSolver::whole(Work& work, const ColorLine& rgb, std::size_t width, int line, bool may_be_outside,
                       LineStats& stats) const {
  if (may_be_outside) stage_.clip_to_gamut(line, rgb, width, stats);
  if (!stores_rgb_)
    rows::solve(kernels_, upsampler_, rgb.rows, at(work, 0), work.unsolved.data(), rgb.padded);
}

void LineSolver::by_runs(Work& work, const ColorLine& rgb, std::size_t width, int line,
                         LineStats& stats) const {
  if (table_->worth_while(*work.batch)) {
    solve_by_table(work, rgb, line, stats);
  } else {
    for (const ColorRun& run : work.runs) {
      if (run.kind != ColorRun::Kind::kBlack) solve_run(work, rgb, run, line, stats);
    }
  }
  for (const ColorRun& run : work.runs) fill(work, run);
  const rows::Coefficients out = at(work, 0);
  // Kernels read whole blocks.
  for (float* const row : out.c) std::fill(row + width, row + rgb.padded, 0.0F);
  if (out.scale != nullptr) std::fill(out.scale + width, out.scale + rgb.padded, 0.0F);
}

void LineSolver::solve_by_table(Work& work, const ColorLine& rgb, int line, LineStats& stats) const {
  rows::ColorTable::Batch& batch = *work.batch;
  const auto start = Clock::now();
  rows::ColorTable::clear(batch);
  const std::uint64_t looked_up = batch.looked_up;
  const double solved_before = batch.solving_seconds;
  const std::uint64_t solved = batch.solved;
  const std::uint64_t lanes_solved = batch.lanes_solved;
  const auto lanes = [](const ColorRun& run) {
    return run.kind == ColorRun::Kind::kConstant ? std::size_t{1} : run.pixels;
  };
  for (const ColorRun& run : work.runs) {
    if (run.kind == ColorRun::Kind::kBlack) continue;
    const float* const from[3] = {rgb.rows[0] + run.first, rgb.rows[1] + run.first, rgb.rows[2] + run.first};
    table_->add(batch, from, lanes(run));
  }
  table_->solve(batch);
  const double solving_seconds = batch.solving_seconds - solved_before;
  std::size_t lane = 0;
  for (const ColorRun& run : work.runs) {
    if (run.kind == ColorRun::Kind::kBlack) continue;
    table_->take(batch, lane, lanes(run), at(work, run.first), work.outside.data() + run.first);
    lane += lanes(run);
    if (run.kind == ColorRun::Kind::kConstant) {
      std::fill_n(work.outside.data() + run.first, run.pixels, work.outside[run.first]);
    }
    for (std::size_t x = run.first; x < run.first + run.pixels; ++x) {
      if (work.outside[x] != 0) stats.outside.add(1, static_cast<int>(x), line);
    }
  }
  SkipCosts& costs = stats.costs;
  costs.colors_looked_up += batch.looked_up - looked_up;
  costs.colors_solved += batch.solved - solved;
  costs.lanes_solved += batch.lanes_solved - lanes_solved;
  costs.solving_seconds += solving_seconds;
  costs.lookup_seconds += seconds_since(start) - solving_seconds;
}

void LineSolver::solve_run(Work& work, const ColorLine& rgb, const ColorRun& run, int line,
                           LineStats& stats) const {
  const std::size_t first = run.first;
  const bool constant = run.kind == ColorRun::Kind::kConstant;
  // A constant run's first block stands for all of it.
  const std::size_t n = constant ? std::min(run.pixels, kLanesPerBlock) : run.pixels;
  float* const from[3] = {rgb.rows[0] + first, rgb.rows[1] + first, rgb.rows[2] + first};
  const GamutReport found = rows::gamut_clip(kernels_, upsampler_, from, stage_.out_of_gamut(), n);
  if (found.outside > 0) {
    stats.outside.add(constant ? run.pixels : found.outside,
                      static_cast<int>(first) + static_cast<int>(found.first), line);
  }
  rows::solve(kernels_, upsampler_, from, at(work, first), work.unsolved.data(),
              blocks_for(n) * kLanesPerBlock);
}

void LineSolver::fill(Work& work, const ColorRun& run) const {
  if (run.kind == ColorRun::Kind::kComputed) return;
  const rows::Coefficients out = at(work, run.first);
  const bool black = run.kind == ColorRun::Kind::kBlack;
  for (std::size_t k = 0; k < 3; ++k) std::fill_n(out.c[k], run.pixels, black ? black_[k] : out.c[k][0]);
  if (out.scale != nullptr) std::fill_n(out.scale, run.pixels, black ? black_[3] : out.scale[0]);
}

}  // namespace spectile::io
