// Quads of several pixels become lanes.
#pragma once

#include "kernels/simd/quads.hpp"

namespace spectile::kernels {
namespace {

// --- Quads to lanes. strided_quads: quads at base + at[0], at[4], at[8], ... of an array of
// places; strided_spread: the numbers at p[0], p[4], ..., each in all of a quad.

#if defined(SPECTILE_KERNEL_AVX512)
inline __m512 four_quads(const float* a, const float* b, const float* c, const float* d) {
  const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(a)), _mm_loadu_ps(b), 1);
  const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(c)), _mm_loadu_ps(d), 1);
  return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
}
inline F32 strided_quads(const float* base, const std::int32_t* at) {
  return four_quads(base + at[0], base + at[4], base + at[8], base + at[12]);
}
inline F32 strided_spread(const float* p) {
  const __m512 four = _mm512_castps128_ps512(_mm_setr_ps(p[0], p[4], p[8], p[12]));
  return _mm512_permutexvar_ps(_mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3), four);
}
inline void transpose_quads(F32 v[4]) {
  const __m512 ab_low = _mm512_unpacklo_ps(v[0], v[1]);
  const __m512 ab_high = _mm512_unpackhi_ps(v[0], v[1]);
  const __m512 cd_low = _mm512_unpacklo_ps(v[2], v[3]);
  const __m512 cd_high = _mm512_unpackhi_ps(v[2], v[3]);
  v[0] = _mm512_shuffle_ps(ab_low, cd_low, 0x44);
  v[1] = _mm512_shuffle_ps(ab_low, cd_low, 0xEE);
  v[2] = _mm512_shuffle_ps(ab_high, cd_high, 0x44);
  v[3] = _mm512_shuffle_ps(ab_high, cd_high, 0xEE);
}
#elif defined(SPECTILE_KERNEL_AVX2)
inline F32 strided_quads(const float* base, const std::int32_t* at) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(base + at[0])), _mm_loadu_ps(base + at[4]),
                              1);
}
inline F32 strided_spread(const float* p) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_broadcast_ss(p)), _mm_broadcast_ss(p + 4), 1);
}
inline void transpose_quads(F32 v[4]) {
  const __m256 ab_low = _mm256_unpacklo_ps(v[0], v[1]);
  const __m256 ab_high = _mm256_unpackhi_ps(v[0], v[1]);
  const __m256 cd_low = _mm256_unpacklo_ps(v[2], v[3]);
  const __m256 cd_high = _mm256_unpackhi_ps(v[2], v[3]);
  v[0] = _mm256_shuffle_ps(ab_low, cd_low, 0x44);
  v[1] = _mm256_shuffle_ps(ab_low, cd_low, 0xEE);
  v[2] = _mm256_shuffle_ps(ab_high, cd_high, 0x44);
  v[3] = _mm256_shuffle_ps(ab_high, cd_high, 0xEE);
}
#else
inline F32 strided_quads(const float* base, const std::int32_t* at) {
  return quad_load(base + at[0]);
}
inline F32 strided_spread(const float* p) {
  return quad_all(*p);
}
inline void transpose_quads(F32 v[4]) {
  Quad q[4] = {v[0], v[1], v[2], v[3]};
  quad_transpose(q[0], q[1], q[2], q[3]);
  for (std::size_t i = 0; i < 4; ++i) v[i] = q[i];
}
#endif

/// Rows of kWidth numbers become columns: out[i] has number i of each row.
inline void transpose_rows(F32 v[kWidth]) {
  for (std::size_t q = 0; q < kQuads; ++q) transpose_quads(v + 4 * q);
#if defined(SPECTILE_KERNEL_AVX512)
  // v[4 q + i] has, in quad k, number 4 k + i of the rows 4 q to 4 q + 3.
  F32 out[kWidth];
  for (std::size_t i = 0; i < 4; ++i) {
    const __m512 ab_low = _mm512_shuffle_f32x4(v[i], v[4 + i], 0x44);
    const __m512 ab_high = _mm512_shuffle_f32x4(v[i], v[4 + i], 0xEE);
    const __m512 cd_low = _mm512_shuffle_f32x4(v[8 + i], v[12 + i], 0x44);
    const __m512 cd_high = _mm512_shuffle_f32x4(v[8 + i], v[12 + i], 0xEE);
    out[i] = _mm512_shuffle_f32x4(ab_low, cd_low, 0x88);
    out[4 + i] = _mm512_shuffle_f32x4(ab_low, cd_low, 0xDD);
    out[8 + i] = _mm512_shuffle_f32x4(ab_high, cd_high, 0x88);
    out[12 + i] = _mm512_shuffle_f32x4(ab_high, cd_high, 0xDD);
  }
  for (std::size_t i = 0; i < kWidth; ++i) v[i] = out[i];
#elif defined(SPECTILE_KERNEL_AVX2)
  for (std::size_t i = 0; i < 4; ++i) {
    const __m256 a = v[i];
    const __m256 b = v[4 + i];
    v[i] = _mm256_permute2f128_ps(a, b, 0x20);
    v[4 + i] = _mm256_permute2f128_ps(a, b, 0x31);
  }
#endif
}

}  // namespace
}  // namespace spectile::kernels
