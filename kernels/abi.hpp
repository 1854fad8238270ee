// KernelTable: every hot operation as a noexcept function over raw pointers, family by family.
//
// Rules common to all, where nothing else is said:
//  - Float arrays are 64-byte aligned, counts n are multiples of kLanes.
//  - A batch of spectra is [blocks][bands][kLanes].
//  - `dst` may be the same array as a source, never a shifted overlap of it.
//  - A formula rounds once per operation, without contraction; fma(a, b, c) alone is fused.
//  - sum(bands): ascending, in runs of kSumRun bands that start from 0; then the runs' sums, likewise.
//  - Zeros, denormals, huge values, infinities and NaN go through a formula as IEEE 754 says.
// Therefore every table gives the same bits, but for the payload of a NaN.
#pragma once

#include "kernels/abi/arithmetic.hpp"
#include "kernels/abi/color.hpp"
#include "kernels/abi/film.hpp"
#include "kernels/abi/texture.hpp"
#include "kernels/abi/upsampling.hpp"
#include "kernels/abi/wavelengths.hpp"

namespace spectile::kernels {

/// One instruction set's kernels.
struct KernelTable : ArithmeticKernels,
                     ColorKernels,
                     UpsamplingKernels,
                     WavelengthKernels,
                     FilmKernels,
                     TextureKernels {
  const char* name = nullptr;
  int lanes = 0;  ///< float lanes of a vector register; 1 for the reference
};

/// The same as an instruction set's units define them: constants alone, so that none of its code runs at
/// start-up.
struct KernelFamilies {
  const char* name;
  int lanes;
  const ArithmeticKernels* arithmetic;
  const ColorKernels* color;
  const UpsamplingKernels* upsampling;
  const WavelengthKernels* wavelengths;
  const FilmKernels* film;
  const TextureKernels* texture;
};

}  // namespace spectile::kernels
