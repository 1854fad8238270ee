// A method's two steps on rows of lanes: colours to coefficients, coefficients to samples.
#include "src/upsampling/method_rows.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "src/upsampling/grid/color_grid.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace spectile::rows {
namespace {

using kernels::kLanes;

/// Twice the largest component, at most the largest float, and the colour divided by it; black and what is
/// not finite as it comes.
void normalize(const float* const rgb[3], float* const out[3], float* scale, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float v[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    const float most = std::max({v[0], v[1], v[2]});
    const bool lit = most >= 0x1p-120F;
    const bool huge = most > 0x1p126F;
    scale[i] = !lit ? 0.0F : std::min(2.0F * most, std::numeric_limits<float>::max());
    // The inverse of a huge scale would be denormal.
    const float shrink = huge ? 0.25F : 1.0F;
    const float inverse = lit ? 1.0F / (scale[i] * shrink) : 1.0F;
    for (std::size_t k = 0; k < 3; ++k) out[k][i] = (v[k] * shrink) * inverse;
  }
}

/// Lanes gathered for the continuation.
struct SolvedGroup {
  alignas(64) float rgb[3][kLanes];
  alignas(64) float c[3][kLanes];
  alignas(64) float part[kLanes];
  std::size_t lane[kLanes];
  std::size_t count = 0;
};

void continue_group(const kernels::KernelTable& kernels, const Upsampler& upsampler, SolvedGroup& group,
                    float* const c[3], std::uint64_t* unsolved, float* part) {
  if (group.count == 0) return;
  for (auto& plane : group.rgb) std::fill(plane + group.count, plane + kLanes, 0.5F);
  float* const out[3] = {group.c[0], group.c[1], group.c[2]};
  const float* const rgb[3] = {group.rgb[0], group.rgb[1], group.rgb[2]};
  kernels.sigmoid_continuation(out, group.part, rgb, UpsamplerAccess::sigmoid(upsampler)->table,
                               upsampler.luminance().data(), kLanes);
  for (std::size_t i = 0; i < group.count; ++i) {
    const std::size_t lane = group.lane[i];
    for (std::size_t k = 0; k < 3; ++k) c[k][lane] = group.c[k][i];
    if (group.part[i] == 1.0F) unsolved[lane / kLanes] &= ~(std::uint64_t{1} << (lane % kLanes));
    if (part != nullptr) part[lane] = group.part[i];
  }
  group.count = 0;
}

/// Solves the lanes that the fast search left unsolved by continuation from the grey axis.
void continue_unsolved(const kernels::KernelTable& kernels, const Upsampler& upsampler,
                       const float* const rgb[3], float* const c[3], std::uint64_t* unsolved, float* part,
                       std::size_t n) {
  SolvedGroup group;
  for (std::size_t block = 0; block < n / kLanes; ++block) {
    for (std::uint64_t left = unsolved[block]; left != 0; left &= left - 1) {
      const std::size_t lane = block * kLanes + static_cast<std::size_t>(std::countr_zero(left));
      for (std::size_t k = 0; k < 3; ++k) group.rgb[k][group.count] = rgb[k][lane];
      group.lane[group.count++] = lane;
      if (group.count == kLanes) continue_group(kernels, upsampler, group, c, unsolved, part);
    }
  }
  continue_group(kernels, upsampler, group, c, unsolved, part);
}

void solve_chunk(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const rgb[3],
                 const Coefficients& out, std::uint64_t* unsolved, std::size_t n, float* part) {
  alignas(64) float kept[3][kChunk];
  float* const keep[3] = {kept[0], kept[1], kept[2]};
  const float* in[3] = {rgb[0], rgb[1], rgb[2]};
  const bool overwrites = out.c[0] == rgb[0] || out.c[1] == rgb[1] || out.c[2] == rgb[2];
  if (out.scale != nullptr) {
    normalize(rgb, keep, out.scale, n);
  } else if (overwrites) {
    for (std::size_t k = 0; k < 3; ++k) std::memcpy(kept[k], rgb[k], n * sizeof(float));
  }
  if (out.scale != nullptr || overwrites) std::copy_n(keep, 3, in);
  if (part != nullptr) std::fill_n(part, n, 1.0F);
  kernels.sigmoid_solve(out.c, in, UpsamplerAccess::sigmoid(upsampler)->table, unsolved, n);
  continue_unsolved(kernels, upsampler, in, out.c, unsolved, part, n);
}

}  // namespace

kernels::GridSpectra grid_spectra(const Upsampler& upsampler, const float* const rgb[3], const float* scale) {
  return {rgb, scale, UpsamplerAccess::grid(upsampler)->table};
}

kernels::GridSpectra folded_spectra(const Relighter& relighter, const float* const rgb[3],
                                    const float* scale) {
  return {rgb, scale, RelighterAccess::grid(relighter)->table};
}

bool covers_unit_cube(const Upsampler& upsampler) {
  return stores_rgb(upsampler) || UpsamplerAccess::sigmoid(upsampler)->covers_unit_cube;
}

void solve(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const rgb[3],
           const Coefficients& out, std::uint64_t* unsolved, std::size_t n, float* part) {
  if (stores_rgb(upsampler)) {
    std::fill_n(unsolved, n / kLanes, std::uint64_t{0});
    for (std::size_t k = 0; k < 3; ++k) {
      if (out.c[k] != rgb[k]) std::memcpy(out.c[k], rgb[k], n * sizeof(float));
    }
    if (part != nullptr) std::fill_n(part, n, 1.0F);
    return;
  }
  for (std::size_t at = 0; at < n; at += kChunk) {
    const float* const in[3] = {rgb[0] + at, rgb[1] + at, rgb[2] + at};
    const Coefficients to = {{out.c[0] + at, out.c[1] + at, out.c[2] + at},
                             out.scale == nullptr ? nullptr : out.scale + at};
    solve_chunk(kernels, upsampler, in, to, unsolved + at / kLanes, std::min(kChunk, n - at),
                part == nullptr ? nullptr : part + at);
  }
}

void expand_blocks(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const c[3],
                   const float* scale, float* spectra, std::size_t blocks, bool non_temporal) {
  const std::size_t bands = upsampler.bands().count();
  if (mixes_bases(upsampler)) {
    kernels.smits_blocks(spectra, c, {UpsamplerAccess::table(upsampler), bands, upsampler.lowest()}, blocks,
                         non_temporal);
    return;
  }
  if (stores_rgb(upsampler)) {
    kernels.grid_blocks(spectra, grid_spectra(upsampler, c, scale), blocks, non_temporal);
    return;
  }
  const bool white = upsampler.quantity() == Quantity::kIlluminant;
  const kernels::SigmoidTable& table = UpsamplerAccess::sigmoid(upsampler)->table;
  kernels.sigmoid_blocks(spectra, {c, scale, table.rows, bands, white, table.form}, blocks, non_temporal);
}

void basis_weights(const float* const rgb[3], std::size_t n, float* const* out) {
  for (std::size_t x = 0; x < n; ++x) {
    const float r = rgb[0][x];
    const float g = rgb[1][x];
    const float b = rgb[2][x];
    const float least = std::min(r, std::min(g, b));
    const float greatest = std::max(r, std::max(g, b));
    const float middle = std::max(std::min(r, g), std::min(std::max(r, g), b));
    const float second = middle - least;
    const float first = greatest - middle;
    out[0][x] = least;
    out[1][x] = r == least ? second : 0.0F;
    out[2][x] = g == least ? second : 0.0F;
    out[3][x] = b == least ? second : 0.0F;
    out[4][x] = r == greatest ? first : 0.0F;
    out[5][x] = g == greatest ? first : 0.0F;
    out[6][x] = b == greatest ? first : 0.0F;
  }
}

}  // namespace spectile::rows
