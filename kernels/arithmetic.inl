// Element-wise arithmetic over whole batches, and reductions of a lane over its bands.
#pragma once

#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

/// dst[i] = f(a[i]) in vectors, four at a time so that loads and stores overlap.
template <class F>
inline void map1(float* dst, const float* a, std::size_t n, F f) noexcept {
  for (std::size_t i = 0; i < n; i += 4 * kWidth) {
    for (std::size_t j = i; j < i + 4 * kWidth; j += kWidth) store(dst + j, f(load(a + j)));
  }
}

template <class F>
inline void map2(float* dst, const float* a, const float* b, std::size_t n, F f) noexcept {
  for (std::size_t i = 0; i < n; i += 4 * kWidth) {
    for (std::size_t j = i; j < i + 4 * kWidth; j += kWidth) store(dst + j, f(load(a + j), load(b + j)));
  }
}

void add(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  map2(dst, a, b, n, [](F32 x, F32 y) { return x + y; });
}

void subtract(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  map2(dst, a, b, n, [](F32 x, F32 y) { return x - y; });
}

void multiply(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  map2(dst, a, b, n, [](F32 x, F32 y) { return x * y; });
}

void divide(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  map2(dst, a, b, n, [](F32 x, F32 y) { return divide(x, y); });
}

void divide_or_zero(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  const F32 zero(0.0F);
  map2(dst, a, b, n, [zero](F32 x, F32 y) { return xsimd::select(y == zero, zero, divide(x, y)); });
}

void negate(float* dst, const float* a, std::size_t n) noexcept {
  const U32 sign_bit(0x80000000U);
  map1(dst, a, n, [sign_bit](F32 x) { return bits_as<float>(bits_as<std::uint32_t>(x) ^ sign_bit); });
}

void complement(float* dst, const float* a, std::size_t n) noexcept {
  const F32 one(1.0F);
  map1(dst, a, n, [one](F32 x) { return one - x; });
}

void scale(float* dst, const float* a, float s, std::size_t n) noexcept {
  const F32 factor(s);
  map1(dst, a, n, [factor](F32 x) { return x * factor; });
}

void multiply_add(float* dst, const float* a, const float* b, const float* c, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; i += kWidth) store(dst + i, load(a + i) * load(b + i) + load(c + i));
}

void lerp(float* dst, const float* a, const float* b, float t, std::size_t n) noexcept {
  const F32 weight_b(t);
  const F32 weight_a(1.0F - t);
  map2(dst, a, b, n, [=](F32 x, F32 y) { return weight_a * x + weight_b * y; });
}

void sqrt(float* dst, const float* a, std::size_t n) noexcept {
  map1(dst, a, n, [](F32 x) { return square_root(x); });
}

void clamp(float* dst, const float* a, float lo, float hi, std::size_t n) noexcept {
  const F32 low(lo);
  const F32 high(hi);
  map1(dst, a, n, [=](F32 x) { return xsimd::select(x < low, low, xsimd::select(high < x, high, x)); });
}

/// dst[i] = f(i, lane) in vectors: where a vector's samples lie, and where its lanes' own numbers do.
template <class F>
inline void map_lanes(float* dst, std::size_t bands, std::size_t blocks, F f) noexcept {
  std::size_t i = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t band = 0; band < bands; ++band) {
      for (std::size_t j = 0; j < kLanes; j += kWidth, i += kWidth) store(dst + i, f(i, block * kLanes + j));
    }
  }
}

void scale_lanes(float* dst, const float* a, const float* f, std::size_t bands, std::size_t blocks) noexcept {
  map_lanes(dst, bands, blocks,
            [=](std::size_t i, std::size_t lane) { return load(a + i) * load(f + lane); });
}

void scale_bands(float* dst, const float* a, const float* s, std::size_t bands, std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t band = 0; band < bands; ++band, dst += kLanes, a += kLanes)
      scale(dst, a, s[band], kLanes);
  }
}

void multiply_add_lanes(float* dst, const float* a, const float* f, const float* c, std::size_t bands,
                        std::size_t blocks) noexcept {
  map_lanes(dst, bands, blocks,
            [=](std::size_t i, std::size_t lane) { return load(a + i) * load(f + lane) + load(c + i); });
}

void lerp_lanes(float* dst, const float* a, const float* b, const float* t, std::size_t bands,
                std::size_t blocks) noexcept {
  const F32 one(1.0F);
  map_lanes(dst, bands, blocks, [=](std::size_t i, std::size_t lane) {
    const F32 weight = load(t + lane);
    return (one - weight) * load(a + i) + weight * load(b + i);
  });
}

/// Folds each lane's samples with `f`, from `start`.
template <class F>
inline void fold_bands(float* dst, const float* spectra, std::size_t bands, std::size_t blocks, float start,
                       F f) noexcept {
  for (std::size_t block = 0; block < blocks; ++block) {
    F32 state[kLanes / kWidth];
    for (auto& s : state) s = F32(start);
    for (std::size_t band = 0; band < bands; ++band, spectra += kLanes) {
      for (std::size_t j = 0; j < kLanes / kWidth; ++j) state[j] = f(state[j], load(spectra + j * kWidth));
    }
    for (std::size_t j = 0; j < kLanes / kWidth; ++j) store(dst + block * kLanes + j * kWidth, state[j]);
  }
}

void minimum(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept {
  fold_bands(dst, spectra, bands, blocks, __builtin_inff(),
             [](F32 least, F32 s) { return min(s, least); });  // s < least ? s : least
}

void maximum(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept {
  fold_bands(dst, spectra, bands, blocks, -__builtin_inff(),
             [](F32 most, F32 s) { return max(s, most); });  // most < s ? s : most
}

/// One bounce of a vector of lanes; the bits of those that end.
template <bool kRoulette>
inline std::uint64_t bounce(float* dst, const float* a, const float* f, F32 density, const float* u,
                            std::size_t bands) noexcept {
  const F32 zero(0.0F);
  const F32 one(1.0F);
  const F32 least(0x1p-126F);
  if constexpr (!kRoulette) {
    const F32 factor = divide(one, density);
    const Mask counts = density >= least;
    for (std::size_t at = 0; at < bands * kLanes; at += kLanes)
      store(dst + at, xsimd::select(counts, (load(a + at) * load(f + at)) * factor, zero));
    return 0;
  }
  F32 most(-__builtin_inff());
  for (std::size_t at = 0; at < bands * kLanes; at += kLanes) {
    const F32 product = load(a + at) * load(f + at);
    most = max(product, most);  // most < product ? product : most
    store(dst + at, product);
  }
  const F32 by = xsimd::select(most < density, most, density);
  const Mask lives = (by >= least) & (load(u) * density < most);
  const F32 factor = divide(one, by);
  for (std::size_t at = 0; at < bands * kLanes; at += kLanes)
    store(dst + at, xsimd::select(lives, load(dst + at) * factor, zero));
  return ~lane_bits(lives) & ((std::uint64_t{1} << (kWidth - 1) << 1) - 1);
}

void update_throughput(float* dst, std::uint64_t* ended, const float* a, const float* f, const float* density,
                       const float* u, std::size_t bands, std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block) {
    std::uint64_t bits = 0;
    for (std::size_t lane = 0; lane < kLanes; lane += kWidth) {
      const std::size_t at = block * bands * kLanes + lane;
      const F32 by = load(density + block * kLanes + lane);
      bits |= (u == nullptr ? bounce<false>(dst + at, a + at, f + at, by, nullptr, bands)
                            : bounce<true>(dst + at, a + at, f + at, by, u + block * kLanes + lane, bands))
              << lane;
    }
    ended[block] = bits;
  }
}

/// Lanes of a block whose sums of samples are NaN: those with a NaN sample, and some with infinities.
inline std::uint64_t maybe_nan(const float* block, std::size_t bands) noexcept {
  F32 sums[kLanes / kWidth];
  for (auto& s : sums) s = F32(0.0F);
  for (std::size_t band = 0; band < bands; ++band) {
    for (std::size_t j = 0; j < kLanes / kWidth; ++j) {
      sums[j] = sums[j] + load(block + band * kLanes + j * kWidth);
    }
  }
  std::uint64_t found = 0;
  for (std::size_t j = 0; j < kLanes / kWidth; ++j) found |= lane_bits(is_nan(sums[j])) << (j * kWidth);
  return found;
}

void nan_mask(std::uint64_t* mask, const float* spectra, std::size_t bands, std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block, spectra += bands * kLanes) {
    // One sum a sample finds the blocks that need a closer look, which are rare.
    std::uint64_t found = 0;
    if (maybe_nan(spectra, bands) != 0) {
      for (std::size_t i = 0; i < bands * kLanes; i += kWidth) {
        found |= lane_bits(is_nan(load(spectra + i))) << (i % kLanes);
      }
    }
    mask[block] = found;
  }
}

void black_mask(std::uint64_t* mask, const float* spectra, std::size_t bands, std::size_t blocks) noexcept {
  // All bits of a lane's samples together, without the sign that a zero may have.
  const U32 magnitude(0x7FFFFFFFU);
  constexpr std::size_t kVectors = kLanes / kWidth;
  constexpr std::size_t kRun = 8;  // bands between two looks whether any lane is still black
  for (std::size_t block = 0; block < blocks; ++block, spectra += bands * kLanes) {
    U32 bits[kVectors];
    for (auto& b : bits) b = U32(0U);
    std::uint64_t black = ~std::uint64_t{0};
    for (std::size_t first = 0; first < bands && black != 0; first += kRun) {
      const std::size_t end = bands - first < kRun ? bands : first + kRun;
      for (std::size_t band = first; band < end; ++band) {
        for (std::size_t j = 0; j < kVectors; ++j) {
          bits[j] = bits[j] | bits_as<std::uint32_t>(load(spectra + band * kLanes + j * kWidth));
        }
      }
      black = 0;
      for (std::size_t j = 0; j < kVectors; ++j) {
        // As integers: a denormal is not 0, whatever the processor's mode.
        black |= zero_lane_bits(bits[j] & magnitude) << (j * kWidth);
      }
    }
    mask[block] = black;
  }
}

void equal_mask(std::uint64_t* mask, const float* a, const float* b, std::size_t bands,
                std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block, a += bands * kLanes, b += bands * kLanes) {
    std::uint64_t equal = ~std::uint64_t{0};
    for (std::size_t band = 0; band < bands && equal != 0; ++band) {
      for (std::size_t j = 0; j < kLanes; j += kWidth) {
        const std::size_t i = band * kLanes + j;
        equal &= ~(lane_bits(differ(load(a + i), load(b + i))) << j);
      }
    }
    mask[block] = equal;
  }
}

}  // namespace
}  // namespace spectile::kernels
