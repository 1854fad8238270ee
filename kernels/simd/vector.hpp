// The vectors of a unit's instruction set and the seams that xsimd lacks: streaming stores, minima and maxima
// with a stated operand order, fused multiply-add. Those of some kernels only are in the other files here.
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

#include "kernels/abi/lanes.hpp"
#include "kernels/simd/isa.hpp"

namespace spectile::kernels {

#if defined(SPECTILE_KERNEL_AVX512)
using Arch = xsimd::avx512bw;
#elif defined(SPECTILE_KERNEL_AVX2)
using Arch = xsimd::avx2;
#elif defined(SPECTILE_KERNEL_SSE42)
using Arch = xsimd::sse4_2;
#elif defined(SPECTILE_KERNEL_NEON)
using Arch = xsimd::neon64;
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

static_assert(kWidth == F32::size);
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

/// One bit a lane: no bit of it is set.
inline std::uint64_t zero_lane_bits(U32 v) {
#if defined(SPECTILE_KERNEL_AVX512)
  return static_cast<std::uint64_t>(_mm512_testn_epi32_mask(v, v));
#elif defined(SPECTILE_KERNEL_AVX2)
  const __m256i zero = _mm256_cmpeq_epi32(v, _mm256_setzero_si256());
  return static_cast<std::uint64_t>(static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(zero))));
#elif defined(SPECTILE_KERNEL_SSE42)
  const __m128i zero = _mm_cmpeq_epi32(v, _mm_setzero_si128());
  return static_cast<std::uint64_t>(static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(zero))));
#else
  std::uint32_t lanes[kWidth];
  v.store_unaligned(lanes);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kWidth; ++i) bits |= static_cast<std::uint64_t>(lanes[i] == 0) << i;
  return bits;
#endif
}

/// Floats of a cache line.
inline constexpr std::size_t kLineFloats = 16;

/// Asks for a cache line that will be read soon; any address.
inline void prefetch(const float* p) {
  __builtin_prefetch(p);
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

// --- Minimum and maximum: which operand NaN and zeros of two signs give is stated here, since xsimd's own
// differ from version to version

/// v < lowest ? lowest : v. On x86 the maximum instruction does just that when v is its second operand.
inline F32 max(F32 lowest, F32 v) {
#if defined(SPECTILE_KERNEL_AVX512)
  return _mm512_max_ps(lowest, v);
#elif defined(SPECTILE_KERNEL_AVX2)
  return _mm256_max_ps(lowest, v);
#elif defined(SPECTILE_KERNEL_SSE42)
  return _mm_max_ps(lowest, v);
#else
  return xsimd::select(v < lowest, lowest, v);
#endif
}

/// highest < v ? highest : v.
inline F32 min(F32 highest, F32 v) {
#if defined(SPECTILE_KERNEL_AVX512)
  return _mm512_min_ps(highest, v);
#elif defined(SPECTILE_KERNEL_AVX2)
  return _mm256_min_ps(highest, v);
#elif defined(SPECTILE_KERNEL_SSE42)
  return _mm_min_ps(highest, v);
#else
  return xsimd::select(highest < v, highest, v);
#endif
}

// --- Division and square root, rounded once, as IEEE 754 defines them. On 64-bit Arm xsimd 8 makes both of
// estimates, which are the last bit off in a third of all cases

inline F32 divide(F32 a, F32 b) {
#if defined(SPECTILE_KERNEL_NEON)
  return vdivq_f32(a, b);
#else
  return a /= b;
#endif
}
/// Not to be used: divide() is.
F32 operator/(F32 a, F32 b) = delete;

inline F32 square_root(F32 v) {
#if defined(SPECTILE_KERNEL_NEON)
  return vsqrtq_f32(v);
#else
  return xsimd::sqrt(v);
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

// --- Fused multiply-add: a * b + c, rounded once, as IEEE 754 defines it

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

}  // namespace
}  // namespace spectile::kernels
