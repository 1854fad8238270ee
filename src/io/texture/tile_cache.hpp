// TileCache: decoded tiles of textures; readers take no lock, and tiles make room for others when no reader
// is left that may see them.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <spectile/float_buffer.hpp>
#include <spectile/image/texture_cache.hpp>
#include <vector>

namespace spectile::io {

/// Where a texture looks for a tile.
struct TileHome {
  std::atomic<const float*> texels = nullptr;  ///< null for one that is not there
  std::atomic<bool> used = false;              ///< since the clock's hand came by
};

/// The texels of a tile, and where its texture looks for them.
struct CachedTile {
  FloatBuffer texels;
  TileHome* home = nullptr;
  std::size_t bytes() const noexcept { return texels.size() * sizeof(float); }
};

/// Tiles are evicted by the clock algorithm: those that were not used since its hand last came by. Who evicts
/// takes tiles out of their homes, and frees them when the readers of that moment have left. Source of the
/// scheme: Fraser, Practical lock-freedom, University of Cambridge Computer Laboratory, Technical Report 579,
/// 2004, section 5.2.3 (epochs).
class TileCache {
  struct alignas(64) ReaderSlot {
    std::atomic<std::uint64_t> epoch = 0;  // when its reader came; 0 for none
    std::atomic<std::uint64_t> hits = 0;
    std::atomic<std::uint64_t> misses = 0;
  };

 public:
  explicit TileCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  TileCache(const TileCache&) = delete;
  TileCache& operator=(const TileCache&) = delete;
  ~TileCache() = default;

  /// While one lives, what find() gave to its thread stays. A thread has at most one, for microseconds, and
  /// calls nothing else of the cache meanwhile.
  class Reader {
   public:
    explicit Reader(TileCache& cache) noexcept : slot_(cache.enter()) {}
    ~Reader() { leave(); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    /// The texels of a tile, or null.
    static const float* find(TileHome& home) noexcept {
      // Ordered after the epoch of its slot: see TileCache::wait_for_readers().
      const float* const texels = home.texels.load(std::memory_order_seq_cst);
      if (texels != nullptr && !home.used.load(std::memory_order_relaxed))
        home.used.store(true, std::memory_order_relaxed);
      return texels;
    }
    void count(std::uint64_t hits, std::uint64_t misses) noexcept {
      slot_->hits.fetch_add(hits, std::memory_order_relaxed);
      slot_->misses.fetch_add(misses, std::memory_order_relaxed);
    }
    /// Lets go of the tiles found; enter() is for the next ones.
    void leave() noexcept {
      if (slot_ != nullptr) slot_->epoch.store(0, std::memory_order_release);
      slot_ = nullptr;
    }
    void enter(TileCache& cache) noexcept { slot_ = cache.enter(); }

   private:
    ReaderSlot* slot_;
  };

  /// Numbers of a tile that somebody waits for.
  struct Wanted {
    std::size_t offset;  // in floats
    std::size_t count;
    float* to;
  };
  /// Puts a tile into its home, unless there is one already, after making room for it, and copies what is
  /// wanted of it before it could be evicted. Errors: kOutOfMemory.
  Result<void> insert(TileHome& home, FloatBuffer texels, const Wanted* wanted);
  /// Copies out of a tile; false where it is not there.
  bool copy(const TileHome& home, const Wanted& wanted);
  /// Takes a texture's tiles out; nobody may be reading it.
  void forget(std::span<TileHome> homes) noexcept;

  std::size_t max_bytes() const noexcept { return max_bytes_; }
  TextureCacheStats stats() const;

 private:
  static constexpr std::size_t kReaders = 256;
  ReaderSlot* enter() noexcept;
  /// Makes room for `bytes`, and some more, as far as there are tiles. Under the lock.
  void evict(std::size_t bytes) noexcept;
  std::unique_ptr<CachedTile> take(std::size_t at) noexcept;
  void wait_for_readers() noexcept;

  const std::size_t max_bytes_;
  std::array<ReaderSlot, kReaders> readers_;
  alignas(64) std::atomic<std::uint64_t> epoch_ = 1;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<CachedTile>> tiles_;
  std::vector<std::unique_ptr<CachedTile>> leaving_;  // room for as many as tiles_
  std::size_t hand_ = 0;
  std::size_t bytes_ = 0;
  std::uint64_t tiles_read_ = 0;
  std::uint64_t evicted_ = 0;
};

}  // namespace spectile::io
