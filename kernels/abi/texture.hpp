// Places of lanes in a texture: texels of a mip level, their tiles and their weights.
#pragma once

#include "kernels/abi/lanes.hpp"

namespace spectile::kernels {

/// log2 of texels along a tile's side; a tile is square.
inline constexpr int kTextureTileLog2 = 6;
inline constexpr std::int32_t kTextureTile = 1 << kTextureTileLog2;
inline constexpr std::size_t kTextureTileTexels = std::size_t{1} << (2 * kTextureTileLog2);

/// The texels beyond the edges.
enum class TextureWrap : std::int32_t { kRepeat, kMirror, kClamp, kBlack };

/// A mip level's numbers: its width and height, at most 2^18; its tiles side by side; the first one's number.
inline constexpr std::size_t kTextureLevelRow = 4;

/// Texels that make a lane's value.
enum class TextureTaps : std::int32_t { kNearest = 1, kBilinear = 4, kTrilinear = 8 };

struct TextureShape {
  const std::int32_t* levels = nullptr;  ///< [count][kTextureLevelRow]; level 0 is the whole texture
  std::int32_t count = 1;
  TextureWrap wrap_u = TextureWrap::kRepeat;
  TextureWrap wrap_v = TextureWrap::kRepeat;
  TextureTaps taps = TextureTaps::kBilinear;
};

/// Coordinates of lanes; 0 to 1 is the texture, from its left and from its top.
struct TextureCoordinates {
  const float* u = nullptr;
  const float* v = nullptr;
  const float* level = nullptr;  ///< null for 0
  /// Texels of level 0 that a footprint of 1 covers, where `level` holds footprints; 0 where it holds levels.
  float footprint_texels = 0;
};

/// Tile and texel within it of each tap, tile -1 for black; rows [taps][n].
struct TextureTexels {
  std::int32_t* tile = nullptr;
  std::int32_t* texel = nullptr;
  float* weight = nullptr;
};

struct TextureKernels {
  // coordinate c, along a side of `size` texels:
  //   repeat: c - floor(c); mirror: m = c - 2 floor(c / 2), 1 < m ? 2 - m : m; clamp, black: c
  //   p = c * size, less 0.5 but for nearest, from -2 to size + 1; i = floor(p), part = p - i, far: i + 1
  //   repeat: i < 0 ? i + size : i, size <= i ? i - size : i; mirror, clamp: from 0 to size - 1
  //   black: outside of 0 to size - 1 no tile
  // level t: from 0 to count - 1; of a footprint f = max(0, level * footprint_texels) + 0 it is
  //   (bits(f) - bits(1)) * 2^-23, which is log2 at powers of two and linear between them
  //   nearest, bilinear: level int(t + 0.5)
  //   trilinear: level int(t) for l = 0 and the next one for l = 1, part t - int(t)
  // tap 4 l + 2 y + x, weight (of_x * of_y) * of_l, of_x: x == 0 ? 1 - part : part, alike for y, l
  // weight 0: no tile; u or v not finite, t NaN: weight NaN, no tile; no tile: texel 0
  void (*texture_places)(const TextureTexels& out, const TextureCoordinates& at, const TextureShape& shape,
                         std::size_t n) noexcept;
};

}  // namespace spectile::kernels
