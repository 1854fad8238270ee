// Sampled wavelengths in batches: drawing and terminating them.
#pragma once

#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/spectra/spectrum.hpp>

namespace spectile {

/// Read-only view of K wavelengths in each of n lanes, and of the densities that they were drawn with:
/// batches on one axis. Units: nm, 1/nm.
struct SampledWavelengthsView {
  SampledSpectraView lambda_nm = {};
  SampledSpectraView density = {};  ///< 0 for a wavelength that is terminated
  /// As SampledSpectraView::range().
  SampledWavelengthsView range(std::size_t first, std::size_t count) const {
    return {lambda_nm.range(first, count), density.range(first, count)};
  }
};

/// The same to write.
struct SampledWavelengthsSpan {
  SampledSpectraSpan lambda_nm = {};
  SampledSpectraSpan density = {};
  SampledWavelengthsSpan range(std::size_t first, std::size_t count) const {
    return {lambda_nm.range(first, count), density.range(first, count)};
  }
  operator SampledWavelengthsView() const { return {lambda_nm, density}; }
};

/// K wavelengths in each of n lanes, and the densities that they were drawn with.
struct SampledWavelengths {
  SampledSpectra lambda_nm;
  SampledSpectra density;  ///< 1/nm; 0 for a wavelength that is terminated

  /// All 0 at first. Errors: kOutOfMemory; as SpectralAxis::own_wavelengths().
  static Result<SampledWavelengths> create(std::size_t lanes, std::size_t count);
  std::size_t lanes() const noexcept { return lambda_nm.lanes(); }
  std::size_t count() const noexcept { return axis().count(); }
  /// Of batches of values at these wavelengths.
  const SpectralAxis& axis() const noexcept { return lambda_nm.axis(); }
  SampledWavelengthsSpan span() { return {lambda_nm.span(), density.span()}; }
  SampledWavelengthsView view() const { return {lambda_nm.view(), density.view()}; }
  operator SampledWavelengthsSpan() & { return span(); }
  operator SampledWavelengthsView() const { return view(); }
};

/// The density that wavelengths are drawn from.
enum class WavelengthSampling {
  kUniform,  ///< even over the range
  kVisible,  ///< as 1/cosh^2(0.0072 (lambda - 538 nm)), which is close to the eye's sensitivity
};

/// Draws K wavelengths a lane from one random number each: u, u + 1/K, u + 2/K, ..., less 1 where that
/// reaches 1, so that the range is covered evenly, through the inverse of the density's distribution. Shapes:
/// u [lanes], from 0 to 1 (limited to that; NaN gives NaN). Units: nm. Errors: kSizeMismatch; kBandsMismatch
/// for densities of another K; kBadArgument for a range that does not ascend or is not within 1e-6 to 1e9 nm,
/// and for kVisible one that holds less than a millionth of the density. Source of the density: Radziszewski,
/// Boryczko, Alda, An Improved Technique for Full Spectral Rendering, Journal of WSCG 17, 2009.
Result<void> sample_wavelengths(WavelengthSampling sampling, LanesView u, SampledWavelengthsSpan out,
                                double first_nm = kFirstVisibleNm, double last_nm = kLastVisibleNm,
                                const Execution& execution = {});

/// Terminates all but the first wavelength of every lane, or of those of a mask, as at a dispersive surface:
/// their densities become 0 and the first one's is divided by K, so that sums over the K stay unbiased. Lanes
/// that are terminated already stay as they are. Errors: kSizeMismatch for a mask of other lanes.
Result<void> terminate_secondary(SampledWavelengthsSpan wavelengths);
Result<void> terminate_secondary(SampledWavelengthsSpan wavelengths, const LaneMask& lanes);

/// Lanes that have only their first wavelength left; none where K is 1.
LaneMask secondary_terminated(const SampledWavelengthsView& wavelengths);

}  // namespace spectile
