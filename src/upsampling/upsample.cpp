// Upsampling of batches: colours to coefficients, coefficients to spectra.
#include <algorithm>
#include <spectile/color/colorimetry.hpp>
#include <spectile/upsampling/upsample.hpp>

#include "src/color/color_matrix.hpp"
#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"
#include "src/upsampling/method_rows.hpp"

namespace spectile {
namespace {

static_assert(kLanesPerBlock == kernels::kLanes);

// Larger batches are written with non-temporal stores: cached, they would only evict other data.
constexpr std::size_t kStreamingBytes = std::size_t{64} << 20;

/// Coefficients of a chunk.
struct Chunk {
  alignas(64) float c[3][rows::kChunk];
  alignas(64) float scale[rows::kChunk];
  std::uint64_t unsolved[rows::kChunk / kLanesPerBlock];
};

Result<void> check(const Upsampler& upsampler, const ColorView& in, const SampledSpectraSpan& spectra) {
  SPECTILE_TRY(shape::same_bands("the upsampler", upsampler.bands(), spectra.axis));
  SPECTILE_TRY(shape::same_lanes(in.lanes, spectra.lanes));
  SPECTILE_TRY(shape::aligned(spectra.data));
  return shape::aligned(in);
}

bool streams(StoreHint hint, const SampledSpectraSpan& spectra) {
  const std::size_t bytes = SampledSpectraView(spectra).floats() * sizeof(float);
  return hint == StoreHint::kStreaming || (hint == StoreHint::kAuto && bytes > kStreamingBytes);
}

/// Runs a tile of blocks through a matrix, where there is one, and the method.
void upsample_tile(const kernels::KernelTable& table, const Upsampler& upsampler, const ColorView& in,
                   const float* matrix, float* spectra, std::size_t first, std::size_t count, bool stream) {
  const std::size_t bands = upsampler.bands().count();
  if (rows::stores_rgb(upsampler) && matrix == nullptr) {
    const std::size_t at = first * kLanesPerBlock;
    const float* const rgb[3] = {in.c[0] + at, in.c[1] + at, in.c[2] + at};
    rows::expand_blocks(table, upsampler, rgb, nullptr, spectra + at * bands, count, stream);
    return;
  }
  Chunk chunk;
  float* const c[3] = {chunk.c[0], chunk.c[1], chunk.c[2]};
  const float* const read[3] = {chunk.c[0], chunk.c[1], chunk.c[2]};
  const rows::Coefficients out = {{c[0], c[1], c[2]}, rows::has_scale(upsampler) ? chunk.scale : nullptr};
  for (std::size_t block = first; block < first + count; block += rows::kChunk / kLanesPerBlock) {
    const std::size_t blocks = std::min(rows::kChunk / kLanesPerBlock, first + count - block);
    const std::size_t at = block * kLanesPerBlock;
    const float* const source[3] = {in.c[0] + at, in.c[1] + at, in.c[2] + at};
    if (matrix != nullptr) table.transform3(c, source, matrix, blocks * kLanesPerBlock);
    rows::solve(table, upsampler, matrix != nullptr ? read : source, out, chunk.unsolved,
                blocks * kLanesPerBlock);
    rows::expand_blocks(table, upsampler, read, out.scale, spectra + at * bands, blocks, stream);
  }
}

Result<void> run(const Upsampler& upsampler, const ColorView& in, const float* matrix,
                 const SampledSpectraSpan& spectra, StoreHint hint, const Execution& execution) {
  SPECTILE_TRY(check(upsampler, in, spectra));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const bool stream = streams(hint, spectra);
  tiles::for_blocks(blocks_for(in.lanes), execution, [&](std::size_t first, std::size_t count) {
    upsample_tile(*table, upsampler, in, matrix, spectra.data, first, count, stream);
  });
  return {};
}

}  // namespace

// Spans go by value.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
Result<void> upsample_srgb(const Upsampler& upsampler, ColorView rgb, SampledSpectraSpan spectra,
                           StoreHint hint, const Execution& execution) {
  return run(upsampler, rgb, nullptr, spectra, hint, execution);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param)
Result<void> upsample_xyz(const Upsampler& upsampler, ColorView xyz, SampledSpectraSpan spectra,
                          StoreHint hint, const Execution& execution) {
  const std::array<float, 9> matrix = color::to_float(inverse(upsampler.rgb_to_xyz()));
  return run(upsampler, xyz, matrix.data(), spectra, hint, execution);
}

Result<CoefficientLanes> CoefficientLanes::create(const Upsampler& upsampler, std::size_t lanes) {
  CoefficientLanes out;
  SPECTILE_ASSIGN(out.c, ColorLanes::create(lanes));
  if (rows::has_scale(upsampler)) {
    SPECTILE_ASSIGN(out.scale, ScalarLanes::create(lanes));
  }
  return out;
}

Result<void> coefficients(const Upsampler& upsampler, ColorView rgb, CoefficientLanes& out,
                          const Execution& execution) {
  SPECTILE_TRY(shape::same_lanes(rgb.lanes, out.c.lanes()));
  if (rows::has_scale(upsampler)) SPECTILE_TRY(shape::same_lanes(rgb.lanes, out.scale.lanes()));
  SPECTILE_TRY(shape::aligned(rgb));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const std::size_t blocks = blocks_for(rgb.lanes);
  std::vector<std::uint64_t> unsolved(blocks);
  const ColorSpan c = out.c.span();
  float* const scale = rows::has_scale(upsampler) ? out.scale.span().data : nullptr;
  tiles::for_blocks(blocks, execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    const float* const source[3] = {rgb.c[0] + at, rgb.c[1] + at, rgb.c[2] + at};
    const rows::Coefficients row = {{c.c[0] + at, c.c[1] + at, c.c[2] + at},
                                    scale == nullptr ? nullptr : scale + at};
    rows::solve(*table, upsampler, source, row, unsolved.data() + first, count * kLanesPerBlock);
  });
  out.unsolved = {};
  for (std::size_t i = 0; i < rgb.lanes; ++i) {
    if (((unsolved[i / kLanesPerBlock] >> (i % kLanesPerBlock)) & 1U) == 0) continue;
    if (out.unsolved.outside++ == 0) out.unsolved.first = static_cast<std::int64_t>(i);
  }
  return {};
}

Result<void> expand(const Upsampler& upsampler, const CoefficientLanes& in, SampledSpectraSpan spectra,
                    StoreHint hint, const Execution& execution) {
  const ColorView c = in.c.view();
  SPECTILE_TRY(check(upsampler, c, spectra));
  if (rows::has_scale(upsampler)) SPECTILE_TRY(shape::same_lanes(c.lanes, in.scale.lanes()));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const bool stream = streams(hint, spectra);
  const float* const scale = rows::has_scale(upsampler) ? in.scale.view().data : nullptr;
  const std::size_t bands = upsampler.bands().count();
  tiles::for_blocks(blocks_for(c.lanes), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    const float* const row[3] = {c.c[0] + at, c.c[1] + at, c.c[2] + at};
    rows::expand_blocks(*table, upsampler, row, scale == nullptr ? nullptr : scale + at,
                        spectra.data + at * bands, count, stream);
  });
  return {};
}

}  // namespace spectile
