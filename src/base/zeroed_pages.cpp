// ZeroedPages, from anonymous mappings.
#include "src/base/zeroed_pages.hpp"

#include <sys/mman.h>

#include <cstdint>

namespace spectile {
namespace {

/// A mapping that starts at a huge page's border. Null where there is no memory.
void* map_aligned(std::size_t bytes) {
  const std::size_t with_slack = bytes + kHugePage;
  void* const raw = mmap(nullptr, with_slack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (raw == MAP_FAILED) return nullptr;
  auto* const start = static_cast<std::byte*>(raw);
  const std::size_t before = (kHugePage - reinterpret_cast<std::uintptr_t>(start) % kHugePage) % kHugePage;
  if (before > 0) munmap(start, before);
  const std::size_t after = kHugePage - before;
  if (after > 0) munmap(start + before + bytes, after);
  // A hint: without huge pages everything works, a little slower.
  static_cast<void>(madvise(start + before, bytes, MADV_HUGEPAGE));
  return start + before;
}

}  // namespace

ZeroedPages::~ZeroedPages() {
  for (const Slab& slab : slabs_) munmap(slab.data, slab.bytes);
}

void* ZeroedPages::take(std::size_t bytes) {
  if (bytes > SIZE_MAX / 4) return nullptr;
  const std::size_t piece = (bytes + kCacheLine - 1) / kCacheLine * kCacheLine;
  const std::scoped_lock lock(mutex_);
  if (piece > left_) {
    const std::size_t slab_bytes = (piece + kHugePage - 1) / kHugePage * kHugePage;
    void* const data = map_aligned(slab_bytes);
    if (data == nullptr) return nullptr;
    try {
      slabs_.push_back({data, slab_bytes});
    } catch (...) {
      munmap(data, slab_bytes);
      return nullptr;
    }
    next_ = static_cast<std::byte*>(data);
    left_ = slab_bytes;
  }
  void* const out = next_;
  next_ += piece;
  left_ -= piece;
  return out;
}

}  // namespace spectile
