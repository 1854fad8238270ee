// ChunkCache: chunks that were encoded before, found again by the bytes that they were made of.
#include "src/io/convert/frame/chunk_cache.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>

namespace spectile::io {
namespace {

/// Calls visit(bytes) for each row of a window of the strip. False from it ends the visit.
template <class Visit>
bool each_row(const Strip& strip, const PixelWindow& window, Visit visit) {
  for (int line = window.y0; line < window.y0 + window.height(); ++line) {
    for (std::size_t plane = 0; plane < strip.planes.size(); ++plane) {
      const std::size_t bytes = strip.sample_bytes(plane);
      const std::byte* const row = strip.row(plane, line) + static_cast<std::size_t>(window.x0) * bytes;
      if (!visit(std::span(row, static_cast<std::size_t>(window.width()) * bytes))) return false;
    }
  }
  return true;
}

/// A hash that goes over four words at a time; it need not be good, since bytes are compared afterwards.
class Hash {
 public:
  void add(std::span<const std::byte> bytes) {
    std::size_t at = 0;
    for (; at + 32 <= bytes.size(); at += 32) {
      for (std::size_t k = 0; k < 4; ++k) mix(state_[k], bytes.data() + at + 8 * k, 8);
    }
    for (; at < bytes.size(); at += 8)
      mix(state_[0], bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
  }
  std::uint64_t value() const {
    std::uint64_t out = 0;
    for (const std::uint64_t state : state_) out = (out ^ state) * kOdd;
    return out;
  }

 private:
  // 2^64 divided by the golden ratio.
  static constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15;
  static void mix(std::uint64_t& state, const std::byte* at, std::size_t n) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, n);
    state = std::rotl((state ^ word) * kOdd, 29);
  }
  std::uint64_t state_[4] = {1, 2, 3, 4};
};

bool equals(const KnownChunk& chunk, const Strip& strip, const PixelWindow& window) {
  if (chunk.window.width() != window.width() || chunk.window.height() != window.height()) return false;
  std::size_t at = 0;
  const bool same = each_row(strip, window, [&](std::span<const std::byte> row) {
    if (chunk.input.size() - at < row.size()) return false;
    if (std::memcmp(chunk.input.data() + at, row.data(), row.size()) != 0) return false;
    at += row.size();
    return true;
  });
  return same && at == chunk.input.size();
}

}  // namespace

ChunkCache::Found ChunkCache::find(const Strip& strip, const PixelWindow& window) {
  std::size_t size = 0;
  for (std::size_t plane = 0; plane < strip.planes.size(); ++plane) size += strip.sample_bytes(plane);
  size *= static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
  if (size == 0 || size > most_bytes_ / 4) return {};
  Hash hash;
  each_row(strip, window, [&](std::span<const std::byte> row) {
    hash.add(row);
    return true;
  });
  const std::scoped_lock lock(mutex_);
  const auto [begin, end] = by_hash_.equal_range(hash.value());
  for (auto it = begin; it != end; ++it) {
    if (!equals(**it->second, strip, window)) continue;
    order_.splice(order_.begin(), order_, it->second);
    return {order_.front(), true};
  }
  auto chunk = std::make_shared<KnownChunk>();
  chunk->hash = hash.value();
  chunk->window = window;
  chunk->input.reserve(size);
  each_row(strip, window, [&](std::span<const std::byte> row) {
    chunk->input.insert(chunk->input.end(), row.begin(), row.end());
    return true;
  });
  order_.push_front(chunk);
  by_hash_.emplace(chunk->hash, order_.begin());
  chunk->charged = size;
  bytes_ += size;
  shrink();
  return {std::move(chunk), false};
}

void ChunkCache::complete(KnownChunk& chunk, std::span<const std::byte> output, const LineStats& stats,
                          double seconds) {
  chunk.stats = stats;
  chunk.seconds = seconds;
  chunk.output.assign(output.begin(), output.end());
  chunk.encoded = true;
  const std::scoped_lock lock(mutex_);
  const auto [begin, end] = by_hash_.equal_range(chunk.hash);
  for (auto it = begin; it != end; ++it) {
    // One that had to go in the meantime is in nobody's account.
    if (it->second->get() != &chunk) continue;
    chunk.charged += output.size();
    bytes_ += output.size();
  }
  shrink();
}

void ChunkCache::shrink() {
  while (bytes_ > most_bytes_ && order_.size() > 1) {
    const auto last = std::prev(order_.end());
    bytes_ -= (*last)->charged;
    const auto [begin, end] = by_hash_.equal_range((*last)->hash);
    for (auto it = begin; it != end; ++it) {
      if (it->second != last) continue;
      by_hash_.erase(it);
      break;
    }
    order_.erase(last);
  }
}

}  // namespace spectile::io
