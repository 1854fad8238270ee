// This machine's own limits, compiled with -O3 -march=native.
#include "bench/micro/machine.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace machine {

#if defined(__AVX512F__)
using Vector = __m512;
inline Vector load(const float* p) {
  return _mm512_load_ps(p);
}
inline void store(float* p, Vector v) {
  _mm512_store_ps(p, v);
}
inline void stream(float* p, Vector v) {
  _mm512_stream_ps(p, v);
}
inline Vector set(float v) {
  return _mm512_set1_ps(v);
}
#elif defined(__AVX__)
using Vector = __m256;
inline Vector load(const float* p) {
  return _mm256_load_ps(p);
}
inline void store(float* p, Vector v) {
  _mm256_store_ps(p, v);
}
inline void stream(float* p, Vector v) {
  _mm256_stream_ps(p, v);
}
inline Vector set(float v) {
  return _mm256_set1_ps(v);
}
#elif defined(__x86_64__)
using Vector = __m128;
inline Vector load(const float* p) {
  return _mm_load_ps(p);
}
inline void store(float* p, Vector v) {
  _mm_store_ps(p, v);
}
inline void stream(float* p, Vector v) {
  _mm_stream_ps(p, v);
}
inline Vector set(float v) {
  return _mm_set1_ps(v);
}
#endif

#if defined(__x86_64__)

constexpr std::size_t kStep = sizeof(Vector) / sizeof(float);

void copy(float* dst, const float* src, std::size_t n) {
  for (std::size_t i = 0; i < n; i += 8 * kStep) {
    Vector v[8];
    for (std::size_t j = 0; j < 8; ++j) v[j] = load(src + i + j * kStep);
    for (std::size_t j = 0; j < 8; ++j) store(dst + i + j * kStep, v[j]);
  }
}

void stream_fill(float* dst, float value, std::size_t n) {
  const Vector v = set(value);
  for (std::size_t i = 0; i < n; i += 8 * kStep) {
    for (std::size_t j = 0; j < 8; ++j) stream(dst + i + j * kStep, v);
  }
  _mm_sfence();
}

void fill(float* dst, float value, std::size_t n) {
  const Vector v = set(value);
  for (std::size_t i = 0; i < n; i += 8 * kStep) {
    for (std::size_t j = 0; j < 8; ++j) store(dst + i + j * kStep, v);
  }
}

#else

void copy(float* dst, const float* src, std::size_t n) {
  std::memcpy(dst, src, n * sizeof(float));
}
void stream_fill(float* dst, float value, std::size_t n) {
  std::fill_n(dst, n, value);
}
void fill(float* dst, float value, std::size_t n) {
  std::fill_n(dst, n, value);
}

#endif

float multiply_adds(std::size_t n) {
  // As many independent chains as hide the latency: 16 vectors of up to 16 floats.
  constexpr std::size_t kChains = 256;
  float v[kChains];
  for (std::size_t i = 0; i < kChains; ++i) v[i] = static_cast<float>(i) * 1e-3F;
  for (std::size_t step = 0; step < n / kChains; ++step) {
#pragma GCC unroll 256
    for (std::size_t i = 0; i < kChains; ++i) v[i] = std::fma(v[i], 0.999F, 1e-3F);
  }
  float sum = 0;
  for (const float x : v) sum += x;
  return sum;
}

}  // namespace machine
