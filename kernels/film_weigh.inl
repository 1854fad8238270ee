// Weighing film samples: colours as quads, bands as quads, hits of wavelengths in bands.
#pragma once

#include "kernels/abi/film.hpp"
#include "kernels/simd/quads.hpp"
#include "kernels/simd/runs.hpp"
#include "kernels/simd/tables.hpp"
#include "kernels/simd/vector.hpp"

namespace spectile::kernels {
namespace {

inline constexpr std::size_t kMaxFilmWavelengths = 64;

inline float magnitude(float v) noexcept {
  return v < 0.0F ? -v : v;
}

/// Faults of the numbers of a sample, for the few lanes where there may be any.
struct Faults {
  bool nan = false;
  bool infinite = false;
  bool negative = false;
  void scan(float v) noexcept {
    nan = nan || v != v;
    infinite = infinite || (v == v && v - v != 0.0F);
  }
  std::int32_t reason() const noexcept {
    return nan ? kFilmNan : infinite ? kFilmInfinite : negative ? kFilmNegative : kFilmAccepted;
  }
};

/// Clamps colours, weighs them and finds those beyond the film's range: a register of quads at a time.
class Weighing {
 public:
  Weighing(const FilmQuads& out, const FilmLimits& limits, const float* weight)
      : quads_(out.quads),
        luminance_(out.luminance),
        weight_(weight),
        clamps_(limits.maximum - limits.maximum == 0.0F),
        maximum_(limits.maximum),
        range_(limits.range),
        weight_range_(limits.weight_range),
        limit_(xsimd::select(quad_weights(), F32(limits.weight_range), F32(limits.range))) {}

  /// True if no contribution of kWidth samples from i on can be beyond the range, their colours having no
  /// component larger than `bound`.
  bool fits(std::size_t i, F32 bound) const noexcept {
    const F32 w = weight_ == nullptr ? F32(1.0F) : xsimd::abs(load_any(weight_ + i));
    Mask good = (bound * w <= F32(range_)) & (w <= F32(weight_range_));
    if (luminance_) good = good & (bound <= F32(range_));
    return lane_bits(~good) == 0;
  }

  /// The colours of kQuads samples from i on, their last components whatever they are.
  template <bool kScan>
  void put(std::size_t i, F32 color) noexcept {
    if (clamps_) {
      const F32 most = max_of_three(xsimd::abs(color));
      color = xsimd::select(most > maximum_, divide(color, most) * maximum_, color);
    }
    if (kScan && luminance_) put_luminance(i, color);
    F32 weighed = xsimd::select(quad_weights(), F32(1.0F), color);
    if (weight_ != nullptr) weighed = weighed * spread_over_quads(weight_ + i);
    if constexpr (kScan) beyond_ = beyond_ | ~(xsimd::abs(weighed) <= limit_);
    store_any(quads_ + 4 * i, weighed);
  }

  /// Reasons of the lanes put since the last time, where they have none yet.
  void find_beyond(std::int32_t* reasons, std::size_t first, std::size_t lanes) noexcept {
    if (lane_bits(beyond_) == 0) return;
    beyond_ = F32(0.0F) > F32(0.0F);
    for (std::size_t i = first; i < first + lanes; i += kQuads) {
      std::uint64_t bits = lane_bits(~(xsimd::abs(load_any(quads_ + 4 * i)) <= limit_));
      for (std::size_t q = 0; q < kQuads; ++q, bits >>= 4) {
        bool beyond = (bits & 15U) != 0;
        if (luminance_) beyond = beyond || !(magnitude(seen_[(i + q) % kLanes]) <= range_);
        if (beyond && reasons[i + q] == kFilmAccepted) reasons[i + q] = kFilmBeyondRange;
      }
    }
  }

 private:
  void put_luminance(std::size_t i, F32 color) noexcept {
    alignas(64) float c[kWidth];
    store(c, color);
    for (std::size_t q = 0; q < kQuads; ++q) seen_[(i + q) % kLanes] = c[4 * q + 1];
    beyond_ = beyond_ | ~(xsimd::abs(color) <= F32(range_));
  }

  float* quads_;
  bool luminance_;
  const float* weight_;
  bool clamps_;
  F32 maximum_;
  float range_;
  float weight_range_;
  F32 limit_;
  Mask beyond_ = F32(0.0F) > F32(0.0F);
  float seen_[kLanes] = {};  ///< luminances of the samples put last
};

inline std::int32_t fault_at(const FilmSamples& samples, std::size_t i) noexcept {
  Faults faults;
  const std::size_t at = samples.place(i);
  for (std::size_t k = 0; k < samples.count; ++k) {
    const float pdf = samples.density[k][at];
    if (pdf == 0.0F) continue;
    faults.scan(pdf);
    faults.scan(samples.lambda_nm[k][at]);
    faults.scan(samples.radiance[k][at] / pdf);
    faults.negative = faults.negative || pdf < 0.0F;
  }
  return faults.reason();
}

/// `Count` wavelengths, or those of the argument where it is 0: a count known to the compiler keeps the loop
/// over them in registers.
template <std::size_t Count>
inline void weigh_wavelengths(Weighing to, std::int32_t* reasons, const FilmSamples& given,
                              const FilmCurves& curves, float factor) noexcept {
  constexpr std::size_t kRoom = Count == 0 ? kMaxFilmWavelengths : Count;
  const FilmSamples samples = given;  // a copy that stores leave alone
  const std::size_t count = Count == 0 ? samples.count : Count;
  alignas(64) std::int32_t row[kRoom][kWidth];
  alignas(64) float ratio[kRoom][kWidth];
  alignas(64) float part[kRoom][kWidth];
  const F32 zero(0.0F);
  const F32 intervals(static_cast<float>(curves.intervals));
  const I32 beyond_curves(curves.intervals + 1);
  // No sum of rows is larger than this times the sum of the ratios, all roundings included.
  const float largest = curves.largest * factor * 1.001F;
  for (std::size_t i = 0; i < samples.n; i += kWidth) {
    const std::size_t at = samples.place(i);
    F32 everything = zero;
    F32 least = zero;
    F32 size = zero;
    for (std::size_t k = 0; k < count; ++k) {
      const F32 lambda = load_any(samples.lambda_nm[k] + at);
      const F32 pdf = load_any(samples.density[k] + at);
      const F32 weighted = xsimd::select(pdf == zero, zero, divide(load_any(samples.radiance[k] + at), pdf));
      const F32 t = lambda - F32(curves.first_nm);
      const Mask inside = (t >= zero) & (t <= intervals);
      const F32 safe = xsimd::select(inside, t, zero);
      const I32 interval = xsimd::to_int(safe);
      const F32 rows = xsimd::select(inside, bits_as<float>(interval), bits_as<float>(beyond_curves));
      (bits_as<std::int32_t>(rows) << 3).store_aligned(row[k]);
      store(ratio[k], weighted);
      store(part[k], (safe - xsimd::to_float(interval)) * weighted);
      // Not finite where a number is not: which it is, is found below.
      everything = everything + ((lambda + pdf) + weighted);
      least = min(least, pdf);
      size = size + xsimd::abs(weighted);
    }
    I32(0).store_unaligned(reasons + i);
    if (lane_bits(differ(everything * zero, zero) | (least < zero)) != 0) {
      for (std::size_t lane = 0; lane < kWidth; ++lane) {
        reasons[i + lane] = fault_at(samples, i + lane);
      }
    }
    const auto color_at = [&](std::size_t lane) {
      RowSums sums;
      for (std::size_t k = 0; k < count; ++k) {
        sums.add(curves.rows, row[k] + lane, ratio[k] + lane, part[k] + lane);
      }
      return sums.total() * F32(factor);
    };
    if (to.fits(i, size * F32(largest))) {
      for (std::size_t lane = 0; lane < kWidth; lane += kQuads) to.put<false>(i + lane, color_at(lane));
      continue;
    }
    for (std::size_t lane = 0; lane < kWidth; lane += kQuads) to.put<true>(i + lane, color_at(lane));
    to.find_beyond(reasons, i, kWidth);
  }
}

void film_weigh_wavelengths(const FilmQuads& out, const FilmSamples& samples, const FilmCurves& curves,
                            const FilmLimits& limits, float factor) noexcept {
  const Weighing to(out, limits, samples.weight);
  switch (samples.count) {
    case 4:
      return weigh_wavelengths<4>(to, out.reasons, samples, curves, factor);
    case 8:
      return weigh_wavelengths<8>(to, out.reasons, samples, curves, factor);
    default:
      return weigh_wavelengths<0>(to, out.reasons, samples, curves, factor);
  }
}

void film_weigh_bands(const FilmQuads& out, const FilmSamples& samples, const float* weights,
                      const FilmLimits& limits) noexcept {
  constexpr std::size_t kLanesAtOnce = kGroup * kWidth;
  Weighing to(out, limits, samples.weight);
  const float* const* const radiance = samples.radiance;
  std::int32_t* const reasons = out.reasons;
  const std::size_t bands = samples.count;
  const F32 zero(0.0F);
  alignas(64) float colors[3][kLanesAtOnce];
  alignas(64) float turned[4 * kLanesAtOnce];
  for (std::size_t i = 0; i < samples.n; i += kLanesAtOnce) {
    const std::size_t at = samples.place(i);
    F32 sums[3][kGroup];
    F32 strange = zero;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t g = 0; g < kGroup; ++g) sums[c][g] = zero;
    }
    for_runs(bands, [&](std::size_t first, std::size_t end) {
      F32 run[3][kGroup];
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t g = 0; g < kGroup; ++g) run[c][g] = zero;
      }
      for (std::size_t b = first; b < end; ++b) {
        for (std::size_t g = 0; g < kGroup; ++g) {
          const F32 sample = load_any(radiance[b] + at + g * kWidth);
          for (std::size_t c = 0; c < 3; ++c) run[c][g] = run[c][g] + F32(weights[4 * b + c]) * sample;
          strange = strange + sample * zero;
        }
      }
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t g = 0; g < kGroup; ++g) sums[c][g] = sums[c][g] + run[c][g];
      }
    });
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t g = 0; g < kGroup; ++g) store(colors[c] + g * kWidth, sums[c][g]);
    }
    const bool faulty = lane_bits(differ(strange, zero)) != 0;
    for (std::size_t lane = 0; lane < kLanesAtOnce; lane += 4) {
      Quad color[4] = {quad_load(colors[0] + lane), quad_load(colors[1] + lane), quad_load(colors[2] + lane),
                       quad_all(0.0F)};
      quad_transpose(color[0], color[1], color[2], color[3]);
      for (std::size_t j = 0; j < 4; ++j) {
        Faults faults;
        for (std::size_t b = 0; faulty && b < bands; ++b) faults.scan(radiance[b][at + lane + j]);
        reasons[i + lane + j] = faults.reason();
        quad_store(turned + 4 * (lane + j), color[j]);
      }
    }
    for (std::size_t lane = 0; lane < kLanesAtOnce; lane += kQuads)
      to.put<true>(i + lane, load(turned + 4 * lane));
    to.find_beyond(reasons, i, kLanesAtOnce);
  }
}

/// Reasons of the lanes whose bits are set, where they have none yet.
inline void raise(std::int32_t* reasons, std::uint64_t beyond) noexcept {
  for (std::size_t lane = 0; lane < kWidth; ++lane) {
    if (((beyond >> lane) & 1U) != 0 && reasons[lane] == kFilmAccepted) reasons[lane] = kFilmBeyondRange;
  }
}

void film_band_quads(float* quads, std::size_t stride, std::int32_t* reasons, const FilmSamples& samples,
                     const FilmLimits& limits) noexcept {
  const float* const* const radiance = samples.radiance;
  const float* const weight = samples.weight;
  const std::size_t bands = samples.count;
  const bool clamps = limits.maximum - limits.maximum == 0.0F;
  const F32 maximum(limits.maximum);
  const F32 range(limits.range);
  alignas(64) float by[kWidth];
  alignas(64) float sizes[kWidth];
  for (std::size_t i = 0; i < samples.n; i += kWidth) {
    const std::size_t place = samples.place(i);
    F32 most(0.0F);
    for (std::size_t b = 0; b < bands; ++b) {
      most = max(xsimd::abs(load_any(radiance[b] + place)), most);  // NaN ignored
    }
    const F32 w = weight == nullptr ? F32(1.0F) : load_any(weight + i);
    // A product grows with its factors, so the largest one tells for all.
    const F32 largest = clamps ? min(maximum, most) : most;
    const std::uint64_t beyond = lane_bits(~(xsimd::abs(largest * w) <= range));
    store(sizes, most);
    raise(reasons + i, beyond);
    store(by, w);
    for (std::size_t lane = 0; lane < kWidth; lane += 4) {
      float* const at = quads + (i + lane) * stride;
      const Quad factors = quad_load(by + lane);
      for (std::size_t b = 0; b < bands; b += 4) {
        Quad row[4];
        for (std::size_t j = 0; j < 4; ++j) {
          row[j] = quad_all(0.0F);
          if (b + j >= bands) continue;
          Quad sample = quad_load(radiance[b + j] + place + lane);
          if (clamps) sample = quad_clamped(sample, quad_load(sizes + lane), limits.maximum);
          row[j] = quad_multiply(sample, factors);
        }
        quad_transpose(row[0], row[1], row[2], row[3]);
        for (std::size_t j = 0; j < 4; ++j) quad_store(at + j * stride + b, row[j]);
      }
    }
  }
}

/// The band that each wavelength lies in, or -1.
inline I32 find_band(const BucketTable& table, F32 lambda) noexcept {
  const F32 first(table.edges[0]);
  const F32 last(table.edges[table.count - 1]);
  const Mask inside = (lambda >= first) & (lambda < last);
  const F32 safe = xsimd::select(inside, lambda, first);
  const I32 band = gather(table.band, last_knot(table.edges, table, safe));
  return bits_as<std::int32_t>(xsimd::select(inside, bits_as<float>(band), bits_as<float>(I32(-1))));
}

void film_hits(const FilmHits& out, const FilmSamples& given, const BucketTable& table,
               const FilmLimits& limits, float reference) noexcept {
  const FilmSamples samples = given;  // a copy that stores leave alone
  const std::size_t n = samples.n;
  const bool clamps = limits.maximum - limits.maximum == 0.0F;
  const F32 zero(0.0F);
  const F32 maximum(limits.maximum);
  alignas(64) float values[kWidth];
  alignas(64) float weights[kWidth];
  for (std::size_t i = 0; i < n; i += kWidth) {
    const std::size_t at = samples.place(i);
    const F32 w = samples.weight == nullptr ? F32(1.0F) : load_any(samples.weight + i);
    F32 most = zero;
    if (clamps) {
      for (std::size_t k = 0; k < samples.count; ++k) {
        const Mask dead = load_any(samples.density[k] + at) == zero;
        most = max(xsimd::select(dead, zero, xsimd::abs(load_any(samples.radiance[k] + at))), most);
      }
    }
    std::uint64_t beyond = 0;
    for (std::size_t k = 0; k < samples.count; ++k) {
      const F32 pdf = load_any(samples.density[k] + at);
      const Mask dead = pdf == zero;
      const F32 u = w * divide(F32(reference), pdf);
      F32 radiant = load_any(samples.radiance[k] + at);
      if (clamps) radiant = xsimd::select(most > maximum, divide(radiant, most) * maximum, radiant);
      const F32 value = radiant * u;
      const I32 bucket = find_band(table, load_any(samples.lambda_nm[k] + at));
      bits_as<std::int32_t>(xsimd::select(dead, bits_as<float>(I32(-1)), bits_as<float>(bucket)))
          .store_unaligned(out.band + k * n + i);
      const Mask fits =
          (xsimd::abs(value) <= F32(limits.range)) & (xsimd::abs(u) <= F32(limits.weight_range));
      const Mask outside = xsimd::to_float(bucket) < zero;
      beyond |= lane_bits(~(fits | dead | outside));
      store(values, value);
      store(weights, u);
      float* const to = out.values + 2 * (k * n + i);
      for (std::size_t lane = 0; lane < kWidth; ++lane) {
        to[2 * lane] = values[lane];
        to[2 * lane + 1] = weights[lane];
      }
    }
    raise(out.reasons + i, beyond);
  }
}

}  // namespace
}  // namespace spectile::kernels
