// Quads: four floats of one sample, whatever the register's width, and the limbs that they are added to.
#pragma once

#include "kernels/abi/film.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

/// Quads in a register of floats.
inline constexpr std::size_t kQuads = kWidth / 4;

/// The last component of each.
inline Mask quad_weights() {
  alignas(64) static constexpr float kPlace[16] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  return F32::load_aligned(kPlace) > F32(0.0F);
}

// Numbers, one a quad, in all four of its components; the largest of the first three components, in each of
// them (the last is left unspecified). RowSums: for each of kQuads samples a sum of rows of 8 numbers from a
// table, the first four times a ratio, the others times a part; total() adds both.
#if defined(SPECTILE_KERNEL_AVX512)
class RowSums {
 public:
  void add(const float* table, const std::int32_t* at, const float* ratio, const float* part) {
    const __m512 ratios = _mm512_castps128_ps512(_mm_loadu_ps(ratio));
    const __m512 parts = _mm512_castps128_ps512(_mm_loadu_ps(part));
    // 16 and on: the second source.
    const __m512i low = _mm512_setr_epi32(0, 0, 0, 0, 16, 16, 16, 16, 1, 1, 1, 1, 17, 17, 17, 17);
    const __m512i high = _mm512_setr_epi32(2, 2, 2, 2, 18, 18, 18, 18, 3, 3, 3, 3, 19, 19, 19, 19);
    const __m512 by_low = _mm512_permutex2var_ps(ratios, low, parts);
    const __m512 by_high = _mm512_permutex2var_ps(ratios, high, parts);
    low_ = _mm512_add_ps(low_, _mm512_mul_ps(two_rows(table + at[0], table + at[1]), by_low));
    high_ = _mm512_add_ps(high_, _mm512_mul_ps(two_rows(table + at[2], table + at[3]), by_high));
  }
  F32 total() const {
    return _mm512_add_ps(_mm512_shuffle_f32x4(low_, high_, 0x88), _mm512_shuffle_f32x4(low_, high_, 0xDD));
  }

 private:
  static __m512 two_rows(const float* a, const float* b) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(a)), _mm256_loadu_ps(b), 1);
  }
  __m512 low_ = _mm512_setzero_ps();
  __m512 high_ = _mm512_setzero_ps();
};
inline F32 spread_over_quads(const float* p) {
  const __m512i places = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
  return _mm512_permutexvar_ps(places, _mm512_castps128_ps512(_mm_loadu_ps(p)));
}
inline F32 max_of_three(F32 v) {
  const __m512 most = _mm512_max_ps(v, _mm512_permute_ps(v, 0xC9));
  return _mm512_max_ps(most, _mm512_permute_ps(v, 0xD2));
}
#elif defined(SPECTILE_KERNEL_AVX2)
class RowSums {
 public:
  void add(const float* table, const std::int32_t* at, const float* ratio, const float* part) {
    for (int q = 0; q < 2; ++q) {
      const __m256 by = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_broadcast_ss(ratio + q)),
                                             _mm_broadcast_ss(part + q), 1);
      sum_[q] = _mm256_add_ps(sum_[q], _mm256_mul_ps(_mm256_loadu_ps(table + at[q]), by));
    }
  }
  F32 total() const {
    return _mm256_add_ps(_mm256_permute2f128_ps(sum_[0], sum_[1], 0x20),
                         _mm256_permute2f128_ps(sum_[0], sum_[1], 0x31));
  }

 private:
  __m256 sum_[2] = {_mm256_setzero_ps(), _mm256_setzero_ps()};
};
inline F32 spread_over_quads(const float* p) {
  const __m128 pair = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
  return _mm256_permutevar8x32_ps(_mm256_castps128_ps256(pair), _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1));
}
inline F32 max_of_three(F32 v) {
  const __m256 most = _mm256_max_ps(v, _mm256_permute_ps(v, 0xC9));
  return _mm256_max_ps(most, _mm256_permute_ps(v, 0xD2));
}
#elif defined(SPECTILE_KERNEL_SSE42)
inline F32 spread_over_quads(const float* p) {
  return _mm_set1_ps(*p);
}
inline F32 max_of_three(F32 v) {
  const __m128 most = _mm_max_ps(v, _mm_shuffle_ps(v, v, 0xC9));
  return _mm_max_ps(most, _mm_shuffle_ps(v, v, 0xD2));
}
#else
inline F32 spread_over_quads(const float* p) {
  return vdupq_n_f32(*p);
}
inline F32 max_of_three(F32 v) {
  const float32x4_t all = v;
  const float32x4_t second = vdupq_n_f32(vgetq_lane_f32(all, 1));
  const float32x4_t third = vdupq_n_f32(vgetq_lane_f32(all, 2));
  return vmaxq_f32(vmaxq_f32(vdupq_n_f32(vgetq_lane_f32(all, 0)), second), third);
}
#endif

#if !defined(SPECTILE_KERNEL_AVX512) && !defined(SPECTILE_KERNEL_AVX2)
class RowSums {
 public:
  void add(const float* table, const std::int32_t* at, const float* ratio, const float* part) {
    values_ = values_ + load_any(table + at[0]) * F32(*ratio);
    differences_ = differences_ + load_any(table + at[0] + 4) * F32(*part);
  }
  F32 total() const { return values_ + differences_; }

 private:
  F32 values_ = F32(0.0F);
  F32 differences_ = F32(0.0F);
};
#endif

// --- One quad

#if defined(__x86_64__)
using Quad = __m128;
inline Quad quad_load(const float* p) {
  return _mm_loadu_ps(p);
}
inline Quad quad_all(float v) {
  return _mm_set1_ps(v);
}
inline void quad_store(float* p, Quad v) {
  _mm_storeu_ps(p, v);
}
inline Quad quad_multiply(Quad a, Quad b) {
  return _mm_mul_ps(a, b);
}
/// Rows of four quads become columns.
inline void quad_transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  _MM_TRANSPOSE4_PS(a, b, c, d);
}
#else
using Quad = float32x4_t;
inline Quad quad_load(const float* p) {
  return vld1q_f32(p);
}
inline Quad quad_all(float v) {
  return vdupq_n_f32(v);
}
inline void quad_store(float* p, Quad v) {
  vst1q_f32(p, v);
}
inline Quad quad_multiply(Quad a, Quad b) {
  return vmulq_f32(a, b);
}
/// Rows of four quads become columns.
inline void quad_transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const float32x4_t ab_low = vtrn1q_f32(a, b);
  const float32x4_t ab_high = vtrn2q_f32(a, b);
  const float32x4_t cd_low = vtrn1q_f32(c, d);
  const float32x4_t cd_high = vtrn2q_f32(c, d);
  a = vcombine_f32(vget_low_f32(ab_low), vget_low_f32(cd_low));
  b = vcombine_f32(vget_low_f32(ab_high), vget_low_f32(cd_high));
  c = vcombine_f32(vget_high_f32(ab_low), vget_high_f32(cd_low));
  d = vcombine_f32(vget_high_f32(ab_high), vget_high_f32(cd_high));
}
#endif

/// (v / size) * maximum where the size is larger than the maximum, else v.
inline Quad quad_clamped(Quad v, Quad size, float maximum) {
#if defined(__x86_64__)
  const Quad all = quad_all(maximum);
  return _mm_blendv_ps(v, _mm_mul_ps(_mm_div_ps(v, size), all), _mm_cmpgt_ps(size, all));
#else
  const Quad all = quad_all(maximum);
  return vbslq_f32(vcgtq_f32(size, all), vmulq_f32(vdivq_f32(v, size), all), v);
#endif
}

// --- Two doubles, and their counts of steps

#if defined(__x86_64__)
using Double2 = __m128d;
using Int2 = __m128i;
inline Double2 double2_load(const double* p) {
  return _mm_loadu_pd(p);
}
inline Double2 widen_first(Quad v) {
  return _mm_cvtps_pd(v);
}
inline Double2 widen_last(Quad v) {
  return _mm_cvtps_pd(_mm_movehl_ps(v, v));
}
inline Double2 double2_add(Double2 a, Double2 b) {
  return _mm_add_pd(a, b);
}
inline Double2 double2_subtract(Double2 a, Double2 b) {
  return _mm_sub_pd(a, b);
}
/// The bits of `sum` less those of `magic`.
inline Int2 steps_between(Double2 sum, Double2 magic) {
  return _mm_sub_epi64(_mm_castpd_si128(sum), _mm_castpd_si128(magic));
}
inline void add_steps(std::int64_t* p, Int2 v) {
  auto* const at = reinterpret_cast<__m128i*>(p);
  _mm_store_si128(at, _mm_add_epi64(_mm_load_si128(at), v));
}
inline Quad pair_load(const float* p) {
  return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
}
inline void prefetch(const void* p) {
  _mm_prefetch(static_cast<const char*>(p), _MM_HINT_T0);
}
#else
using Double2 = float64x2_t;
using Int2 = int64x2_t;
inline Double2 double2_load(const double* p) {
  return vld1q_f64(p);
}
inline Double2 widen_first(Quad v) {
  return vcvt_f64_f32(vget_low_f32(v));
}
inline Double2 widen_last(Quad v) {
  return vcvt_high_f64_f32(v);
}
inline Double2 double2_add(Double2 a, Double2 b) {
  return vaddq_f64(a, b);
}
inline Double2 double2_subtract(Double2 a, Double2 b) {
  return vsubq_f64(a, b);
}
/// The bits of `sum` less those of `magic`.
inline Int2 steps_between(Double2 sum, Double2 magic) {
  return vsubq_s64(vreinterpretq_s64_f64(sum), vreinterpretq_s64_f64(magic));
}
inline void add_steps(std::int64_t* p, Int2 v) {
  vst1q_s64(p, vaddq_s64(vld1q_s64(p), v));
}
inline Quad pair_load(const float* p) {
  return vcombine_f32(vld1_f32(p), vdup_n_f32(0));
}
inline void prefetch(const void* p) {
  __builtin_prefetch(p, 1);
}
#endif

/// Adds two numbers to their limbs: the coarse ones at `coarse`, the rests at `rest`.
inline void add_pair(std::int64_t* coarse, std::int64_t* rest, Double2 v, Double2 coarse_magic,
                     Double2 rest_magic) {
  const Double2 sum = double2_add(v, coarse_magic);
  const Double2 left = double2_subtract(v, double2_subtract(sum, coarse_magic));
  add_steps(coarse, steps_between(sum, coarse_magic));
  add_steps(rest, steps_between(double2_add(left, rest_magic), rest_magic));
}

/// Adds a quad to the kFilmQuadLimbs limbs of a pixel: coarse, then rests; 64-byte aligned.
static_assert(kFilmQuadLimbs == 8 && kFilmQuadRest == 4);
#if defined(SPECTILE_KERNEL_AVX512)
struct QuadGrid {
  __m256d coarse, rest;
  __m512i bits;  // of both
  __m512d coarse_twice, rest_twice;
  explicit QuadGrid(const FilmGrid& grid)
      : coarse(_mm256_loadu_pd(grid.coarse)),
        rest(_mm256_loadu_pd(grid.rest)),
        bits(_mm512_castpd_si512(_mm512_insertf64x4(_mm512_castpd256_pd512(coarse), rest, 1))),
        coarse_twice(_mm512_broadcast_f64x4(coarse)),
        rest_twice(_mm512_broadcast_f64x4(rest)) {}
};
inline void add_quad(std::int64_t* pixel, Quad v, const QuadGrid& grid) {
  const __m256d wide = _mm256_cvtps_pd(v);
  const __m256d sum = _mm256_add_pd(wide, grid.coarse);
  const __m256d left = _mm256_sub_pd(wide, _mm256_sub_pd(sum, grid.coarse));
  const __m256d small = _mm256_add_pd(left, grid.rest);
  const __m512d both = _mm512_insertf64x4(_mm512_castpd256_pd512(sum), small, 1);
  const __m512i steps = _mm512_sub_epi64(_mm512_castpd_si512(both), grid.bits);
  _mm512_store_si512(pixel, _mm512_add_epi64(_mm512_load_si512(pixel), steps));
}
/// The same for two quads side by side in memory; first and second may be one pixel.
inline void add_two_quads(std::int64_t* first, std::int64_t* second, const float* quads,
                          const QuadGrid& grid) {
  const __m512d wide = _mm512_cvtps_pd(_mm256_loadu_ps(quads));
  const __m512d sum = _mm512_add_pd(wide, grid.coarse_twice);
  const __m512d left = _mm512_sub_pd(wide, _mm512_sub_pd(sum, grid.coarse_twice));
  const __m512d small = _mm512_add_pd(left, grid.rest_twice);
  const __m512i one = _mm512_castpd_si512(_mm512_shuffle_f64x2(sum, small, 0x44));
  const __m512i two = _mm512_castpd_si512(_mm512_shuffle_f64x2(sum, small, 0xEE));
  _mm512_store_si512(first, _mm512_add_epi64(_mm512_load_si512(first), _mm512_sub_epi64(one, grid.bits)));
  _mm512_store_si512(second, _mm512_add_epi64(_mm512_load_si512(second), _mm512_sub_epi64(two, grid.bits)));
}
#elif defined(SPECTILE_KERNEL_AVX2)
struct QuadGrid {
  __m256d coarse, rest;
  explicit QuadGrid(const FilmGrid& grid)
      : coarse(_mm256_loadu_pd(grid.coarse)), rest(_mm256_loadu_pd(grid.rest)) {}
};
inline void add_quad(std::int64_t* pixel, Quad v, const QuadGrid& grid) {
  const __m256d wide = _mm256_cvtps_pd(v);
  const __m256d sum = _mm256_add_pd(wide, grid.coarse);
  const __m256d left = _mm256_sub_pd(wide, _mm256_sub_pd(sum, grid.coarse));
  const __m256d small = _mm256_add_pd(left, grid.rest);
  auto* const at = reinterpret_cast<__m256i*>(pixel);
  const __m256i coarse_steps = _mm256_sub_epi64(_mm256_castpd_si256(sum), _mm256_castpd_si256(grid.coarse));
  const __m256i rest_steps = _mm256_sub_epi64(_mm256_castpd_si256(small), _mm256_castpd_si256(grid.rest));
  _mm256_store_si256(at, _mm256_add_epi64(_mm256_load_si256(at), coarse_steps));
  _mm256_store_si256(at + 1, _mm256_add_epi64(_mm256_load_si256(at + 1), rest_steps));
}
#else
struct QuadGrid {
  Double2 coarse[2], rest[2];
  explicit QuadGrid(const FilmGrid& grid)
      : coarse{double2_load(grid.coarse), double2_load(grid.coarse + 2)},
        rest{double2_load(grid.rest), double2_load(grid.rest + 2)} {}
};
inline void add_quad(std::int64_t* pixel, Quad v, const QuadGrid& grid) {
  add_pair(pixel, pixel + kFilmQuadRest, widen_first(v), grid.coarse[0], grid.rest[0]);
  add_pair(pixel + 2, pixel + 2 + kFilmQuadRest, widen_last(v), grid.coarse[1], grid.rest[1]);
}
#endif

#if !defined(SPECTILE_KERNEL_AVX512)
/// Adds two quads side by side in memory; first and second may be one pixel.
inline void add_two_quads(std::int64_t* first, std::int64_t* second, const float* quads,
                          const QuadGrid& grid) {
  add_quad(first, quad_load(quads), grid);
  add_quad(second, quad_load(quads + 4), grid);
}
#endif

}  // namespace
}  // namespace spectile::kernels
