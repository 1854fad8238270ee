// Random numbers by counter: a path's numbers follow from its pixel, sample and seed alone.
#pragma once

#include <cstdint>

namespace tracer {

/// Fractional part of the golden ratio times 2^64.
inline constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;

/// Source: Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014 (variant 13 of
/// Stafford's finalizers).
constexpr std::uint64_t mix(std::uint64_t x) noexcept {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// Numbers of one path, by dimension.
class Random {
 public:
  Random() = default;
  Random(std::uint32_t pixel, std::uint32_t sample, std::uint32_t seed)
      : key_(mix(mix((std::uint64_t{sample} << 32U) | pixel) + seed * kGolden)) {}
  /// In [0, 1), multiples of 2^-24, so that float holds it.
  double operator()(std::uint32_t dimension) const noexcept {
    return static_cast<double>(mix(key_ + (dimension + 1) * kGolden) >> 40U) * 0x1p-24;
  }

 private:
  std::uint64_t key_ = 0;
};

/// Dimensions: those of the camera, then as many for each bounce.
enum Dimension : std::uint32_t {
  kPixelX,
  kPixelY,
  kWavelength,
  kFirstBounce = 8,
};
enum BounceDimension : std::uint32_t {
  kDirectionU,
  kDirectionV,
  kLightChoice,
  kLightU,
  kLightV,
  kRoulette,
  kFresnel,
  kBandChoice,
  kBounceDimensions,
};

constexpr std::uint32_t dimension(std::uint32_t bounce, BounceDimension d) noexcept {
  return kFirstBounce + bounce * kBounceDimensions + d;
}

}  // namespace tracer
