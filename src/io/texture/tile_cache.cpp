// TileCache: decoded tiles of textures; readers take no lock, and tiles make room for others when no reader
// is left that may see them.
#include "src/io/texture/tile_cache.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <thread>

#include "src/base/errors.hpp"
#include "src/base/out_of_memory.hpp"

namespace spectile::io {
namespace {

/// Where a thread looks for a free slot first, so that threads share none as long as they are few.
std::size_t first_slot() noexcept {
  static std::atomic<std::size_t> next = 0;
  thread_local const std::size_t own = next.fetch_add(1, std::memory_order_relaxed);
  return own;
}

void copy_from(const float* texels, const TileCache::Wanted& wanted) {
  std::memcpy(wanted.to, texels + wanted.offset, wanted.count * sizeof(float));
}

}  // namespace

TileCache::ReaderSlot* TileCache::enter() noexcept {
  for (std::size_t i = first_slot();; ++i) {
    ReaderSlot& slot = readers_[i % kReaders];
    std::uint64_t none = 0;
    if (slot.epoch.compare_exchange_strong(none, epoch_.load(std::memory_order_seq_cst),
                                           std::memory_order_seq_cst)) {
      return &slot;
    }
    if (i % kReaders == kReaders - 1) std::this_thread::yield();
  }
}

void TileCache::wait_for_readers() noexcept {
  // A reader that comes from here on, or that the loop below does not see, finds the homes empty.
  const std::uint64_t now = epoch_.fetch_add(1, std::memory_order_seq_cst);
  for (const ReaderSlot& slot : readers_) {
    for (;;) {
      const std::uint64_t entered = slot.epoch.load(std::memory_order_seq_cst);
      if (entered == 0 || entered > now) break;
      std::this_thread::yield();
    }
  }
}

std::unique_ptr<CachedTile> TileCache::take(std::size_t at) noexcept {
  std::unique_ptr<CachedTile> tile = std::move(tiles_[at]);
  tile->home->texels.store(nullptr, std::memory_order_seq_cst);
  bytes_ -= tile->bytes();
  tiles_[at] = std::move(tiles_.back());
  tiles_.pop_back();
  return tile;
}

void TileCache::evict(std::size_t bytes) noexcept {
  if (bytes_ + bytes <= max_bytes_) return;
  // Waiting for readers is worth more than one tile.
  const std::size_t wanted = bytes + max_bytes_ / 16;
  // Readers may use all tiles again and again: two rounds, then whatever comes.
  std::size_t spared = 2 * tiles_.size();
  while (!tiles_.empty() && bytes_ + wanted > max_bytes_) {
    hand_ = hand_ >= tiles_.size() ? 0 : hand_;
    if (spared > 0 && tiles_[hand_]->home->used.exchange(false, std::memory_order_relaxed)) {
      --spared;
      ++hand_;
      continue;
    }
    leaving_.push_back(take(hand_));
    ++evicted_;
  }
  wait_for_readers();
  leaving_.clear();
}

Result<void> TileCache::insert(TileHome& home, FloatBuffer texels, const Wanted* wanted) {
  const std::scoped_lock lock(mutex_);
  if (const float* const there = home.texels.load(std::memory_order_relaxed)) {
    if (wanted != nullptr) copy_from(there, *wanted);
    return {};
  }
  return guard_memory(
      [&]() -> Result<void> {
        auto tile = std::make_unique<CachedTile>();
        tile->texels = std::move(texels);
        tile->home = &home;
        // Room for all first: nothing may fail once tiles have left their homes.
        if (tiles_.size() == tiles_.capacity()) tiles_.reserve(2 * tiles_.size() + 16);
        leaving_.reserve(tiles_.capacity());
        evict(tile->bytes());
        bytes_ += tile->bytes();
        ++tiles_read_;
        if (wanted != nullptr) copy_from(tile->texels.data(), *wanted);
        home.used.store(true, std::memory_order_relaxed);
        home.texels.store(tile->texels.data(), std::memory_order_seq_cst);
        tiles_.push_back(std::move(tile));
        return {};
      },
      "not enough memory for a texture's tile");
}

bool TileCache::copy(const TileHome& home, const Wanted& wanted) {
  const std::scoped_lock lock(mutex_);
  const float* const texels = home.texels.load(std::memory_order_relaxed);
  if (texels != nullptr) copy_from(texels, wanted);
  return texels != nullptr;
}

void TileCache::forget(std::span<TileHome> homes) noexcept {
  const std::scoped_lock lock(mutex_);
  const TileHome* const first = homes.data();
  const TileHome* const last = first + homes.size();
  for (std::size_t i = 0; i < tiles_.size();) {
    const TileHome* const home = tiles_[i]->home;
    if (std::less_equal<>()(first, home) && std::less<>()(home, last)) {
      take(i);
    } else {
      ++i;
    }
  }
}

TextureCacheStats TileCache::stats() const {
  const std::scoped_lock lock(mutex_);
  TextureCacheStats out = {.tiles_read = tiles_read_,
                           .evicted = evicted_,
                           .tiles = tiles_.size(),
                           .bytes = bytes_,
                           .max_bytes = max_bytes_};
  for (const ReaderSlot& slot : readers_) {
    out.hits += slot.hits.load(std::memory_order_relaxed);
    out.misses += slot.misses.load(std::memory_order_relaxed);
  }
  return out;
}

}  // namespace spectile::io

namespace spectile {

Result<TextureCache> TextureCache::create(std::size_t max_bytes) {
  return guard_memory(
      [&]() -> Result<TextureCache> { return TextureCache(std::make_shared<io::TileCache>(max_bytes)); },
      "not enough memory for a cache");
}

TextureCacheStats TextureCache::stats() const {
  return tiles_->stats();
}

}  // namespace spectile
