// Scalar twins of the loops that find a machine's limits.
#include <algorithm>
#include <bit>
#include <cmath>

#include "kernels/abi.hpp"
#include "src/reference/twins.hpp"

namespace spectile::reference {

void peak_load(std::uint32_t* dst, const float* src, std::size_t n) noexcept {
  std::fill_n(dst, kernels::kLanes, 0U);
  for (std::size_t i = 0; i < n; ++i) dst[i % kernels::kLanes] ^= std::bit_cast<std::uint32_t>(src[i]);
}

void peak_store(float* dst, float value, std::size_t n, bool /*non_temporal*/) noexcept {
  std::fill_n(dst, n, value);
}

void peak_copy(float* dst, const float* src, std::size_t n) noexcept {
  std::copy_n(src, n, dst);
}

void peak_multiply_add(float* dst, const float* src, float m, float a, std::size_t steps,
                       std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    float x = src[i];
    for (std::size_t step = 0; step < steps; ++step) x = (x * m) + a;
    dst[i] = x;
  }
}

void peak_fused(float* dst, const float* src, float m, float a, std::size_t steps, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    float x = src[i];
    for (std::size_t step = 0; step < steps; ++step) x = std::fma(x, m, a);
    dst[i] = x;
  }
}

void peak_divide(float* dst, const float* src, float m, std::size_t steps, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    float x = src[i];
    for (std::size_t step = 0; step < steps; ++step) x = m / x;
    dst[i] = x;
  }
}

}  // namespace spectile::reference
