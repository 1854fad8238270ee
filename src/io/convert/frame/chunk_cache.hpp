// ChunkCache: chunks that were encoded before, found again by the bytes that they were made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "src/io/convert/frame/line_stats.hpp"
#include "src/io/exr/exr_writer.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// A chunk's input, and what became of it once its slot is through with it.
struct KnownChunk {
  std::vector<std::byte> input;
  std::uint64_t hash = 0;
  PixelWindow window;
  std::vector<std::byte> output;
  LineStats stats;
  double seconds = 0;  ///< that it took
  bool encoded = false;
  std::size_t charged = 0;  ///< to the cache's account
};

/// Keeps the chunks that were used last, within a number of bytes.
class ChunkCache {
 public:
  explicit ChunkCache(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  struct Found {
    std::shared_ptr<KnownChunk> chunk;  ///< null for one that is too large to keep
    bool known = false;                 ///< true if it was there before
  };
  /// The chunk made of the same bytes, or a new one. Calls come one at a time, in the order of the lines.
  Found find(const Strip& strip, const PixelWindow& window);

  /// Completes a chunk that was new. May run beside every other call.
  void complete(KnownChunk& chunk, std::span<const std::byte> output, const LineStats& stats, double seconds);

 private:
  using Order = std::list<std::shared_ptr<KnownChunk>>;
  void shrink();

  std::size_t most_bytes_;
  std::mutex mutex_;
  std::size_t bytes_ = 0;
  Order order_;  // used last in front
  std::unordered_multimap<std::uint64_t, Order::iterator> by_hash_;
};

}  // namespace spectile::io
