// TextureCache: decoded tiles of textures, in bounded memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <spectile/result.hpp>

namespace spectile {

/// Counts of a cache since it was made, and its memory.
struct TextureCacheStats {
  std::uint64_t hits = 0;        ///< texels found
  std::uint64_t misses = 0;      ///< texels that waited for their tile
  std::uint64_t tiles_read = 0;  ///< tiles decoded, those read again included
  std::uint64_t evicted = 0;     ///< tiles that made room for others
  std::size_t tiles = 0;         ///< held now
  std::size_t bytes = 0;         ///< of them
  std::size_t max_bytes = 0;     ///< bound of these
};

namespace io {
class TileCache;
}

/// A cache that textures share, and all threads that sample them. Its tiles never take more than the bound,
/// or a single tile where that is larger. A texel that is there is found without a lock. Copies are the same
/// cache, which lives as long as its textures.
class TextureCache {
 public:
  static constexpr std::size_t kDefaultBytes = std::size_t{256} << 20;
  /// Errors: kOutOfMemory.
  static Result<TextureCache> create(std::size_t max_bytes = kDefaultBytes);
  TextureCacheStats stats() const;

  /// For the library's own use.
  const std::shared_ptr<io::TileCache>& tiles() const noexcept { return tiles_; }

 private:
  explicit TextureCache(std::shared_ptr<io::TileCache> tiles) : tiles_(std::move(tiles)) {}
  std::shared_ptr<io::TileCache> tiles_;
};

}  // namespace spectile
