// Pooled, 64-byte aligned memory: freed buffers wait for the next owner, because fresh pages cost more than
// the arithmetic done on them.
#include <sys/mman.h>

#include <cstdlib>
#include <map>
#include <mutex>
#include <spectile/float_buffer.hpp>
#include <vector>

#include "src/base/errors.hpp"
#include "src/base/zeroed_pages.hpp"

namespace spectile {
namespace {

// Maximum of unused memory in the pool; beyond it freed memory goes back at once.
constexpr std::size_t kMaxPooledBytes = std::size_t{256} << 20;

class Pool {
 public:
  ~Pool() { release(); }

  void* take(std::size_t bytes) {
    const std::scoped_lock lock(mutex_);
    auto it = free_.find(bytes);
    if (it == free_.end() || it->second.empty()) return nullptr;
    void* p = it->second.back();
    it->second.pop_back();
    pooled_bytes_ -= bytes;
    return p;
  }

  void give(void* p, std::size_t bytes) noexcept {
    try {
      const std::scoped_lock lock(mutex_);
      if (pooled_bytes_ + bytes <= kMaxPooledBytes) {
        free_[bytes].push_back(p);
        pooled_bytes_ += bytes;
        return;
      }
    } catch (...) {  // no memory to note the buffer: it is simply freed
    }
    std::free(p);
  }

  void release() noexcept {
    const std::scoped_lock lock(mutex_);
    for (auto& [bytes, list] : free_) {
      for (void* p : list) std::free(p);
    }
    free_.clear();
    pooled_bytes_ = 0;
  }

 private:
  std::mutex mutex_;
  std::map<std::size_t, std::vector<void*>> free_;
  std::size_t pooled_bytes_ = 0;
};

Pool& pool() {
  // Never destroyed: buffers with static storage may be freed after any destructor.
  static Pool* const instance = new Pool;
  return *instance;
}

std::size_t rounded(std::size_t bytes) {
  const std::size_t unit = bytes >= kHugePage ? kHugePage : kCacheLine;
  return (bytes + unit - 1) / unit * unit;
}

}  // namespace

namespace detail {
void PooledFree::operator()(float* p) const noexcept {
  pool().give(p, bytes);
}
}  // namespace detail

Result<FloatBuffer> FloatBuffer::create(std::size_t count) {
  constexpr std::size_t kMaxFloats = (std::size_t{1} << 62) / sizeof(float);
  if (count > kMaxFloats) return make_error(ErrorCode::kOutOfMemory, "{} floats do not fit in memory", count);
  const std::size_t bytes = rounded(count == 0 ? 1 : count * sizeof(float));
  void* p = pool().take(bytes);
  if (p == nullptr) {
    const std::size_t alignment = bytes >= kHugePage ? kHugePage : kCacheLine;
    p = std::aligned_alloc(alignment, bytes);
    if (p == nullptr) return make_error(ErrorCode::kOutOfMemory, "no memory for {} bytes of samples", bytes);
#ifdef MADV_HUGEPAGE
    if (bytes >= kHugePage) madvise(p, bytes, MADV_HUGEPAGE);
#endif
  }
  FloatBuffer buffer;
  buffer.memory_ = {static_cast<float*>(p), detail::PooledFree{bytes}};
  buffer.count_ = count;
  return buffer;
}

void release_pooled_memory() noexcept {
  pool().release();
}

}  // namespace spectile
