// The machine's own limits with this instruction set's vectors: nothing but loads, stores, arithmetic.
#pragma once

#include "kernels/abi/arithmetic.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

void peak_load(std::uint32_t* dst, const float* src, std::size_t n) noexcept {
  constexpr std::size_t kVectors = kLanes / kWidth;
  U32 sums[kVectors];
  for (auto& s : sums) s = U32(0U);
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t j = 0; j < kVectors; ++j) {
      sums[j] = sums[j] ^ bits_as<std::uint32_t>(load(src + i + j * kWidth));
    }
  }
  for (std::size_t j = 0; j < kVectors; ++j) sums[j].store_unaligned(dst + j * kWidth);
}

void peak_store(float* dst, float value, std::size_t n, bool non_temporal) noexcept {
  const F32 v(value);
  if (non_temporal) {
    for (std::size_t i = 0; i < n; i += kLanes) {
      for (std::size_t j = 0; j < kLanes; j += kWidth) stream(dst + i + j, v);
    }
    stream_fence();
    return;
  }
  for (std::size_t i = 0; i < n; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; j += kWidth) store(dst + i + j, v);
  }
}

void peak_copy(float* dst, const float* src, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; i += kLanes) {
    F32 v[kLanes / kWidth];
    for (std::size_t j = 0; j < kLanes / kWidth; ++j) v[j] = load(src + i + j * kWidth);
    for (std::size_t j = 0; j < kLanes / kWidth; ++j) store(dst + i + j * kWidth, v[j]);
  }
}

/// x = f(x), `steps` times, in as many chains at a time as hide an operation's latency and fit into
/// registers.
template <class F>
inline void iterate(float* dst, const float* src, std::size_t steps, std::size_t n, F f) noexcept {
  constexpr std::size_t kChains = kWidth == 16 ? 24 : 12;  // of 32 registers, of 16
  static_assert(kPeakChains % (kChains * kWidth) == 0);
  for (std::size_t i = 0; i < n; i += kChains * kWidth) {
    F32 x[kChains];
#pragma GCC unroll 24
    for (std::size_t j = 0; j < kChains; ++j) x[j] = load(src + i + j * kWidth);
#pragma GCC unroll 4
    for (std::size_t step = 0; step < steps; ++step) {
#pragma GCC unroll 24
      for (std::size_t j = 0; j < kChains; ++j) x[j] = f(x[j]);
    }
#pragma GCC unroll 24
    for (std::size_t j = 0; j < kChains; ++j) store(dst + i + j * kWidth, x[j]);
  }
}

void peak_multiply_add(float* dst, const float* src, float m, float a, std::size_t steps,
                       std::size_t n) noexcept {
  const F32 factor(m);
  const F32 term(a);
  iterate(dst, src, steps, n, [=](F32 x) { return x * factor + term; });
}

void peak_fused(float* dst, const float* src, float m, float a, std::size_t steps, std::size_t n) noexcept {
  const F32 factor(m);
  const F32 term(a);
  iterate(dst, src, steps, n, [=](F32 x) { return fused(x, factor, term); });
}

void peak_divide(float* dst, const float* src, float m, std::size_t steps, std::size_t n) noexcept {
  const F32 dividend(m);
  iterate(dst, src, steps, n, [=](F32 x) { return divide(dividend, x); });
}

}  // namespace
}  // namespace spectile::kernels
