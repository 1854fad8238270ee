// TextureTiles: a texture's texels, from the cache or from its file.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "src/io/texture/tile_cache.hpp"
#include "src/io/texture/tile_reader.hpp"

namespace spectile::io {

/// Thread-safe: texels that the cache has are found without a lock; threads that miss tiles of one texture
/// read them one after the other.
class TextureTiles {
 public:
  TextureTiles(std::unique_ptr<TileSource> source, std::shared_ptr<TileCache> cache)
      : source_(std::move(source)), cache_(std::move(cache)), homes_(source_->tiles()) {}
  TextureTiles(const TextureTiles&) = delete;
  TextureTiles& operator=(const TextureTiles&) = delete;
  ~TextureTiles() { cache_->forget(homes_); }

  const std::vector<std::int32_t>& levels() const noexcept { return source_->levels(); }
  const TexelFormat& format() const noexcept { return source_->format(); }

  /// use(i, texel) for each of n texels: a tile, -1 for black, and a place within it. Errors: those of
  /// TileSource::read(); then some were not used.
  template <class Use>
  Result<void> for_each(const std::int32_t* tile, const std::int32_t* texel, std::size_t n, Use use) {
    const std::size_t floats = format().floats;
    TileCache::Reader reader(*cache_);
    std::uint64_t hits = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (tile[i] < 0) {
        use(i, format().black.data());
        continue;
      }
      const std::size_t offset = static_cast<std::size_t>(texel[i]) * floats;
      if (const float* const texels = reader.find(homes_[static_cast<std::size_t>(tile[i])])) {
        use(i, texels + offset);
        ++hits;
        continue;
      }
      reader.count(0, 1);
      reader.leave();
      float missed[kMaxFloats];
      SPECTILE_TRY(miss(tile[i], {offset, floats, missed}));
      use(i, missed);
      reader.enter(*cache_);
    }
    reader.count(hits, 0);
    return {};
  }

 private:
  /// Numbers of a texel, at most.
  static constexpr std::size_t kMaxFloats = Bands::kMaxBands;
  /// Reads a tile. Errors: those of TileSource::read().
  Result<void> miss(std::int32_t tile, const TileCache::Wanted& wanted);

  std::unique_ptr<TileSource> source_;
  std::shared_ptr<TileCache> cache_;
  std::vector<TileHome> homes_;
  std::mutex reading_;
};

}  // namespace spectile::io
