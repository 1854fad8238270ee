// Scalar twins of the element-wise kernels and of the folds over bands.
#include <bit>
#include <cmath>
#include <limits>

#include "kernels/abi.hpp"
#include "src/reference/twins.hpp"

namespace spectile::reference {

using kernels::kLanes;

void add(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = a[i] + b[i];
}

void subtract(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = a[i] - b[i];
}

void multiply(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = a[i] * b[i];
}

void divide(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = a[i] / b[i];
}

void divide_or_zero(float* dst, const float* a, const float* b, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = b[i] == 0.0F ? 0.0F : a[i] / b[i];
}

void negate(float* dst, const float* a, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = -a[i];
}

void complement(float* dst, const float* a, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = 1.0F - a[i];
}

void scale(float* dst, const float* a, float s, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = a[i] * s;
}

void multiply_add(float* dst, const float* a, const float* b, const float* c, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = a[i] * b[i] + c[i];
}

void lerp(float* dst, const float* a, const float* b, float t, std::size_t n) noexcept {
  const float rest = 1.0F - t;
  for (std::size_t i = 0; i < n; ++i) dst[i] = rest * a[i] + t * b[i];
}

void sqrt(float* dst, const float* a, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) dst[i] = std::sqrt(a[i]);
}

void clamp(float* dst, const float* a, float lo, float hi, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const float x = a[i];
    dst[i] = x < lo ? lo : (hi < x ? hi : x);
  }
}

void scale_lanes(float* dst, const float* a, const float* f, std::size_t bands, std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * bands * kLanes; ++i)
    dst[i] = a[i] * f[i / (bands * kLanes) * kLanes + i % kLanes];
}

void scale_bands(float* dst, const float* a, const float* s, std::size_t bands, std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * bands * kLanes; ++i) dst[i] = a[i] * s[i / kLanes % bands];
}

void multiply_add_lanes(float* dst, const float* a, const float* f, const float* c, std::size_t bands,
                        std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * bands * kLanes; ++i)
    dst[i] = a[i] * f[i / (bands * kLanes) * kLanes + i % kLanes] + c[i];
}

void lerp_lanes(float* dst, const float* a, const float* b, const float* t, std::size_t bands,
                std::size_t blocks) noexcept {
  for (std::size_t i = 0; i < blocks * bands * kLanes; ++i) {
    const float weight = t[i / (bands * kLanes) * kLanes + i % kLanes];
    dst[i] = (1.0F - weight) * a[i] + weight * b[i];
  }
}

void minimum(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      float least = std::numeric_limits<float>::infinity();
      for (std::size_t band = 0; band < bands; ++band) {
        const float s = spectra[(block * bands + band) * kLanes + lane];
        least = s < least ? s : least;
      }
      dst[block * kLanes + lane] = least;
    }
  }
}

void maximum(float* dst, const float* spectra, std::size_t bands, std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      float most = -std::numeric_limits<float>::infinity();
      for (std::size_t band = 0; band < bands; ++band) {
        const float s = spectra[(block * bands + band) * kLanes + lane];
        most = most < s ? s : most;
      }
      dst[block * kLanes + lane] = most;
    }
  }
}

namespace {

/// mask[block] has a lane's bit when `test` holds for its sample index in every band.
template <class Test>
void mask_all(std::uint64_t* mask, std::size_t bands, std::size_t blocks, Test test) {
  for (std::size_t block = 0; block < blocks; ++block) {
    mask[block] = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      bool all = true;
      for (std::size_t band = 0; band < bands; ++band)
        all = all && test((block * bands + band) * kLanes + lane);
      mask[block] |= static_cast<std::uint64_t>(all) << lane;
    }
  }
}

}  // namespace

void update_throughput(float* dst, std::uint64_t* ended, const float* a, const float* f, const float* density,
                       const float* u, std::size_t bands, std::size_t blocks) noexcept {
  for (std::size_t block = 0; block < blocks; ++block) {
    ended[block] = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const float by = density[block * kLanes + lane];
      float most = -std::numeric_limits<float>::infinity();
      for (std::size_t band = 0; band < bands; ++band) {
        const std::size_t at = (block * bands + band) * kLanes + lane;
        dst[at] = a[at] * f[at];
        most = most < dst[at] ? dst[at] : most;
      }
      const float divisor = u != nullptr && most < by ? most : by;
      const bool lives = divisor >= 0x1p-126F && (u == nullptr || u[block * kLanes + lane] * by < most);
      const float factor = 1.0F / divisor;
      for (std::size_t band = 0; band < bands; ++band) {
        const std::size_t at = (block * bands + band) * kLanes + lane;
        dst[at] = lives ? dst[at] * factor : 0.0F;
      }
      if (!lives && u != nullptr) ended[block] |= std::uint64_t{1} << lane;
    }
  }
}

void black_mask(std::uint64_t* mask, const float* spectra, std::size_t bands, std::size_t blocks) noexcept {
  // By its bits: a denormal is not 0, whatever the processor's mode.
  mask_all(mask, bands, blocks,
           [spectra](std::size_t i) { return (std::bit_cast<std::uint32_t>(spectra[i]) << 1U) == 0; });
}

void nan_mask(std::uint64_t* mask, const float* spectra, std::size_t bands, std::size_t blocks) noexcept {
  mask_all(mask, bands, blocks, [spectra](std::size_t i) { return !std::isnan(spectra[i]); });
  for (std::size_t block = 0; block < blocks; ++block) mask[block] = ~mask[block];
}

void equal_mask(std::uint64_t* mask, const float* a, const float* b, std::size_t bands,
                std::size_t blocks) noexcept {
  mask_all(mask, bands, blocks, [a, b](std::size_t i) { return a[i] == b[i]; });
}

}  // namespace spectile::reference
