// TextureTiles: a texture's texels, from the cache or from its file.
#include "src/io/texture/texture_tiles.hpp"

#include <algorithm>

namespace spectile::io {

Result<void> TextureTiles::miss(std::int32_t tile, const TileCache::Wanted& wanted) {
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
