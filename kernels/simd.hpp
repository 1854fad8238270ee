// The architecture alias and the few seams that xsimd lacks: run-time table permute, half conversion,
// streaming store, widening to double, and maxima with a stated operand order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <xsimd/xsimd.hpp>

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "kernels/abi.hpp"

namespace spectile::kernels {

#if defined(SPECTILE_KERNEL_AVX512)
using Arch = xsimd::avx512bw;
#elif defined(SPECTILE_KERNEL_AVX2)
using Arch = xsimd::avx2;
#elif defined(SPECTILE_KERNEL_SSE42)
using Arch = xsimd::sse4_2;
#elif defined(SPECTILE_KERNEL_NEON)
using Arch = xsimd::neon64;
#else
#error "compile with one of SPECTILE_KERNEL_AVX512, _AVX2, _SSE42, _NEON"
#endif

// Internal linkage throughout: a function of one instruction set must never be what another one's caller
// links to.
namespace {

using F32 = xsimd::batch<float, Arch>;
using F64 = xsimd::batch<double, Arch>;
using I32 = xsimd::batch<std::int32_t, Arch>;
using U32 = xsimd::batch<std::uint32_t, Arch>;
using U64 = xsimd::batch<std::uint64_t, Arch>;
using Mask = xsimd::batch_bool<float, Arch>;

inline constexpr std::size_t kWidth = F32::size;
// Vectors of a block held in registers at once: 4 of 32 registers each on AVX-512, 2 of 16 elsewhere.
inline constexpr std::size_t kGroup = kWidth == 16 ? 4 : 2;
static_assert(kLanes % (kWidth * kGroup) == 0);

// xsimd 10 and later name the target's element, xsimd 8 its batch.
template <class To, class From>
inline xsimd::batch<To, Arch> bits_as(const xsimd::batch<From, Arch>& v) {
#if XSIMD_VERSION_MAJOR >= 10
  return xsimd::bitwise_cast<To>(v);
#else
  return xsimd::bitwise_cast<xsimd::batch<To, Arch> >(v);
#endif
}

inline F32 load(const float* p) {
  return F32::load_aligned(p);
}
inline F32 load_any(const float* p) {
  return F32::load_unaligned(p);
}
inline void store(float* p, F32 v) {
  v.store_aligned(p);
}
inline void store_any(float* p, F32 v) {
  v.store_unaligned(p);
}

/// a and b differ, NaN from everything. Not a != b: xsimd 8 makes that an ordered comparison, false for NaN,
/// on AVX and AVX-512 (and an unordered one on SSE).
inline Mask differ(F32 a, F32 b) {
  return ~(a == b);
}
inline Mask is_nan(F32 v) {
  return ~(v == v);
}

inline void stream(float* p, F32 v) {
#if defined(SPECTILE_KERNEL_AVX512)
  _mm512_stream_ps(p, v);
#elif defined(SPECTILE_KERNEL_AVX2)
  _mm256_stream_ps(p, v);
#elif defined(SPECTILE_KERNEL_SSE42)
  _mm_stream_ps(p, v);
#else
  v.store_aligned(p);
#endif
}

inline void stream_fence() {
#if defined(__x86_64__)
  _mm_sfence();
#endif
}

/// v < lowest ? lowest : v. On x86 the maximum instruction does just that when v is its second operand.
inline F32 limit_below(F32 lowest, F32 v) {
#if defined(__x86_64__)
  return xsimd::max(lowest, v);
#else
  return xsimd::select(v < lowest, lowest, v);
#endif
}

/// highest < v ? highest : v.
inline F32 limit_above(F32 highest, F32 v) {
#if defined(__x86_64__)
  return xsimd::min(highest, v);
#else
  return xsimd::select(highest < v, highest, v);
#endif
}

/// One bit a lane.
inline std::uint64_t lane_bits(Mask m) {
#if defined(SPECTILE_KERNEL_AVX512)
  return static_cast<std::uint64_t>(static_cast<__mmask16>(m));
#elif defined(SPECTILE_KERNEL_AVX2)
  return static_cast<std::uint64_t>(static_cast<unsigned>(_mm256_movemask_ps(m)));
#elif defined(SPECTILE_KERNEL_SSE42)
  return static_cast<std::uint64_t>(static_cast<unsigned>(_mm_movemask_ps(m)));
#else
  bool flags[kWidth];
  m.store_unaligned(flags);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kWidth; ++i) bits |= static_cast<std::uint64_t>(flags[i]) << i;
  return bits;
#endif
}

// --- A Smits row as a register, and indices prepared for its permute
// ---------------------------------------------

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

// --- Half conversion
// ----------------------------------------------------------------------------------------------

#if defined(SPECTILE_KERNEL_AVX512)
inline F32 load_half(const std::uint16_t* p) {
  return _mm512_cvtph_ps(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)));
}
inline void store_half(std::uint16_t* p, F32 v) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm512_cvtps_ph(v, _MM_FROUND_TO_NEAREST_INT));
}
#elif defined(SPECTILE_KERNEL_AVX2)
inline F32 load_half(const std::uint16_t* p) {
  return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
inline void store_half(std::uint16_t* p, F32 v) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm256_cvtps_ph(v, _MM_FROUND_TO_NEAREST_INT));
}
#elif defined(SPECTILE_KERNEL_NEON)
inline F32 load_half(const std::uint16_t* p) {
  return vcvt_f32_f16(vreinterpret_f16_u16(vld1_u16(p)));
}
inline void store_half(std::uint16_t* p, F32 v) {
  vst1_u16(p, vreinterpret_u16_f16(vcvt_f16_f32(v)));
}
#else
// SSE4.2 has no half conversion: integer arithmetic on the bits, a case each for normal, denormal and NaN.
inline F32 load_half(const std::uint16_t* p) {
  const __m128i h = _mm_cvtepu16_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
  const __m128i sign = _mm_slli_epi32(_mm_and_si128(h, _mm_set1_epi32(0x8000)), 16);
  const __m128i magnitude = _mm_and_si128(h, _mm_set1_epi32(0x7FFF));
  const __m128i shifted = _mm_slli_epi32(magnitude, 13);
  const __m128i normal = _mm_add_epi32(shifted, _mm_set1_epi32((127 - 15) << 23));
  // A denormal is its mantissa times 2^-24; both the conversion and the product are exact.
  const __m128 tiny = _mm_mul_ps(_mm_cvtepi32_ps(magnitude), _mm_set1_ps(5.9604644775390625e-8F));
  const __m128i is_tiny = _mm_cmplt_epi32(magnitude, _mm_set1_epi32(0x0400));
  const __m128i is_special = _mm_cmpgt_epi32(magnitude, _mm_set1_epi32(0x7BFF));
  const __m128i is_nan = _mm_cmpgt_epi32(magnitude, _mm_set1_epi32(0x7C00));
  const __m128i special = _mm_or_si128(_mm_or_si128(shifted, _mm_set1_epi32(0x7F800000)),
                                       _mm_and_si128(is_nan, _mm_set1_epi32(0x00400000)));
  __m128i out = _mm_blendv_epi8(normal, _mm_castps_si128(tiny), is_tiny);
  out = _mm_blendv_epi8(out, special, is_special);
  return _mm_castsi128_ps(_mm_or_si128(out, sign));
}
inline void store_half(std::uint16_t* p, F32 v) {
  const __m128i bits = _mm_castps_si128(v);
  const __m128i sign = _mm_and_si128(_mm_srli_epi32(bits, 16), _mm_set1_epi32(0x8000));
  const __m128i magnitude = _mm_and_si128(bits, _mm_set1_epi32(0x7FFFFFFF));
  // Normal: rebias, then round to nearest even by adding half of the last place less one, plus its lowest
  // bit.
  const __m128i odd = _mm_and_si128(_mm_srli_epi32(magnitude, 13), _mm_set1_epi32(1));
  const __m128i rounding = _mm_add_epi32(_mm_set1_epi32(static_cast<int>(0xC8000FFFU)), odd);
  const __m128i normal = _mm_srli_epi32(_mm_add_epi32(magnitude, rounding), 13);
  // Below 2^-14: adding 1/2 in float rounds at the half's last place, and leaves the mantissa in the low
  // bits.
  const __m128 half = _mm_set1_ps(0.5F);
  const __m128i tiny =
      _mm_sub_epi32(_mm_castps_si128(_mm_add_ps(_mm_castsi128_ps(magnitude), half)), _mm_castps_si128(half));
  const __m128i is_tiny = _mm_cmplt_epi32(magnitude, _mm_set1_epi32(113 << 23));
  const __m128i is_huge = _mm_cmpgt_epi32(magnitude, _mm_set1_epi32(0x477FEFFF));
  const __m128i is_nan = _mm_cmpgt_epi32(magnitude, _mm_set1_epi32(0x7F800000));
  const __m128i payload = _mm_or_si128(_mm_and_si128(_mm_srli_epi32(magnitude, 13), _mm_set1_epi32(0x3FF)),
                                       _mm_set1_epi32(0x7E00));
  __m128i out = _mm_blendv_epi8(normal, tiny, is_tiny);
  out = _mm_blendv_epi8(out, _mm_set1_epi32(0x7C00), is_huge);
  out = _mm_or_si128(_mm_blendv_epi8(out, payload, is_nan), sign);
  _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm_packus_epi32(out, out));
}
#endif

// --- Float to double and back, in two halves
// ----------------------------------------------------------------------

#if defined(SPECTILE_KERNEL_AVX512)
inline F64 widen_low(F32 v) {
  return _mm512_cvtps_pd(_mm512_castps512_ps256(v));
}
inline F64 widen_high(F32 v) {
  return _mm512_cvtps_pd(_mm512_extractf32x8_ps(v, 1));
}
inline F32 narrow(F64 low, F64 high) {
  return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(low)), _mm512_cvtpd_ps(high), 1);
}
#elif defined(SPECTILE_KERNEL_AVX2)
inline F64 widen_low(F32 v) {
  return _mm256_cvtps_pd(_mm256_castps256_ps128(v));
}
inline F64 widen_high(F32 v) {
  return _mm256_cvtps_pd(_mm256_extractf128_ps(v, 1));
}
inline F32 narrow(F64 low, F64 high) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(low)), _mm256_cvtpd_ps(high), 1);
}
#elif defined(SPECTILE_KERNEL_SSE42)
inline F64 widen_low(F32 v) {
  return _mm_cvtps_pd(v);
}
inline F64 widen_high(F32 v) {
  return _mm_cvtps_pd(_mm_movehl_ps(v, v));
}
inline F32 narrow(F64 low, F64 high) {
  return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
}
#elif defined(SPECTILE_KERNEL_NEON)
inline F64 widen_low(F32 v) {
  return vcvt_f64_f32(vget_low_f32(v));
}
inline F64 widen_high(F32 v) {
  return vcvt_high_f64_f32(v);
}
inline F32 narrow(F64 low, F64 high) {
  return vcvt_high_f32_f64(vcvt_f32_f64(low), high);
}
#endif

// --- Fused multiply-add: a * b + c, rounded once, as IEEE 754 defines it
// -----------------------------------------------------------------------------------------------

#if defined(SPECTILE_KERNEL_AVX512)
inline F32 fused(F32 a, F32 b, F32 c) {
  return _mm512_fmadd_ps(a, b, c);
}
inline F32 fused_minus(F32 a, F32 b, F32 c) {
  return _mm512_fnmadd_ps(a, b, c);
}
#elif defined(SPECTILE_KERNEL_AVX2)
inline F32 fused(F32 a, F32 b, F32 c) {
  return _mm256_fmadd_ps(a, b, c);
}
inline F32 fused_minus(F32 a, F32 b, F32 c) {
  return _mm256_fnmadd_ps(a, b, c);
}
#elif defined(SPECTILE_KERNEL_NEON)
inline F32 fused(F32 a, F32 b, F32 c) {
  return vfmaq_f32(c, a, b);
}
inline F32 fused_minus(F32 a, F32 b, F32 c) {
  return vfmsq_f32(c, a, b);
}
#else
// SSE4.2 has no such instruction. In double the product is exact; the sum is rounded to odd, so that rounding
// it to float is as rounding the exact value. Source: Boldo, Melquiond, Emulation of FMA and correctly
// rounded sums, IEEE Transactions on Computers 57(4), 2008.
inline __m128d sum_to_odd(__m128d product, __m128d c) {
  const __m128d sum = _mm_add_pd(product, c);
  const __m128d part = _mm_sub_pd(sum, product);
  const __m128d error = _mm_add_pd(_mm_sub_pd(product, _mm_sub_pd(sum, part)), _mm_sub_pd(c, part));
  const __m128d zero = _mm_setzero_pd();
  const __m128i inexact = _mm_castpd_si128(_mm_or_pd(_mm_cmplt_pd(error, zero), _mm_cmpgt_pd(error, zero)));
  const __m128i bits = _mm_castpd_si128(sum);
  const __m128i even = _mm_cmpeq_epi64(_mm_and_si128(bits, _mm_set1_epi64x(1)), _mm_setzero_si128());
  // One place away from zero where the error points there, else one towards it: even becomes odd either way.
  const __m128i opposite = _mm_cmpgt_epi64(_mm_setzero_si128(), _mm_xor_si128(bits, _mm_castpd_si128(error)));
  const __m128i step = _mm_or_si128(opposite, _mm_set1_epi64x(1));
  return _mm_castsi128_pd(_mm_add_epi64(bits, _mm_and_si128(_mm_and_si128(inexact, even), step)));
}
inline F32 fused(F32 a, F32 b, F32 c) {
  const __m128d low = sum_to_odd(_mm_mul_pd(_mm_cvtps_pd(a), _mm_cvtps_pd(b)), _mm_cvtps_pd(c));
  const __m128 ah = _mm_movehl_ps(a, a);
  const __m128 bh = _mm_movehl_ps(b, b);
  const __m128 ch = _mm_movehl_ps(c, c);
  const __m128d high = sum_to_odd(_mm_mul_pd(_mm_cvtps_pd(ah), _mm_cvtps_pd(bh)), _mm_cvtps_pd(ch));
  return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
}
inline F32 fused_minus(F32 a, F32 b, F32 c) {
  return fused(-a, b, c);
}
#endif

// --- Table look-up
// -----------------------------------------------------------------------------------------------

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

struct Pair {
  F32 first, second;
};

/// base[2 * index] and base[2 * index + 1], fetched together.
inline Pair gather_pair(const float* base, I32 index) {
#if defined(SPECTILE_KERNEL_AVX512)
  const auto* const pairs = reinterpret_cast<const double*>(base);
  const __m512i at = index;
  const __m512 low = _mm512_castpd_ps(_mm512_i32gather_pd(_mm512_castsi512_si256(at), pairs, 8));
  const __m512 high = _mm512_castpd_ps(_mm512_i32gather_pd(_mm512_extracti64x4_epi64(at, 1), pairs, 8));
  const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
  const __m512i odd = _mm512_add_epi32(even, _mm512_set1_epi32(1));
  return {_mm512_permutex2var_ps(low, even, high), _mm512_permutex2var_ps(low, odd, high)};
#elif defined(SPECTILE_KERNEL_AVX2)
  const auto* const pairs = reinterpret_cast<const double*>(base);
  const __m256i at = index;
  const __m256 low = _mm256_castpd_ps(_mm256_i32gather_pd(pairs, _mm256_castsi256_si128(at), 8));
  const __m256 high = _mm256_castpd_ps(_mm256_i32gather_pd(pairs, _mm256_extracti128_si256(at, 1), 8));
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
    first[i] = base[2 * at[i]];
    second[i] = base[2 * at[i] + 1];
  }
  return {F32::load_aligned(first), F32::load_aligned(second)};
#endif
}

}  // namespace
}  // namespace spectile::kernels
