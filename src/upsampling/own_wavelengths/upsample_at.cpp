// Colours to samples at each lane's own wavelengths: coefficients of a chunk, then its samples.
#include <algorithm>

#include "src/dispatch/dispatch.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/own_wavelengths/samples_at.hpp"

namespace spectile {
namespace {

/// Blocks whose coefficients are found at once.
constexpr std::size_t kBlocks = rows::kChunk / kLanesPerBlock;

struct Chunk {
  alignas(64) float c[3][rows::kChunk];
  alignas(64) float scale[rows::kChunk];
  std::uint64_t unsolved[kBlocks];
};

Result<void> check(const ColorView& in, const SampledSpectraView& lambda_nm, const SampledSpectraSpan& out) {
  SPECTILE_TRY(shape::own_wavelengths(lambda_nm.axis));
  SPECTILE_TRY(shape::same(lambda_nm, out));
  SPECTILE_TRY(shape::same_lanes(in.lanes, out.lanes));
  SPECTILE_TRY(shape::aligned(lambda_nm.data));
  SPECTILE_TRY(shape::aligned(out.data));
  return shape::aligned(in);
}

/// `first` and `count` in blocks.
template <class View>
View blocks_of(const View& whole, std::size_t first, std::size_t count) {
  return whole.range(first * kLanesPerBlock, count * kLanesPerBlock);
}

void upsample_tile(const kernels::KernelTable& table, const Upsampler& upsampler, const ColorView& in,
                   const SampledSpectraView& lambda_nm, const SampledSpectraSpan& out, std::size_t first,
                   std::size_t count) {
  Chunk chunk;
  for (std::size_t block = first; block < first + count; block += kBlocks) {
    const std::size_t blocks = std::min(kBlocks, first + count - block);
    const std::size_t at = block * kLanesPerBlock;
    const float* const rgb[3] = {in.c[0] + at, in.c[1] + at, in.c[2] + at};
    const float* const found[3] = {chunk.c[0], chunk.c[1], chunk.c[2]};
    const bool direct = rows::stores_rgb(upsampler);
    float* const scale = rows::has_scale(upsampler) ? chunk.scale : nullptr;
    if (!direct) {
      rows::solve(table, upsampler, rgb, {{chunk.c[0], chunk.c[1], chunk.c[2]}, scale}, chunk.unsolved,
                  blocks * kLanesPerBlock);
    }
    rows::samples_at(table, upsampler, direct ? rgb : found, scale, blocks_of(lambda_nm, block, blocks),
                     blocks_of(out, block, blocks));
  }
}

}  // namespace

Result<void> upsample_srgb(const Upsampler& upsampler, ColorView rgb, SampledSpectraView lambda_nm,
                           SampledSpectraSpan samples, const Execution& execution) {
  SPECTILE_TRY(check(rgb, lambda_nm, samples));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  tiles::for_blocks(samples.blocks(), execution, [&](std::size_t first, std::size_t count) {
    upsample_tile(*table, upsampler, rgb, lambda_nm, samples, first, count);
  });
  return {};
}

Result<void> expand(const Upsampler& upsampler, const CoefficientLanes& in, SampledSpectraView lambda_nm,
                    SampledSpectraSpan samples, const Execution& execution) {
  const ColorView c = in.c;
  SPECTILE_TRY(check(c, lambda_nm, samples));
  if (rows::has_scale(upsampler)) SPECTILE_TRY(shape::same_lanes(c.lanes, in.scale.lanes()));
  SPECTILE_ASSIGN(const auto table, dispatch::active());
  const float* const scale = rows::has_scale(upsampler) ? in.scale.view().data : nullptr;
  tiles::for_blocks(samples.blocks(), execution, [&](std::size_t first, std::size_t count) {
    const std::size_t at = first * kLanesPerBlock;
    const float* const row[3] = {c.c[0] + at, c.c[1] + at, c.c[2] + at};
    rows::samples_at(*table, upsampler, row, scale == nullptr ? nullptr : scale + at,
                     blocks_of(lambda_nm, first, count), blocks_of(samples, first, count));
  });
  return {};
}

}  // namespace spectile
