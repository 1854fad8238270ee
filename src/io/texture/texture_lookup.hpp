// TextureLookup: filtered samples of lanes, block by block.
#pragma once

#include <spectile/image/spectral_texture.hpp>

#include "kernels/abi.hpp"
#include "src/io/texture/texture_tiles.hpp"
#include "src/upsampling/own_wavelengths/wavelength_tables.hpp"

namespace spectile::io {

/// A texture's tiles, and how their numbers become samples.
struct TextureContent {
  TextureTiles& tiles;
  const Upsampler* upsampler;    ///< of coefficients; null for bands
  kernels::CentreTable centres;  ///< of bands
};

/// A block of lanes: up to 64, of which the arrays have all.
struct TextureBlock {
  kernels::TextureCoordinates at;
  const float* lambda_nm = nullptr;  ///< [count][64]
  std::size_t count = 0;
  std::size_t lanes = kLanesPerBlock;
  bool own_bands = false;  ///< at the centres of the bands that coefficients were made for
};

/// Samples of one block of lanes. Shapes: out [count][64], which may be its wavelengths. Errors: those of
/// TextureTiles::for_each().
Result<void> sample_block(const kernels::KernelTable& kernels, const TextureContent& content,
                          const kernels::TextureShape& shape, const TextureBlock& block, float* out);

}  // namespace spectile::io
