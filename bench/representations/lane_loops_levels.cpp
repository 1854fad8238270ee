// Loops over lanes. One translation unit, compiled once per level of the processor; see lane_loops.hpp.
//
// No algorithms or containers here: what the linker would share between levels must not be compiled for one.
#include "bench/representations/lane_loops.hpp"

namespace spectile::measure {
namespace {

/// Lanes of a vector register: more of eight sums do not stay in registers.
#if defined(__AVX512F__)
constexpr std::size_t kTogether = 16;
#elif defined(__AVX__)
constexpr std::size_t kTogether = 8;
#else
constexpr std::size_t kTogether = 4;
#endif

template <std::size_t kCount>
void apply(float* __restrict out, const float* __restrict in, const float* __restrict matrix,
           std::size_t blocks) {
  constexpr std::size_t kEntries = kCount * (kCount + 1) / 2;
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t lane = 0; lane < kLoopLanes; lane += kTogether) {
      const float* const from = in + block * kCount * kLoopLanes + lane;
      const float* entry = matrix + block * kEntries * kLoopLanes + lane;
      float sums[kCount][kTogether] = {};
#pragma GCC unroll 8
      for (std::size_t j = 0; j < kCount; ++j) {
#pragma GCC unroll 8
        for (std::size_t k = 0; k <= j; ++k, entry += kLoopLanes) {
          for (std::size_t l = 0; l < kTogether; ++l) sums[j][l] += entry[l] * from[k * kLoopLanes + l];
          if (k == j) continue;
          for (std::size_t l = 0; l < kTogether; ++l) sums[k][l] += entry[l] * from[j * kLoopLanes + l];
        }
      }
      float* const to = out + block * kCount * kLoopLanes + lane;
#pragma GCC unroll 8
      for (std::size_t j = 0; j < kCount; ++j) {
        for (std::size_t l = 0; l < kTogether; ++l) to[j * kLoopLanes + l] = sums[j][l];
      }
    }
  }
}

/// T_i T_j = (T_(i + j) + T_|i - j|) / 2.
void multiply_chebyshev(float* __restrict out, const float* __restrict a, const float* __restrict b,
                        std::size_t polynomials) {
  for (std::size_t p = 0; p < polynomials; ++p, out += kTerms * kLoopLanes) {
    const float* const u = a + p * kTerms * kLoopLanes;
    const float* const v = b + p * kTerms * kLoopLanes;
    for (std::size_t l = 0; l < kLoopLanes; ++l) {
      const float u0 = u[l];
      const float u1 = u[kLoopLanes + l];
      const float u2 = u[2 * kLoopLanes + l];
      const float u3 = u[3 * kLoopLanes + l];
      const float v0 = v[l];
      const float v1 = v[kLoopLanes + l];
      const float v2 = v[2 * kLoopLanes + l];
      const float v3 = v[3 * kLoopLanes + l];
      out[l] = u0 * v0 + 0.5F * (u1 * v1 + u2 * v2 + u3 * v3);
      out[kLoopLanes + l] = u0 * v1 + u1 * v0 + 0.5F * (u1 * v2 + u2 * v1 + u2 * v3 + u3 * v2);
      out[2 * kLoopLanes + l] = u0 * v2 + u2 * v0 + 0.5F * (u1 * v1 + u1 * v3 + u3 * v1);
      out[3 * kLoopLanes + l] = u0 * v3 + u3 * v0 + 0.5F * (u1 * v2 + u2 * v1);
    }
  }
}

void weigh(float* __restrict xyz, const float* __restrict product, const float* __restrict weights,
           std::size_t n, std::size_t blocks) {
  for (std::size_t block = 0; block < blocks; ++block) {
    float sums[3][kLoopLanes] = {};
    for (std::size_t i = 0; i < n; ++i, product += kLoopLanes) {
      for (std::size_t k = 0; k < 3; ++k, weights += kLoopLanes) {
        for (std::size_t l = 0; l < kLoopLanes; ++l) sums[k][l] += product[l] * weights[l];
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t l = 0; l < kLoopLanes; ++l) xyz[(k * blocks + block) * kLoopLanes + l] = sums[k][l];
    }
  }
}

}  // namespace

extern const LaneLoops SPECTILE_LANE_LOOPS;
constexpr LaneLoops SPECTILE_LANE_LOOPS = {
    SPECTILE_LEVEL_TEXT, {apply<4>, apply<8>}, multiply_chebyshev, weigh};

}  // namespace spectile::measure
