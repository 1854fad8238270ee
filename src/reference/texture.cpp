// Scalar twins of the kernels for places in textures.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "src/reference/twins.hpp"

namespace spectile::reference {
namespace {

using kernels::TextureCoordinates;
using kernels::TextureShape;
using kernels::TextureTaps;
using kernels::TextureTexels;
using kernels::TextureWrap;

/// Texels next to a coordinate, -1 beyond a black edge, and how far it is on its way to the second one.
struct SidePlaces {
  std::int32_t texel[2];
  float part;
};

float wrapped_coordinate(TextureWrap wrap, float c) {
  if (wrap == TextureWrap::kRepeat) return c - std::floor(c);
  if (wrap != TextureWrap::kMirror) return c;
  const float m = c - 2.0F * std::floor(c * 0.5F);
  return 1.0F < m ? 2.0F - m : m;
}

std::int32_t wrapped_index(TextureWrap wrap, std::int32_t i, std::int32_t size) {
  switch (wrap) {
    case TextureWrap::kRepeat:
      if (i < 0) i += size;
      return i >= size ? i - size : i;
    case TextureWrap::kBlack:
      return i < 0 || i >= size ? -1 : i;
    default:
      return std::clamp(i, 0, size - 1);
  }
}

SidePlaces places_on_side(TextureWrap wrap, TextureTaps taps, float c, std::int32_t size) {
  const auto whole = static_cast<float>(size);
  float p = wrapped_coordinate(wrap, c) * whole;
  if (taps != TextureTaps::kNearest) p -= 0.5F;
  p = std::clamp(p, -2.0F, whole + 1.0F);
  const float near = std::floor(p);
  const auto i = static_cast<std::int32_t>(near);
  return {{wrapped_index(wrap, i, size), wrapped_index(wrap, i + 1, size)}, p - near};
}

float level_of(const TextureCoordinates& at, std::int32_t count, std::size_t i) {
  if (at.level == nullptr) return 0;
  float t = at.level[i];
  if (at.footprint_texels != 0) {
    t *= at.footprint_texels;
    if (std::isnan(t)) return t;
    const float texels = std::max(0.0F, t) + 0.0F;
    t = static_cast<float>(std::bit_cast<std::int32_t>(texels) - 0x3F800000) * 0x1p-23F;
  }
  return std::isnan(t) ? t : std::clamp(t, 0.0F, static_cast<float>(count - 1));
}

/// The taps of one level, from `at` on, `n` apart.
void store_taps(const TextureTexels& out, std::size_t at, std::size_t n, const TextureShape& shape,
                const std::int32_t* level, float u, float v, float share) {
  const SidePlaces x = places_on_side(shape.wrap_u, shape.taps, u, level[0]);
  const SidePlaces y = places_on_side(shape.wrap_v, shape.taps, v, level[1]);
  const float x_weight[2] = {1.0F - x.part, x.part};
  const float y_weight[2] = {1.0F - y.part, y.part};
  const bool nearest = shape.taps == TextureTaps::kNearest;
  for (std::size_t tap = 0; tap < (nearest ? 1 : 4); ++tap, at += n) {
    const std::int32_t column = x.texel[tap % 2];
    const std::int32_t line = y.texel[tap / 2];
    constexpr std::int32_t kSide = kernels::kTextureTile;
    const float weight = nearest ? 1.0F : (x_weight[tap % 2] * y_weight[tap / 2]) * share;
    const bool none = column < 0 || line < 0 || weight == 0;
    out.tile[at] = none ? -1 : level[3] + line / kSide * level[2] + column / kSide;
    out.texel[at] = none ? 0 : line % kSide * kSide + column % kSide;
    out.weight[at] = weight;
  }
}

}  // namespace

void texture_places(const TextureTexels& out, const TextureCoordinates& at, const TextureShape& shape,
                    std::size_t n) noexcept {
  const auto taps = static_cast<std::size_t>(shape.taps);
  const auto row = [&](std::int32_t level) { return shape.levels + std::ptrdiff_t{4} * level; };
  for (std::size_t i = 0; i < n; ++i) {
    const float level = level_of(at, shape.count, i);
    if (!std::isfinite(at.u[i]) || !std::isfinite(at.v[i]) || std::isnan(level)) {
      for (std::size_t tap = 0; tap < taps; ++tap) {
        out.tile[i + tap * n] = -1;
        out.texel[i + tap * n] = 0;
        out.weight[i + tap * n] = std::numeric_limits<float>::quiet_NaN();
      }
      continue;
    }
    if (shape.taps != TextureTaps::kTrilinear) {
      store_taps(out, i, n, shape, row(static_cast<std::int32_t>(std::floor(level + 0.5F))), at.u[i], at.v[i],
                 1.0F);
      continue;
    }
    const auto low = static_cast<std::int32_t>(level);
    const float part = level - static_cast<float>(low);
    store_taps(out, i, n, shape, row(low), at.u[i], at.v[i], 1.0F - part);
    store_taps(out, i + 4 * n, n, shape, row(std::min(low + 1, shape.count - 1)), at.u[i], at.v[i], part);
  }
}

}  // namespace spectile::reference
