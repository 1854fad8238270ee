// Places of lanes in a texture.
#pragma once

#include "kernels/abi/texture.hpp"
#include "kernels/simd/tables.hpp"

namespace spectile::kernels {
namespace {

/// Texels next to a coordinate, as indices within a side, and how far it is on its way to the second one.
struct SidePlaces {
  F32 texel[2];
  F32 part;
};

inline F32 wrapped_coordinate(TextureWrap wrap, F32 c) noexcept {
  if (wrap == TextureWrap::kRepeat) return c - xsimd::floor(c);
  if (wrap != TextureWrap::kMirror) return c;
  const F32 two(2.0F);
  const F32 m = c - two * xsimd::floor(c * F32(0.5F));
  return xsimd::select(F32(1.0F) < m, two - m, m);
}

inline F32 wrapped_index(TextureWrap wrap, F32 i, F32 size) noexcept {
  if (wrap == TextureWrap::kBlack) return i;
  if (wrap != TextureWrap::kRepeat) return min(size - F32(1.0F), max(F32(0.0F), i));
  const F32 above = xsimd::select(i < F32(0.0F), i + size, i);
  return xsimd::select(above < size, above, above - size);
}

inline SidePlaces places_on_side(TextureWrap wrap, TextureTaps taps, F32 c, F32 size) noexcept {
  F32 p = wrapped_coordinate(wrap, c) * size;
  if (taps != TextureTaps::kNearest) p = p - F32(0.5F);
  p = min(size + F32(1.0F), max(F32(-2.0F), p));
  const F32 near = xsimd::floor(p);
  return {{wrapped_index(wrap, near, size), wrapped_index(wrap, near + F32(1.0F), size)}, p - near};
}

/// Levels of lanes, and how far they are on their way to the next one.
inline F32 levels_of(const TextureCoordinates& at, std::int32_t count, std::size_t i) noexcept {
  if (at.level == nullptr) return F32(0.0F);
  F32 t = load(at.level + i);
  if (at.footprint_texels != 0) {
    // + 0: bits of -0 are those of no positive number.
    const F32 texels = max(F32(0.0F), t * F32(at.footprint_texels)) + F32(0.0F);
    const I32 above_one = bits_as<std::int32_t>(texels) - I32(0x3F800000);
    t = xsimd::select(is_nan(texels), texels, xsimd::to_float(above_one) * F32(0x1p-23F));
  }
  return min(F32(static_cast<float>(count - 1)), max(F32(0.0F), t));
}

inline Mask outside(F32 i, F32 size) noexcept {
  return (i < F32(0.0F)) | (size <= i);
}

/// The texels of one level.
struct LevelPlaces {
  SidePlaces x, y;
  F32 width, height;
  I32 tiles_x, first;
};

inline LevelPlaces places_on_level(const TextureShape& shape, F32 u, F32 v, I32 level) noexcept {
  const I32 row = level * I32(static_cast<std::int32_t>(kTextureLevelRow));
  LevelPlaces out;
  out.width = xsimd::to_float(gather(shape.levels, row));
  out.height = xsimd::to_float(gather(shape.levels, row + I32(1)));
  out.tiles_x = gather(shape.levels, row + I32(2));
  out.first = gather(shape.levels, row + I32(3));
  out.x = places_on_side(shape.wrap_u, shape.taps, u, out.width);
  out.y = places_on_side(shape.wrap_v, shape.taps, v, out.height);
  return out;
}

inline void store_tap(const TextureTexels& out, std::size_t at, const LevelPlaces& level, F32 x, F32 y,
                      F32 weight, Mask no_number) noexcept {
  const Mask none = outside(x, level.width) | outside(y, level.height) | no_number | (weight == F32(0.0F));
  const I32 column = xsimd::to_int(x);
  const I32 line = xsimd::to_int(y);
  const I32 within(kTextureTile - 1);
  const I32 tile = level.first + (line >> kTextureTileLog2) * level.tiles_x + (column >> kTextureTileLog2);
  const I32 texel = ((line & within) << kTextureTileLog2) | (column & within);
  // A selection moves bits, whatever they stand for.
  const auto unless_none = [none](I32 otherwise, I32 value) {
    return bits_as<std::int32_t>(xsimd::select(none, bits_as<float>(otherwise), bits_as<float>(value)));
  };
  unless_none(I32(-1), tile).store_aligned(out.tile + at);
  unless_none(I32(0), texel).store_aligned(out.texel + at);
  store(out.weight + at, xsimd::select(no_number, F32(__builtin_nanf("")), weight));
}

inline void store_level(const TextureTexels& out, std::size_t at, std::size_t n, const LevelPlaces& level,
                        F32 share, Mask no_number) noexcept {
  const F32 one(1.0F);
  const F32 x_weight[2] = {one - level.x.part, level.x.part};
  const F32 y_weight[2] = {one - level.y.part, level.y.part};
  for (std::size_t tap = 0; tap < 4; ++tap) {
    const F32 weight = (x_weight[tap % 2] * y_weight[tap / 2]) * share;
    store_tap(out, at + tap * n, level, level.x.texel[tap % 2], level.y.texel[tap / 2], weight, no_number);
  }
}

void texture_places(const TextureTexels& out, const TextureCoordinates& at, const TextureShape& shape,
                    std::size_t n) noexcept {
  const TextureShape s = shape;  // copies that stores leave alone
  const TextureCoordinates from = at;
  const TextureTexels to = out;
  const F32 zero(0.0F);
  const F32 one(1.0F);
  const I32 last(s.count - 1);
  for (std::size_t i = 0; i < n; i += kWidth) {
    const F32 u = load(from.u + i);
    const F32 v = load(from.v + i);
    const F32 level = levels_of(from, s.count, i);
    // x - x is 0 for finite x and NaN otherwise.
    const Mask no_number = is_nan(((u - u) + (v - v)) + level);
    const F32 safe_u = xsimd::select(no_number, zero, u);
    const F32 safe_v = xsimd::select(no_number, zero, v);
    const F32 t = xsimd::select(no_number, zero, level);
    if (s.taps == TextureTaps::kTrilinear) {
      const I32 low = xsimd::to_int(t);
      const F32 part = t - xsimd::to_float(low);
      store_level(to, i, n, places_on_level(s, safe_u, safe_v, low), one - part, no_number);
      const I32 high = xsimd::min(low + I32(1), last);
      store_level(to, i + 4 * n, n, places_on_level(s, safe_u, safe_v, high), part, no_number);
      continue;
    }
    const LevelPlaces places = places_on_level(s, safe_u, safe_v, xsimd::to_int(t + F32(0.5F)));
    if (s.taps == TextureTaps::kNearest) {
      store_tap(to, i, places, places.x.texel[0], places.y.texel[0], one, no_number);
    } else {
      store_level(to, i, n, places, one, no_number);
    }
  }
}

}  // namespace
}  // namespace spectile::kernels
