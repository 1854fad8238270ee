// TextureTiles: a texture's texels, from the cache or from its file.
#include "src/io/texture/texture_tiles.hpp"

#include <algorithm>

namespace spectile::io {

Result<void> TextureTiles::copy(const Places& places, std::size_t lane, std::size_t taps, FloatBuffer& copies,
                                const float** texels, Counts& counts) {
  const std::size_t floats = format().floats;
  if (copies.size() == 0) {
    SPECTILE_ASSIGN(copies, FloatBuffer::create(taps * floats));
  }
  for (std::size_t tap = 0; tap < taps; ++tap) {
    const std::size_t at = tap * places.stride + lane;
    const std::int32_t tile = places.tile[at];
    texels[tap] = tile < 0 ? format().black.data() : copies.data() + tap * floats;
    if (tile < 0) continue;
    const TileCache::Wanted wanted = {static_cast<std::size_t>(places.texel[at]) * floats, floats,
                                      copies.data() + tap * floats};
    if (cache_->copy(homes_[static_cast<std::size_t>(tile)], wanted)) {
      ++counts.hits;
      continue;
    }
    ++counts.misses;
    SPECTILE_TRY(read(tile, wanted));
  }
  return {};
}

Result<void> TextureTiles::read(std::int32_t tile, const TileCache::Wanted& wanted) {
  const std::scoped_lock lock(reading_);
  TileHome& home = homes_[static_cast<std::size_t>(tile)];
  // Another thread may have read it meanwhile.
  if (cache_->copy(home, wanted)) return {};
  // Neighbours that are decoded with a tile are kept as long as they take no more than a quarter.
  const std::size_t bytes = kernels::kTextureTileTexels * format().floats * sizeof(float);
  const std::size_t most = std::max<std::size_t>(1, cache_->max_bytes() / 4 / bytes);
  FloatBuffer kept;
  SPECTILE_TRY(source_->read(tile, most, [&](std::int32_t number, FloatBuffer texels) -> Result<void> {
    // The tile itself last, so that none of the others takes its place.
    if (number == tile) {
      kept = std::move(texels);
      return {};
    }
    return cache_->insert(homes_[static_cast<std::size_t>(number)], std::move(texels), nullptr);
  }));
  return cache_->insert(home, std::move(kept), &wanted);
}

}  // namespace spectile::io
