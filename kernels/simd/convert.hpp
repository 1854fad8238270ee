// Between half, float and double.
#pragma once

#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

// --- Half conversion

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

}  // namespace
}  // namespace spectile::kernels
