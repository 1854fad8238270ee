// ZeroedPages: memory that starts as zeros, taken piece by piece and given back as a whole.
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

namespace spectile {

inline constexpr std::size_t kCacheLine = 64;
inline constexpr std::size_t kHugePage = std::size_t{2} << 20;

/// Pieces lie in slabs of huge pages where the system has them: random access to many pieces then misses the
/// address cache less. Thread-safe.
class ZeroedPages {
 public:
  ZeroedPages() = default;
  ZeroedPages(const ZeroedPages&) = delete;
  ZeroedPages& operator=(const ZeroedPages&) = delete;
  ~ZeroedPages();
  /// `bytes` zeros, 64-byte aligned; null where there is no memory.
  void* take(std::size_t bytes);

 private:
  struct Slab {
    void* data;
    std::size_t bytes;
  };
  std::mutex mutex_;
  std::vector<Slab> slabs_;
  std::byte* next_ = nullptr;
  std::size_t left_ = 0;
};

}  // namespace spectile
