// A method's two steps on rows of lanes: colours to coefficients, coefficients to samples.
#include "src/ops/method_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/ops/sigmoid_model.hpp"

namespace spectile::rows {
namespace {

/// Twice the largest component, and the colour divided by it; black and what is not finite as it comes.
void normalize(const float* const rgb[3], float* const out[3], float* scale, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float v[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
    const float most = std::max({v[0], v[1], v[2]});
    const bool lit = most >= 0x1p-120F;
    scale[i] = lit ? 2.0F * most : 0.0F;
    const float inverse = lit ? 1.0F / scale[i] : 1.0F;
    for (std::size_t k = 0; k < 3; ++k) out[k][i] = v[k] * inverse;
  }
}

}  // namespace

void solve(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const rgb[3],
           const Coefficients& out, std::uint64_t* unsolved, std::size_t n) {
  if (mixes_bases(upsampler)) {
    std::fill_n(unsolved, n / kernels::kLanes, std::uint64_t{0});
    for (std::size_t k = 0; k < 3; ++k) {
      if (out.c[k] != rgb[k]) std::memcpy(out.c[k], rgb[k], n * sizeof(float));
    }
    return;
  }
  const float* const normalized[3] = {out.c[0], out.c[1], out.c[2]};
  if (out.scale != nullptr) normalize(rgb, out.c, out.scale, n);
  kernels.sigmoid_solve(out.c, out.scale != nullptr ? normalized : rgb, upsampler.sigmoid()->table, unsolved,
                        n);
}

void expand_blocks(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const c[3],
                   const float* scale, float* spectra, std::size_t blocks, bool stream) {
  const std::size_t bands = upsampler.bands().count();
  if (mixes_bases(upsampler)) {
    kernels.smits_blocks(spectra, c, upsampler.table(), upsampler.lowest(), bands, blocks, stream);
    return;
  }
  const bool white = upsampler.quantity() == Quantity::kIlluminant;
  kernels.sigmoid_blocks(spectra, c, scale, upsampler.sigmoid()->table.rows, white, bands, blocks, stream);
}

}  // namespace spectile::rows
