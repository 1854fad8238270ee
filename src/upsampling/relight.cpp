// A texture's colour under another light, without its spectra.
#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"
#include "src/color/color_matrix.hpp"
#include "src/color/kernel_tables.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"
#include "src/upsampling/grid/color_grid.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace spectile {
namespace {

using kernels::kSmitsRow;

constexpr double kRounding = 0x1p-24;

}  // namespace

Result<Relighter> Relighter::create(const Upsampler& upsampler, const Projector& under, const Matrix3& to) {
  SPECTILE_TRY(shape::same_bands("the projector", under.bands(), upsampler.bands()));
  if (upsampler.quantity() == Quantity::kIlluminant) {
    return make_error(ErrorCode::kBadArgument, "only reflectances can be relit, not light");
  }
  Relighter out;
  out.upsampler_ = std::make_shared<const Upsampler>(upsampler);
  out.projector_ = std::make_shared<const Projector>(under);
  out.matrix_ = to;
  if (!rows::stores_rgb(upsampler)) return out;
  if (!rows::mixes_bases(upsampler)) {
    SPECTILE_TRY(out.fold_grid());
    return out;
  }
  SPECTILE_ASSIGN(auto table, FloatBuffer::create(3 * kSmitsRow));
  std::fill_n(table.data(), table.size(), 0.0F);
  const auto weights = under.weights();
  const auto basis = upsampler.basis();
  const std::size_t bands = weights.size();
  double magnitude[3] = {};  // of what a component is the sum of, at most
  double clamped[3] = {};    // what clamping of samples adds at most
  for (std::size_t j = 0; j < 7; ++j) {
    double sum[3] = {};
    double size[3] = {};
    double below[3] = {};
    for (std::size_t b = 0; b < bands; ++b) {
      const std::array<double, 3> w = times(to, weights[b]);
      for (std::size_t k = 0; k < 3; ++k) {
        double terms = 0;
        for (std::size_t i = 0; i < 3; ++i) terms += std::abs(to[3 * k + i]) * weights[b][i];
        sum[k] += w[k] * basis[b][j];
        size[k] += terms * std::abs(basis[b][j]);
        if (std::isfinite(upsampler.lowest())) below[k] += terms * std::max(0.0, -basis[b][j]);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      table.data()[k * kSmitsRow + j] = static_cast<float>(sum[k]);
      magnitude[k] = std::max(magnitude[k], size[k]);
      clamped[k] = std::max(clamped[k], below[k]);
    }
  }
  out.table_ = std::make_shared<const FloatBuffer>(std::move(table));
  // Through spectra: the table, three products and two sums a sample; a weight, a product and the runs of
  // sums; a matrix of four roundings. Directly: as many as a sample. The weights sum to the largest
  // component.
  const double roundings =
      6 + 2 + kernels::kSumRun + static_cast<double>(bands) / kernels::kSumRun + 1 + 4 + 6;
  for (std::size_t k = 0; k < 3; ++k) out.bound_[k] = roundings * kRounding * magnitude[k] + clamped[k];
  return out;
}

Result<void> Relighter::fold_grid() {
  const GridModel& model = *UpsamplerAccess::grid(*upsampler_);
  std::vector<std::array<double, 3>> weights;
  for (const auto& w : projector_->weights()) weights.push_back(times(matrix_, w));
  SPECTILE_ASSIGN(grid_, folded_grid(model, weights));
  const std::size_t bands = weights.size();
  // Through spectra: four products, three sums and a weight of three roundings a sample; then as for bases.
  const double roundings =
      10 + 2 + kernels::kSumRun + static_cast<double>(bands) / kernels::kSumRun + 1 + 4 + 10;
  for (std::size_t k = 0; k < 3; ++k) {
    double largest = 0;
    for (std::size_t i = 0; i < kNodes; ++i) {
      double size = 0;
      for (std::size_t b = 0; b < bands; ++b) {
        double terms = 0;
        for (std::size_t j = 0; j < 3; ++j)
          terms += std::abs(matrix_[3 * k + j]) * projector_->weights()[b][j];
        size += terms * model.grid.node(i)[b];
      }
      largest = std::max(largest, size);
    }
    bound_[k] = roundings * kRounding * largest;
  }
  return {};
}

namespace rows {

void relight(const kernels::KernelTable& kernels, const Relighter& relighter, const float* const rgb[3],
             float* const out[3], std::size_t n, const float* scale) {
  const Upsampler& upsampler = relighter.upsampler();
  if (mixes_bases(upsampler)) {
    const float* const table = RelighterAccess::table(relighter);
    if (upsampler.method() == Method::kMallett) {
      float matrix[9];
      for (std::size_t k = 0; k < 9; ++k) matrix[k] = table[k / 3 * kSmitsRow + 4 + k % 3];
      kernels.transform3(out, rgb, matrix, n);
    } else {
      kernels.smits_fold(out, rgb, table, n);
    }
    return;
  }
  if (stores_rgb(upsampler)) {
    kernels.grid_fold(out, folded_spectra(relighter, rgb, scale), n);
    return;
  }
  alignas(64) float c[3][rows::kChunk];
  alignas(64) float scales[rows::kChunk];
  std::uint64_t unsolved[rows::kChunk / kernels::kLanes];
  const Coefficients found = {{c[0], c[1], c[2]}, has_scale(upsampler) ? scales : nullptr};
  const float* const read[3] = {c[0], c[1], c[2]};
  const Projector& projector = relighter.projector();
  const std::array<float, 9> matrix = color::to_float(relighter.matrix());
  const kernels::SigmoidTable& sigmoids = UpsamplerAccess::sigmoid(upsampler)->table;
  kernels::SigmoidSpectra spectra = {read,  found.scale,  sigmoids.rows, projector.bands().count(),
                                     false, sigmoids.form};
  for (std::size_t at = 0; at < n; at += rows::kChunk) {
    const std::size_t lanes = std::min(rows::kChunk, n - at);
    const float* const in[3] = {rgb[0] + at, rgb[1] + at, rgb[2] + at};
    float* const to[3] = {out[0] + at, out[1] + at, out[2] + at};
    const float* const xyz[3] = {to[0], to[1], to[2]};
    solve(kernels, upsampler, in, found, unsolved, lanes);
    if (scale != nullptr) spectra.scale = scale + at;
    kernels.sigmoid_project(to, spectra, ProjectorAccess::weights(projector), lanes);
    kernels.transform3(to, xyz, matrix.data(), lanes);
  }
}

void relight_by_spectra(const kernels::KernelTable& kernels, const Relighter& relighter,
                        const float* const rgb[3], float* const out[3], float* spectra, std::size_t n,
                        const float* scale) {
  const Upsampler& upsampler = relighter.upsampler();
  const Projector& projector = relighter.projector();
  const std::array<float, 9> matrix = color::to_float(relighter.matrix());
  alignas(64) float c[3][kernels::kLanes];
  alignas(64) float scales[kernels::kLanes];
  const Coefficients found = {{c[0], c[1], c[2]}, has_scale(upsampler) ? scales : nullptr};
  const float* const read[3] = {c[0], c[1], c[2]};
  for (std::size_t at = 0; at < n; at += kernels::kLanes) {
    const float* const in[3] = {rgb[0] + at, rgb[1] + at, rgb[2] + at};
    float* const to[3] = {out[0] + at, out[1] + at, out[2] + at};
    const float* const xyz[3] = {to[0], to[1], to[2]};
    std::uint64_t unsolved = 0;
    solve(kernels, upsampler, in, found, &unsolved, kernels::kLanes);
    const float* const factors = scale != nullptr ? scale + at : found.scale;
    expand_blocks(kernels, upsampler, read, factors, spectra, 1, false);
    kernels.project(to, spectra, ProjectorAccess::weights(projector), projector.bands().count(), 1);
    kernels.transform3(to, xyz, matrix.data(), kernels::kLanes);
  }
}

}  // namespace rows

Result<void> relight(const Relighter& relighter, ColorView rgb, ColorSpan out, const Execution& execution) {
  SPECTILE_TRY(shape::same_lanes(rgb.lanes, out.lanes));
  SPECTILE_TRY(shape::aligned(rgb));
  SPECTILE_TRY(shape::aligned(out));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  tiles::for_blocks(blocks_for(rgb.lanes), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    const float* const in[3] = {rgb.c[0] + at, rgb.c[1] + at, rgb.c[2] + at};
    float* const to[3] = {out.c[0] + at, out.c[1] + at, out.c[2] + at};
    rows::relight(*table, relighter, in, to, count * kLanesPerBlock);
  });
  return {};
}

}  // namespace spectile
