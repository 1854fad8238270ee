// The rules about shapes that are common to every batch operation, written once.
#pragma once

#include <cstdint>
#include <spectile/lanes/sampled_spectra.hpp>

#include "src/base/errors.hpp"

namespace spectile::shape {

inline Result<void> same(const SampledSpectraView& a, const SampledSpectraView& b) {
  if (!(a.axis == b.axis)) {
    return make_error(ErrorCode::kBandsMismatch, "one batch has {}, the other {}", a.axis.description(),
                      b.axis.description());
  }
  if (a.lanes != b.lanes) {
    return make_error(ErrorCode::kSizeMismatch, "one batch has {} lanes, the other {}", a.lanes, b.lanes);
  }
  return {};
}

inline Result<void> same_lanes(std::size_t a, std::size_t b) {
  if (a != b) return make_error(ErrorCode::kSizeMismatch, "one batch has {} lanes, the other {}", a, b);
  return {};
}

/// `what` expects the bands: "the projector".
inline Result<void> same_bands(const char* what, const SpectralAxis& expected, const SpectralAxis& given) {
  if (expected == given) return {};
  return make_error(ErrorCode::kBandsMismatch, "the spectra have {}, {} expects {}", given.description(),
                    what, expected.description());
}

/// Of a batch that is wavelengths, or values at them.
inline Result<void> own_wavelengths(const SpectralAxis& axis) {
  if (axis.bands() == nullptr) return {};
  return make_error(ErrorCode::kBandsMismatch, "wavelengths are each lane's own, the batch has {}",
                    axis.description());
}

inline Result<void> aligned(const void* p) {
  if (reinterpret_cast<std::uintptr_t>(p) % 64 == 0) return {};
  return make_error(ErrorCode::kBadArgument, "samples must start at a multiple of 64 bytes");
}

inline Result<void> aligned(const ColorView& color) {
  for (const float* plane : color.c) SPECTILE_TRY(aligned(plane));
  return {};
}

}  // namespace spectile::shape
