// Colours to samples at each lane's own wavelengths: coefficients of a chunk, then its samples.
#include <algorithm>

#include "src/dispatch/dispatch.hpp"
#include "src/lanes/sampler_run.hpp"
#include "src/lanes/shape.hpp"
#include "src/lanes/tiles.hpp"
#include "src/upsampling/method_rows.hpp"
#include "src/upsampling/own_wavelengths/wavelength_tables.hpp"

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

/// Samples of lanes with these coefficients.
void sample_blocks(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const c[3],
                   const float* scale, const SampledSpectraView& lambda_nm, const SampledSpectraSpan& out) {
  const WavelengthTables& tables = UpsamplerAccess::at_wavelengths(upsampler);
  const std::size_t count = out.axis.count();
  if (rows::mixes_bases(upsampler)) {
    kernels.mixtures_at(out.data, c, {tables.ends.data(), upsampler.lowest()}, tables.centres, lambda_nm.data,
                        count, out.blocks());
    return;
  }
  if (rows::stores_rgb(upsampler)) {
    kernels.grid_at(out.data, rows::grid_spectra(upsampler, c, scale), tables.centres, lambda_nm.data, count,
                    out.blocks());
    return;
  }
  kernels::SigmoidLanes sigmoids = tables.sigmoid;
  sigmoids.c = c;
  if (!tables.white) {
    sigmoids.scale = scale;
    kernels.sigmoids_at(out.data, sigmoids, lambda_nm.data, count, out.blocks());
    return;
  }
  // In the order of the batches on bands: the sample, times the white, times the scale.
  // The white first: the samples may be written over the wavelengths.
  alignas(64) float whites[SpectralAxis::kMaxWavelengths * kLanesPerBlock];
  for (std::size_t block = 0; block < out.blocks(); ++block) {
    float* const to = out.row(block, 0);
    const std::size_t at = block * kLanesPerBlock;
    const float* const own[3] = {c[0] + at, c[1] + at, c[2] + at};
    sigmoids.c = own;
    SpectrumSamplerAccess::run(*tables.white, kernels, lambda_nm.row(block, 0), whites,
                               count * kLanesPerBlock);
    kernels.sigmoids_at(to, sigmoids, lambda_nm.row(block, 0), count, 1);
    kernels.multiply(to, to, whites, count * kLanesPerBlock);
    kernels.scale_lanes(to, to, scale + at, count, 1);
  }
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
    sample_blocks(table, upsampler, direct ? rgb : found, scale, blocks_of(lambda_nm, block, blocks),
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
    sample_blocks(*table, upsampler, row, scale == nullptr ? nullptr : scale + at,
                  blocks_of(lambda_nm, first, count), blocks_of(samples, first, count));
  });
  return {};
}

}  // namespace spectile
