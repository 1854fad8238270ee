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

  /// Where lanes find their texels: a tile, -1 for black, and a place within it. Shapes: [taps][stride].
  struct Places {
    const std::int32_t* tile;
    const std::int32_t* texel;
    std::size_t stride;
  };
  /// use(lane, texels), lane by lane, with a texel for each tap. Errors: those of
  /// TileSource::read(), and kOutOfMemory; then some lanes were not used.
  template <std::size_t kTaps, class Use>
  Result<void> for_each(const Places& at, std::size_t lanes, Use use) {
    // Copies that `use` leaves alone.
    const Places places = at;
    const Homes homes = {homes_.data(), format().black.data(), format().floats};
    TileCache::Reader reader(*cache_);
    Counts counts;
    FloatBuffer copies;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const float* texels[kTaps] = {};
      if (find<kTaps>(homes, places, lane, texels, counts)) {
        use(lane, texels);
        continue;
      }
      reader.leave();
      SPECTILE_TRY(copy(places, lane, kTaps, copies, texels, counts));
      use(lane, texels);
      reader.enter(*cache_);
    }
    reader.count(counts.hits, counts.misses);
    return {};
  }

 private:
  struct Counts {
    std::uint64_t hits = 0;
    std::uint64_t misses = 0;
  };
  struct Homes {
    TileHome* first;
    const float* black;
    std::size_t floats;
  };
  /// A lane's texels in the cache; false where one is not there, and then nothing is counted.
  template <std::size_t kTaps>
  static bool find(const Homes& homes, const Places& places, std::size_t lane, const float** texels,
                   Counts& counts) noexcept {
    std::uint64_t hits = 0;
#pragma GCC unroll 8
    for (std::size_t tap = 0; tap < kTaps; ++tap) {
      const std::size_t at = tap * places.stride + lane;
      const std::int32_t tile = places.tile[at];
      texels[tap] = homes.black;
      if (tile < 0) continue;
      const float* const found = TileCache::Reader::find(homes.first[tile]);
      if (found == nullptr) return false;
      texels[tap] = found + static_cast<std::size_t>(places.texel[at]) * homes.floats;
      ++hits;
    }
    counts.hits += hits;
    return true;
  }
  /// Copies a lane's texels, after reading what is not there: the cache may be too small for all of them.
  Result<void> copy(const Places& places, std::size_t lane, std::size_t taps, FloatBuffer& copies,
                    const float** texels, Counts& counts);
  /// Reads a tile, unless another thread has meanwhile. Errors: those of TileSource::read().
  Result<void> read(std::int32_t tile, const TileCache::Wanted& wanted);

  std::unique_ptr<TileSource> source_;
  std::shared_ptr<TileCache> cache_;
  std::vector<TileHome> homes_;
  std::mutex reading_;
};

}  // namespace spectile::io
