// A method's two steps on rows of lanes: colours to coefficients, coefficients to samples.
#pragma once

#include <cstdint>
#include <spectile/upsampling/upsample.hpp>

#include "kernels/abi.hpp"

namespace spectile::rows {

/// Coefficients of a row of lanes, where they are kept. For methods that mix basis spectra they are the RGB.
struct Coefficients {
  float* c[3] = {nullptr, nullptr, nullptr};
  float* scale = nullptr;  ///< null where the method needs none
};

/// Whether a method's coefficients are its RGB.
inline bool mixes_bases(const Upsampler& upsampler) {
  return upsampler.sigmoid() == nullptr;
}
/// Whether every lane has a scale besides its coefficients.
inline bool has_scale(const Upsampler& upsampler) {
  return !mixes_bases(upsampler) && upsampler.quantity() != Quantity::kReflectance;
}

/// RGB to coefficients; n a multiple of 64, any number of them. `unsolved` [n / 64] gets a bit for each lane
/// that has none; it gets those of the last colour on the line from its grey that has some, and its `part`
/// [n], where asked for, is how much of that line that is, else 1. `out` may be `rgb`.
void solve(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const rgb[3],
           const Coefficients& out, std::uint64_t* unsolved, std::size_t n, float* part = nullptr);

/// Whether some colours without a component outside [0, 1], or [0, infinity) where it has a scale, are none
/// of the method's.
bool misses_inside(const Upsampler& upsampler);

/// Coefficients to blocks of samples.
void expand_blocks(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const c[3],
                   const float* scale, float* spectra, std::size_t blocks, bool stream);

/// gamut_clip() on a row of `n` lanes, padded to a multiple of 64 with zeros. `lanes_outside` [n], where
/// asked for, becomes 1 for each of them that is, else 0.
GamutReport gamut_clip(const kernels::KernelTable& kernels, const Upsampler& upsampler, float* const rgb[3],
                       OutOfGamut policy, std::size_t n, std::uint8_t* lanes_outside = nullptr);

}  // namespace spectile::rows
