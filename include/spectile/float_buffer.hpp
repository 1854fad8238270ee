// FloatBuffer: 64-byte aligned, pooled memory of floats.
#pragma once

#include <cstddef>
#include <memory>
#include <spectile/result.hpp>

namespace spectile {

namespace detail {
struct PooledFree {
  std::size_t bytes = 0;
  void operator()(float* p) const noexcept;
};
}  // namespace detail

/// Owner of 64-byte aligned, pooled float memory; freed memory is kept for the next owner of that size.
class FloatBuffer {
 public:
  FloatBuffer() = default;
  /// Memory for `count` floats, not initialised. Errors: kOutOfMemory.
  static Result<FloatBuffer> create(std::size_t count);
  float* data() noexcept { return memory_.get(); }
  const float* data() const noexcept { return memory_.get(); }
  std::size_t size() const noexcept { return count_; }

 private:
  std::unique_ptr<float[], detail::PooledFree> memory_;
  std::size_t count_ = 0;
};

/// Gives pooled memory that nobody uses back to the operating system.
void release_pooled_memory() noexcept;

}  // namespace spectile
