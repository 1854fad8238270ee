// SampledSpectrum: the samples of one lane as a value with operators, for scalar code.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <spectile/lanes/sampled_spectra.hpp>

namespace spectile {

/// K samples of one path or pixel, on bands or at its own wavelengths. Numbers: as the operations of
/// arithmetic.hpp on a lane, which are quicker for many.
template <std::size_t K>
class SampledSpectrum {
 public:
  constexpr SampledSpectrum() = default;
  constexpr explicit SampledSpectrum(float value) { samples_.fill(value); }
  constexpr explicit SampledSpectrum(const std::array<float, K>& samples) : samples_(samples) {}
  /// A lane of a batch of K samples; no bounds check.
  static SampledSpectrum of(const SampledSpectraView& batch, std::size_t lane) {
    SampledSpectrum out;
    for (std::size_t k = 0; k < K; ++k) out[k] = batch.at(lane, k);
    return out;
  }
  /// Writes the lane of a batch of K samples; no bounds check.
  void store(const SampledSpectraSpan& batch, std::size_t lane) const {
    for (std::size_t k = 0; k < K; ++k) batch.at(lane, k) = samples_[k];
  }

  static constexpr std::size_t size() noexcept { return K; }
  constexpr float& operator[](std::size_t k) noexcept { return samples_[k]; }
  constexpr float operator[](std::size_t k) const noexcept { return samples_[k]; }

  constexpr SampledSpectrum& operator+=(const SampledSpectrum& b) {
    return each(b, [](float x, float y) { return x + y; });
  }
  constexpr SampledSpectrum& operator-=(const SampledSpectrum& b) {
    return each(b, [](float x, float y) { return x - y; });
  }
  constexpr SampledSpectrum& operator*=(const SampledSpectrum& b) {
    return each(b, [](float x, float y) { return x * y; });
  }
  constexpr SampledSpectrum& operator/=(const SampledSpectrum& b) {
    return each(b, [](float x, float y) { return x / y; });
  }
  constexpr SampledSpectrum& operator*=(float b) { return *this *= SampledSpectrum(b); }
  constexpr SampledSpectrum& operator/=(float b) { return *this /= SampledSpectrum(b); }
  friend constexpr SampledSpectrum operator+(SampledSpectrum a, const SampledSpectrum& b) { return a += b; }
  friend constexpr SampledSpectrum operator-(SampledSpectrum a, const SampledSpectrum& b) { return a -= b; }
  friend constexpr SampledSpectrum operator*(SampledSpectrum a, const SampledSpectrum& b) { return a *= b; }
  friend constexpr SampledSpectrum operator/(SampledSpectrum a, const SampledSpectrum& b) { return a /= b; }
  friend constexpr SampledSpectrum operator*(SampledSpectrum a, float b) { return a *= b; }
  friend constexpr SampledSpectrum operator*(float a, SampledSpectrum b) { return b *= a; }
  friend constexpr SampledSpectrum operator/(SampledSpectrum a, float b) { return a /= b; }
  constexpr SampledSpectrum operator-() const {
    SampledSpectrum out = *this;
    for (float& v : out.samples_) v = -v;
    return out;
  }
  /// NaN equals nothing, +0 equals -0.
  friend constexpr bool operator==(const SampledSpectrum&, const SampledSpectrum&) = default;

  /// True if a sample is not 0, NaN included.
  constexpr explicit operator bool() const {
    return std::ranges::any_of(samples_, [](float v) { return v != 0; });
  }
  constexpr bool has_nan() const {
    return std::ranges::any_of(samples_, [](float v) { return v != v; });
  }
  /// NaN is passed over; of nothing but NaN an infinity.
  constexpr float min_value() const {
    float out = std::numeric_limits<float>::infinity();
    for (const float v : samples_) out = v < out ? v : out;
    return out;
  }
  constexpr float max_value() const {
    float out = -std::numeric_limits<float>::infinity();
    for (const float v : samples_) out = out < v ? v : out;
    return out;
  }
  /// Of samples that count alike; for bands of unequal widths see average() of batches.
  constexpr float average() const {
    float sum = 0;
    for (const float v : samples_) sum += v;
    return sum / static_cast<float>(K);
  }

 private:
  template <class F>
  constexpr SampledSpectrum& each(const SampledSpectrum& b, F f) {
    for (std::size_t k = 0; k < K; ++k) samples_[k] = f(samples_[k], b[k]);
    return *this;
  }
  std::array<float, K> samples_{};
};

/// a / b, 0 where b is 0; a NaN divisor gives NaN.
template <std::size_t K>
constexpr SampledSpectrum<K> divide_or_zero(SampledSpectrum<K> a, const SampledSpectrum<K>& b) {
  for (std::size_t k = 0; k < K; ++k) a[k] = b[k] == 0 ? 0 : a[k] / b[k];
  return a;
}

/// (1 - t) a + t b; exactly a at t = 0 and b at t = 1 for finite samples.
template <std::size_t K>
constexpr SampledSpectrum<K> lerp(const SampledSpectrum<K>& a, const SampledSpectrum<K>& b, float t) {
  return (1 - t) * a + t * b;
}

/// Samples limited to lowest and highest; NaN stays.
template <std::size_t K>
constexpr SampledSpectrum<K> clamp(SampledSpectrum<K> a, float lowest, float highest) {
  for (std::size_t k = 0; k < K; ++k) a[k] = a[k] < lowest ? lowest : (highest < a[k] ? highest : a[k]);
  return a;
}

/// By the C library, sample by sample.
template <std::size_t K>
SampledSpectrum<K> sqrt(SampledSpectrum<K> a) {
  for (std::size_t k = 0; k < K; ++k) a[k] = std::sqrt(a[k]);
  return a;
}
template <std::size_t K>
SampledSpectrum<K> exp(SampledSpectrum<K> a) {
  for (std::size_t k = 0; k < K; ++k) a[k] = std::exp(a[k]);
  return a;
}
template <std::size_t K>
SampledSpectrum<K> pow(SampledSpectrum<K> a, float exponent) {
  for (std::size_t k = 0; k < K; ++k) a[k] = std::pow(a[k], exponent);
  return a;
}

}  // namespace spectile
