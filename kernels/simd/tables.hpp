// Tables in registers and in memory: the permute of a Smits row, and gathers.
#pragma once

#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

// --- A Smits row as a register, and indices prepared for its permute

#if defined(SPECTILE_KERNEL_AVX512)
using Row = __m512;
using Index = __m512i;
inline Row load_row(const float* row) {
  return _mm512_broadcast_f32x8(_mm256_load_ps(row));
}
inline Index prepare(I32 index) {
  return index;
}
inline F32 secondary(const Row& row, const Index& index) {
  return _mm512_permutexvar_ps(index, row);
}
inline F32 primary(const Row& row, const Index& index) {
  return _mm512_permutexvar_ps(index, row);
}
#elif defined(SPECTILE_KERNEL_AVX2)
using Row = __m256;
using Index = __m256i;
inline Row load_row(const float* row) {
  return _mm256_load_ps(row);
}
inline Index prepare(I32 index) {
  return index;
}
inline F32 secondary(const Row& row, const Index& index) {
  return _mm256_permutevar8x32_ps(row, index);
}
inline F32 primary(const Row& row, const Index& index) {
  return _mm256_permutevar8x32_ps(row, index);
}
#elif defined(SPECTILE_KERNEL_SSE42)
// Two registers of four entries; a byte shuffle takes the low two bits of the index, spread over the lane's
// bytes.
struct Row {
  __m128i low, high;
};
using Index = __m128i;
inline Row load_row(const float* row) {
  return {_mm_castps_si128(_mm_load_ps(row)), _mm_castps_si128(_mm_load_ps(row + 4))};
}
inline Index prepare(I32 index) {
  const __m128i low = _mm_and_si128(index, _mm_set1_epi32(3));
  return _mm_add_epi32(_mm_mullo_epi32(low, _mm_set1_epi32(0x04040404)), _mm_set1_epi32(0x03020100));
}
inline F32 secondary(const Row& row, const Index& index) {
  return _mm_castsi128_ps(_mm_shuffle_epi8(row.low, index));
}
inline F32 primary(const Row& row, const Index& index) {
  return _mm_castsi128_ps(_mm_shuffle_epi8(row.high, index));
}
#elif defined(SPECTILE_KERNEL_NEON)
struct Row {
  uint8x16_t low, high;
};
using Index = uint8x16_t;
inline Row load_row(const float* row) {
  return {vreinterpretq_u8_f32(vld1q_f32(row)), vreinterpretq_u8_f32(vld1q_f32(row + 4))};
}
inline Index prepare(I32 index) {
  const int32x4_t low = vandq_s32(index, vdupq_n_s32(3));
  return vreinterpretq_u8_s32(vaddq_s32(vmulq_n_s32(low, 0x04040404), vdupq_n_s32(0x03020100)));
}
inline F32 secondary(const Row& row, const Index& index) {
  return vreinterpretq_f32_u8(vqtbl1q_u8(row.low, index));
}
inline F32 primary(const Row& row, const Index& index) {
  return vreinterpretq_f32_u8(vqtbl1q_u8(row.high, index));
}
#endif

// --- Table look-up

/// base[index] in each lane.
inline F32 gather(const float* base, I32 index) {
#if defined(SPECTILE_KERNEL_AVX512)
  return _mm512_i32gather_ps(index, base, 4);
#elif defined(SPECTILE_KERNEL_AVX2)
  return _mm256_i32gather_ps(base, index, 4);
#else
  alignas(64) std::int32_t at[kWidth];
  alignas(64) float out[kWidth];
  index.store_aligned(at);
  for (std::size_t i = 0; i < kWidth; ++i) out[i] = base[at[i]];
  return F32::load_aligned(out);
#endif
}

/// base[index] for 32-bit integers.
inline I32 gather(const std::int32_t* base, I32 index) {
#if defined(SPECTILE_KERNEL_AVX512)
  return _mm512_i32gather_epi32(index, base, 4);
#elif defined(SPECTILE_KERNEL_AVX2)
  return _mm256_i32gather_epi32(base, index, 4);
#else
  alignas(64) std::int32_t at[kWidth];
  alignas(64) std::int32_t out[kWidth];
  index.store_aligned(at);
  for (std::size_t i = 0; i < kWidth; ++i) out[i] = base[at[i]];
  return I32::load_aligned(out);
#endif
}

/// The last knot at or below `at`, which is neither NaN nor below the first one: from that which `start`
/// names for its bucket, in steps halved from 2^(halvings - 1) to 1. Table: KnotTable or BucketTable.
template <class Table>
inline I32 last_knot(const float* knots, const Table& table, F32 at) {
  const F32 most(static_cast<float>(table.buckets - 1));
  const F32 bucket = min(most, (at - F32(knots[0])) * F32(table.buckets_per_nm));
  I32 knot = gather(table.start, xsimd::to_int(bucket));
  for (std::int32_t step = (1 << table.halvings) >> 1; step > 0; step >>= 1) {
    const I32 next = knot + I32(step);
    const Mask below = gather(knots, next) <= at;
    // A selection moves bits, whatever they stand for.
    knot = bits_as<std::int32_t>(xsimd::select(below, bits_as<float>(next), bits_as<float>(knot)));
  }
  return knot;
}

struct Pair {
  F32 first, second;
};

/// base[kStep * index] and the float after it, fetched together; kStep: 1, or 2 for a table of pairs.
template <int kStep>
inline Pair gather_two(const float* base, I32 index) {
#if defined(SPECTILE_KERNEL_AVX512)
  constexpr int kBytes = kStep * 4;
  const auto* const pairs = reinterpret_cast<const double*>(base);
  const __m512i at = index;
  const __m512 low = _mm512_castpd_ps(_mm512_i32gather_pd(_mm512_castsi512_si256(at), pairs, kBytes));
  const __m512 high = _mm512_castpd_ps(_mm512_i32gather_pd(_mm512_extracti64x4_epi64(at, 1), pairs, kBytes));
  const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
  const __m512i odd = _mm512_add_epi32(even, _mm512_set1_epi32(1));
  return {_mm512_permutex2var_ps(low, even, high), _mm512_permutex2var_ps(low, odd, high)};
#elif defined(SPECTILE_KERNEL_AVX2)
  constexpr int kBytes = kStep * 4;
  const auto* const pairs = reinterpret_cast<const double*>(base);
  const __m256i at = index;
  const __m256 low = _mm256_castpd_ps(_mm256_i32gather_pd(pairs, _mm256_castsi256_si128(at), kBytes));
  const __m256 high = _mm256_castpd_ps(_mm256_i32gather_pd(pairs, _mm256_extracti128_si256(at, 1), kBytes));
  // The shuffles leave the middle halves swapped.
  const auto in_order = [](__m256 v) {
    return _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(v), 0xD8));
  };
  return {in_order(_mm256_shuffle_ps(low, high, 0x88)), in_order(_mm256_shuffle_ps(low, high, 0xDD))};
#else
  alignas(64) std::int32_t at[kWidth];
  alignas(64) float first[kWidth];
  alignas(64) float second[kWidth];
  index.store_aligned(at);
  for (std::size_t i = 0; i < kWidth; ++i) {
    first[i] = base[kStep * at[i]];
    second[i] = base[kStep * at[i] + 1];
  }
  return {F32::load_aligned(first), F32::load_aligned(second)};
#endif
}

/// Entry `index` of a table of pairs.
inline Pair gather_pair(const float* base, I32 index) {
  return gather_two<2>(base, index);
}

}  // namespace
}  // namespace spectile::kernels
