// Sigmoids over bands: their samples in blocks and in rows, and their projection.
#pragma once

#include "kernels/simd/runs.hpp"
#include "kernels/upsampling/sigmoid_point.inl"
#include "kernels/upsampling/smits.inl"

namespace spectile::kernels {
namespace {

/// Coefficients and scale of a vector of lanes.
struct SigmoidLanes {
  Coefficients a;
  F32 scale;
};

inline SigmoidLanes load_lanes(const SigmoidSpectra& s, std::size_t at) noexcept {
  SigmoidLanes out;
  for (std::size_t k = 0; k < 3; ++k) out.a.c[k] = load(s.c[k] + at);
  out.scale = s.scale == nullptr ? F32(1.0F) : load(s.scale + at);
  return out;
}

/// The functions and the white of a band.
template <class Form>
struct BandPoint {
  Form at;
  F32 white;
  BandPoint(const SigmoidSpectra& s, std::size_t band) noexcept
      : at(s.rows + band * kSigmoidRow), white(s.white ? s.rows[band * kSigmoidRow + kSigmoidWhite] : 1.0F) {}
};

/// kScaled: with a scale or a white, whichever there are (a factor of 1 changes no bit).
template <bool kScaled, class Form>
inline F32 scaled_sample(const SigmoidLanes& lanes, const BandPoint<Form>& point) noexcept {
  const F32 sample = sigmoid_sample(lanes.a, point.at);
  if constexpr (kScaled) return (sample * point.white) * lanes.scale;
  return sample;
}

/// Calls put(band, lane, sample) for every band and each vector of kLanes pixels from `at` on.
template <bool kScaled, class Form, std::size_t kTogether = kGroup, class Put>
inline void sigmoid_lanes(const SigmoidSpectra& s, std::size_t at, Put put) noexcept {
  for (std::size_t lane = 0; lane < kLanes; lane += kTogether * kWidth) {
    SigmoidLanes lanes[kTogether];
    for (std::size_t j = 0; j < kTogether; ++j) lanes[j] = load_lanes(s, at + lane + j * kWidth);
    for (std::size_t band = 0; band < s.bands; ++band) {
      const BandPoint<Form> point(s, band);
      for (std::size_t j = 0; j < kTogether; ++j)
        put(band, lane + j * kWidth, scaled_sample<kScaled>(lanes[j], point));
    }
  }
}

template <bool kScaled, class Form>
inline void put_blocks(float* dst, const SigmoidSpectra& spectra, std::size_t blocks,
                       bool non_temporal) noexcept {
  const SigmoidSpectra s = spectra;  // a copy that stores through dst leave alone
  for (std::size_t block = 0; block < blocks; ++block, dst += s.bands * kLanes) {
    const auto at = block * kLanes;
    if (non_temporal) {
      sigmoid_lanes<kScaled, Form, kWholeBlock>(
          s, at, [dst](std::size_t band, std::size_t lane, F32 v) { stream(dst + band * kLanes + lane, v); });
    } else {
      sigmoid_lanes<kScaled, Form>(
          s, at, [dst](std::size_t band, std::size_t lane, F32 v) { store(dst + band * kLanes + lane, v); });
    }
  }
  if (non_temporal) stream_fence();
}

void sigmoid_blocks(float* dst, const SigmoidSpectra& spectra, std::size_t blocks,
                    bool non_temporal) noexcept {
  with_form(spectra.form, [&](auto form) {
    if (spectra.scale != nullptr || spectra.white) {
      put_blocks<true, decltype(form)>(dst, spectra, blocks, non_temporal);
    } else {
      put_blocks<false, decltype(form)>(dst, spectra, blocks, non_temporal);
    }
  });
}

template <class Sample, class Form>
inline void sigmoid_rows(void* const* rows, const SigmoidSpectra& spectra, std::size_t n) noexcept {
  const SigmoidSpectra s = spectra;
  const std::size_t whole = n / kLanes * kLanes;
  for (std::size_t at = 0; at < whole; at += kLanes) {
    sigmoid_lanes<true, Form>(s, at, [rows, at](std::size_t band, std::size_t lane, F32 v) {
      put_sample(static_cast<Sample*>(rows[band]) + at + lane, v);
    });
  }
  if (whole == n) return;
  // The rest of the row goes through a small buffer a band at a time: what follows a row's end is not ours.
  const std::size_t rest = n - whole;
  for (std::size_t band = 0; band < s.bands; ++band) {
    alignas(64) Sample tail[kLanes];
    const BandPoint<Form> point(s, band);
    for (std::size_t lane = 0; lane < rest; lane += kWidth) {
      put_sample(tail + lane, scaled_sample<true>(load_lanes(s, whole + lane), point));
    }
    std::memcpy(static_cast<Sample*>(rows[band]) + whole, tail, rest * sizeof(Sample));
  }
}

void sigmoid_rows_float(void* const* rows, const SigmoidSpectra& spectra, std::size_t n) noexcept {
  with_form(spectra.form, [&](auto form) { sigmoid_rows<float, decltype(form)>(rows, spectra, n); });
}

void sigmoid_rows_half(void* const* rows, const SigmoidSpectra& spectra, std::size_t n) noexcept {
  with_form(spectra.form, [&](auto form) { sigmoid_rows<std::uint16_t, decltype(form)>(rows, spectra, n); });
}

template <class Form>
inline void project_sigmoids(float* const dst[3], const SigmoidSpectra& spectra, const float* weights,
                             std::size_t n) noexcept {
  const SigmoidSpectra s = spectra;
  for (std::size_t at = 0; at < n; at += kGroup * kWidth) {
    SigmoidLanes lanes[kGroup];
    F32 sums[kGroup][3];
    for (std::size_t j = 0; j < kGroup; ++j) {
      lanes[j] = load_lanes(s, at + j * kWidth);
      for (auto& v : sums[j]) v = F32(0.0F);
    }
    for_runs(s.bands, [&](std::size_t first, std::size_t end) {
      F32 run[kGroup][3];
      for (auto& row : run) {
        for (auto& v : row) v = F32(0.0F);
      }
      for (std::size_t band = first; band < end; ++band) {
        const BandPoint<Form> point(s, band);
        for (std::size_t j = 0; j < kGroup; ++j) {
          const F32 sample = scaled_sample<true>(lanes[j], point);
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

void sigmoid_project(float* const dst[3], const SigmoidSpectra& spectra, const float* weights,
                     std::size_t n) noexcept {
  with_form(spectra.form, [&](auto form) { project_sigmoids<decltype(form)>(dst, spectra, weights, n); });
}

}  // namespace
}  // namespace spectile::kernels
