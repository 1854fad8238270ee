// Relighting of rows of lanes, the direct way and the long one.
#pragma once

#include <spectile/upsampling/relight.hpp>

#include "kernels/abi.hpp"

namespace spectile::rows {

/// RGB of n lanes, a multiple of 64, to colour; `out` may be `rgb`.
void relight(const kernels::KernelTable& kernels, const Relighter& relighter, const float* const rgb[3],
             float* const out[3], std::size_t n);

/// The same by way of spectra, block by block in the caches. `spectra` holds one block.
void relight_by_spectra(const kernels::KernelTable& kernels, const Relighter& relighter,
                        const float* const rgb[3], float* const out[3], float* spectra, std::size_t n);

}  // namespace spectile::rows
