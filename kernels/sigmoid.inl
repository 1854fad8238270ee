// Sigmoids of quadratics: their samples, in blocks, in rows, and summed.
#pragma once

#include "kernels/colorimetry.inl"
#include "kernels/sigmoid_constants.hpp"
#include "kernels/simd.hpp"
#include "kernels/upsample.inl"

namespace spectile::kernels {
namespace {

/// Half the inverse square root of t.
inline F32 half_inverse_root(F32 t) noexcept {
  const F32 y0 = bits_as<float>(U32(kRootGuess) - (bits_as<std::uint32_t>(t) >> 1));
  const F32 f = (y0 * y0) * t;
  const F32 y1 = y0 * fused(f, f - F32(kRootSecond), F32(kRootFirst));
  return y1 * fused_minus(y1 * y1, t, F32(kRootThird));
}

/// Three coefficients of a vector of lanes.
struct Coefficients {
  F32 c[3];
};

struct SigmoidPoint {
  F32 sample, root;
};

inline SigmoidPoint sigmoid_point(const Coefficients& a, F32 lambda) noexcept {
  const F32 x = fused(fused(a.c[0], lambda, a.c[1]), lambda, a.c[2]);
  const F32 root = half_inverse_root(fused(x, x, F32(1.0F)));
  return {fused(x, root, F32(0.5F)), root};
}

inline F32 sigmoid_sample(const Coefficients& a, F32 lambda) noexcept {
  return min(F32(1.0F), max(F32(0.0F), sigmoid_point(a, lambda).sample));
}

/// A sample times the band's white and the lane's scale, where there are.
struct SigmoidLanes {
  Coefficients a;
  F32 scale;
};

inline SigmoidLanes load_lanes(const float* const c[3], const float* scale, std::size_t at) noexcept {
  SigmoidLanes out;
  for (std::size_t k = 0; k < 3; ++k) out.a.c[k] = load(c[k] + at);
  out.scale = scale == nullptr ? F32(1.0F) : load(scale + at);
  return out;
}

/// kScaled: with a scale or a white, whichever there are (a factor of 1 changes no bit).
template <bool kScaled>
inline F32 scaled_sample(const SigmoidLanes& lanes, F32 lambda, F32 white) noexcept {
  const F32 sample = sigmoid_sample(lanes.a, lambda);
  if constexpr (kScaled) return (sample * white) * lanes.scale;
  return sample;
}

/// Calls put(band, lane, sample) for every band and each vector of kLanes pixels from `at` on.
template <bool kScaled, std::size_t kTogether = kGroup, class Put>
inline void sigmoid_lanes(const float* const c[3], const float* scale, std::size_t at, const float* rows,
                          bool white, std::size_t bands, Put put) noexcept {
  for (std::size_t lane = 0; lane < kLanes; lane += kTogether * kWidth) {
    SigmoidLanes lanes[kTogether];
    for (std::size_t j = 0; j < kTogether; ++j) lanes[j] = load_lanes(c, scale, at + lane + j * kWidth);
    for (std::size_t band = 0; band < bands; ++band) {
      const float* row = rows + band * kSigmoidRow;
      const F32 lambda(row[kSigmoidLambda]);
      const F32 level(white ? row[kSigmoidWhite] : 1.0F);
      for (std::size_t j = 0; j < kTogether; ++j)
        put(band, lane + j * kWidth, scaled_sample<kScaled>(lanes[j], lambda, level));
    }
  }
}

template <bool kScaled>
inline void sigmoid_blocks_of(float* dst, const float* const c[3], const float* scale, const float* rows,
                              bool white, std::size_t bands, std::size_t blocks, bool streaming) noexcept {
  for (std::size_t block = 0; block < blocks; ++block, dst += bands * kLanes) {
    const auto at = block * kLanes;
    if (streaming) {
      sigmoid_lanes<kScaled, kWholeBlock>(
          c, scale, at, rows, white, bands,
          [dst](std::size_t band, std::size_t lane, F32 v) { stream(dst + band * kLanes + lane, v); });
    } else {
      sigmoid_lanes<kScaled>(
          c, scale, at, rows, white, bands,
          [dst](std::size_t band, std::size_t lane, F32 v) { store(dst + band * kLanes + lane, v); });
    }
  }
  if (streaming) stream_fence();
}

void sigmoid_blocks(float* dst, const float* const c[3], const float* scale, const float* rows, bool white,
                    std::size_t bands, std::size_t blocks, bool streaming) noexcept {
  if (scale != nullptr || white) {
    sigmoid_blocks_of<true>(dst, c, scale, rows, white, bands, blocks, streaming);
  } else {
    sigmoid_blocks_of<false>(dst, c, scale, rows, white, bands, blocks, streaming);
  }
}

template <class Sample>
inline void sigmoid_rows(void* const* out, const float* const c[3], const float* scale, const float* rows,
                         bool white, std::size_t bands, std::size_t n) noexcept {
  const std::size_t whole = n / kLanes * kLanes;
  for (std::size_t at = 0; at < whole; at += kLanes) {
    sigmoid_lanes<true>(c, scale, at, rows, white, bands,
                        [out, at](std::size_t band, std::size_t lane, F32 v) {
                          put_sample(static_cast<Sample*>(out[band]) + at + lane, v);
                        });
  }
  if (whole == n) return;
  // The rest of the row goes through a small buffer a band at a time: what follows a row's end is not ours.
  const std::size_t rest = n - whole;
  for (std::size_t band = 0; band < bands; ++band) {
    alignas(64) Sample tail[kLanes];
    const float* row = rows + band * kSigmoidRow;
    const F32 lambda(row[kSigmoidLambda]);
    const F32 level(white ? row[kSigmoidWhite] : 1.0F);
    for (std::size_t lane = 0; lane < rest; lane += kWidth) {
      const SigmoidLanes lanes = load_lanes(c, scale, whole + lane);
      put_sample(tail + lane, scaled_sample<true>(lanes, lambda, level));
    }
    std::memcpy(static_cast<Sample*>(out[band]) + whole, tail, rest * sizeof(Sample));
  }
}

void sigmoid_rows_float(void* const* out, const float* const c[3], const float* scale, const float* rows,
                        bool white, std::size_t bands, std::size_t n) noexcept {
  sigmoid_rows<float>(out, c, scale, rows, white, bands, n);
}

void sigmoid_rows_half(void* const* out, const float* const c[3], const float* scale, const float* rows,
                       bool white, std::size_t bands, std::size_t n) noexcept {
  sigmoid_rows<std::uint16_t>(out, c, scale, rows, white, bands, n);
}

void sigmoid_project(float* const dst[3], const float* const c[3], const float* scale, const float* rows,
                     bool white, const float* weights, std::size_t bands, std::size_t n) noexcept {
  for (std::size_t at = 0; at < n; at += kGroup * kWidth) {
    SigmoidLanes lanes[kGroup];
    F32 sums[kGroup][3];
    for (std::size_t j = 0; j < kGroup; ++j) {
      lanes[j] = load_lanes(c, scale, at + j * kWidth);
      for (auto& v : sums[j]) v = F32(0.0F);
    }
    for_runs(bands, [&](std::size_t first, std::size_t end) {
      F32 run[kGroup][3];
      for (auto& row : run) {
        for (auto& v : row) v = F32(0.0F);
      }
      for (std::size_t band = first; band < end; ++band) {
        const float* row = rows + band * kSigmoidRow;
        const F32 lambda(row[kSigmoidLambda]);
        const F32 level(white ? row[kSigmoidWhite] : 1.0F);
        for (std::size_t j = 0; j < kGroup; ++j) {
          const F32 sample = scaled_sample<true>(lanes[j], lambda, level);
          for (std::size_t k = 0; k < 3; ++k) run[j][k] = run[j][k] + F32(weights[4 * band + k]) * sample;
        }
      }
      for (std::size_t j = 0; j < kGroup; ++j) {
        for (std::size_t k = 0; k < 3; ++k) sums[j][k] = sums[j][k] + run[j][k];
      }
    });
    for (std::size_t j = 0; j < kGroup; ++j) {
      for (std::size_t k = 0; k < 3; ++k) store(dst[k] + at + j * kWidth, sums[j][k]);
    }
  }
}

}  // namespace
}  // namespace spectile::kernels
