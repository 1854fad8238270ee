// A method's steps on rows of lanes: colours to coefficients, coefficients to samples, relighting.
#pragma once

#include <cstdint>
#include <spectile/upsampling/relight.hpp>

#include "kernels/abi.hpp"

namespace spectile {

/// An upsampler's tables in the kernels' layout.
struct UpsamplerAccess {
  /// Shapes: [bands][8], the basis spectra and 0, 64-byte aligned. Null for the sigmoids and tetrahedral.
  static const float* table(const Upsampler& upsampler) noexcept {
    return upsampler.table_ ? upsampler.table_->data() : nullptr;
  }
  /// Null for all but the sigmoids.
  static const SigmoidModel* sigmoid(const Upsampler& upsampler) noexcept { return upsampler.sigmoid_.get(); }
  /// Null for all but tetrahedral.
  static const std::shared_ptr<const GridModel>& grid(const Upsampler& upsampler) noexcept {
    return upsampler.grid_;
  }
  static const WavelengthTables& at_wavelengths(const Upsampler& upsampler) noexcept {
    return *upsampler.at_wavelengths_;
  }
};

/// A relighter's table in the kernels' layout.
struct RelighterAccess {
  /// Shapes: [3][8], white, cyan, magenta, yellow, red, green, blue, 0. Null for the sigmoids and
  /// tetrahedral.
  static const float* table(const Relighter& relighter) noexcept {
    return relighter.table_ ? relighter.table_->data() : nullptr;
  }
  /// Null for all but tetrahedral.
  static const GridModel* grid(const Relighter& relighter) noexcept { return relighter.grid_.get(); }
};

}  // namespace spectile

namespace spectile::rows {

/// Lanes that go through a method in one go: their coefficients stay in the first-level cache between being
/// found and being used.
inline constexpr std::size_t kChunk = 512;

/// Coefficients of a row of lanes, where they are kept. For methods that mix basis spectra they are the RGB.
struct Coefficients {
  float* c[3] = {nullptr, nullptr, nullptr};
  float* scale = nullptr;  ///< null where the method needs none
};

/// True for the methods whose coefficients are their RGB.
inline bool stores_rgb(const Upsampler& upsampler) {
  return !is_sigmoid(upsampler.method());
}
/// True for those whose spectra are mixtures of seven basis spectra.
inline bool mixes_bases(const Upsampler& upsampler) {
  return stores_rgb(upsampler) && upsampler.method() != Method::kTetrahedral;
}
/// True where half the colour has half the spectrum.
inline bool is_homogeneous(const Upsampler& upsampler) {
  return mixes_bases(upsampler) || upsampler.quantity() != Quantity::kReflectance;
}
/// True where every lane has a scale besides its coefficients.
inline bool has_scale(const Upsampler& upsampler) {
  return is_sigmoid(upsampler.method()) && upsampler.quantity() != Quantity::kReflectance;
}

/// The spectra of lanes in an upsampler's grid. `scale`: a factor of each; may be null.
kernels::GridSpectra grid_spectra(const Upsampler& upsampler, const float* const rgb[3], const float* scale);

/// The same in the grid of colours of a relighter.
kernels::GridSpectra folded_spectra(const Relighter& relighter, const float* const rgb[3],
                                    const float* scale);

/// RGB to coefficients; n a multiple of 64, any number of them. `unsolved` [n / 64] gets a bit for each lane
/// that has none; it gets those of the last colour on the line from its grey that has some, and its `part`
/// [n], where asked for, is how much of that line that is, else 1. `out` may be `rgb`.
void solve(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const rgb[3],
           const Coefficients& out, std::uint64_t* unsolved, std::size_t n, float* part = nullptr);

/// True where the method has every colour with components in [0, 1], or [0, infinity) where it has a scale.
bool covers_unit_cube(const Upsampler& upsampler);

/// Coefficients to blocks of samples.
void expand_blocks(const kernels::KernelTable& kernels, const Upsampler& upsampler, const float* const c[3],
                   const float* scale, float* spectra, std::size_t blocks, bool non_temporal);

/// Weights of white, cyan, magenta, yellow, red, green, blue, of methods that mix these: see smits_blocks in
/// kernels/abi. Where two components are the same the weight that either could have is 0.
void basis_weights(const float* const rgb[3], std::size_t n, float* const* out);

/// gamut_clip() on a row of `n` lanes, padded to a multiple of 64 with zeros. `lanes_outside` [n], where
/// asked for, becomes 1 for each of them that is, else 0.
GamutReport gamut_clip(const kernels::KernelTable& kernels, const Upsampler& upsampler, float* const rgb[3],
                       GamutPolicy policy, std::size_t n, std::uint8_t* lanes_outside = nullptr);

/// RGB of n lanes, a multiple of 64, to colour; `out` may be `rgb`. `scale` [n]: a factor of each lane's
/// spectrum, for methods without a scale of their own; null for 1.
void relight(const kernels::KernelTable& kernels, const Relighter& relighter, const float* const rgb[3],
             float* const out[3], std::size_t n, const float* scale = nullptr);

/// The same through spectra, block by block in the caches. `spectra` holds one block.
void relight_by_spectra(const kernels::KernelTable& kernels, const Relighter& relighter,
                        const float* const rgb[3], float* const out[3], float* spectra, std::size_t n,
                        const float* scale = nullptr);

}  // namespace spectile::rows
