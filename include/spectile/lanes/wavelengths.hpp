// Sampled wavelengths in batches: drawing and terminating them.
#pragma once

#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/spectra/spectrum.hpp>

namespace spectile {

/// Read-only view of K numbers a lane: wavelengths, densities or values. Shapes: row(k) [lanes rounded up to
/// 64], 64-byte aligned, `stride` floats apart.
struct WavelengthView {
  const float* data = nullptr;
  std::size_t lanes = 0;
  std::size_t count = 0;
  std::size_t stride = 0;
  const float* row(std::size_t k) const noexcept { return data + k * stride; }
};

/// Writable view; shapes as in WavelengthView.
struct WavelengthSpan {
  float* data = nullptr;
  std::size_t lanes = 0;
  std::size_t count = 0;
  std::size_t stride = 0;
  float* row(std::size_t k) const noexcept { return data + k * stride; }
  operator WavelengthView() const { return {data, lanes, count, stride}; }
};

/// Owner of K numbers a lane, zero at first.
class WavelengthLanes {
 public:
  static constexpr std::size_t kMaxWavelengths = 64;
  /// Errors: kOutOfMemory; kBadArgument for no wavelengths or more than kMaxWavelengths.
  static Result<WavelengthLanes> create(std::size_t lanes, std::size_t count);
  std::size_t lanes() const noexcept { return lanes_; }
  std::size_t count() const noexcept { return count_; }
  WavelengthSpan span() noexcept { return {buffer_.data(), lanes_, count_, stride_}; }
  WavelengthView view() const noexcept { return {buffer_.data(), lanes_, count_, stride_}; }
  float& at(std::size_t lane, std::size_t k) noexcept { return buffer_.data()[k * stride_ + lane]; }
  float at(std::size_t lane, std::size_t k) const noexcept { return buffer_.data()[k * stride_ + lane]; }

 private:
  FloatBuffer buffer_;
  std::size_t lanes_ = 0;
  std::size_t count_ = 0;
  std::size_t stride_ = 0;
};

/// K wavelengths in each of n lanes, and the densities that they were drawn with.
struct SampledWavelengths {
  WavelengthLanes lambda_nm;
  WavelengthLanes density;  ///< 1/nm; 0 for a wavelength that is terminated

  /// Errors: as WavelengthLanes::create.
  static Result<SampledWavelengths> create(std::size_t lanes, std::size_t count);
  std::size_t lanes() const noexcept { return lambda_nm.lanes(); }
  std::size_t count() const noexcept { return lambda_nm.count(); }
};

/// The density that wavelengths are drawn from.
enum class WavelengthSampling {
  kUniform,  ///< even over the range
  kVisible,  ///< as 1/cosh^2(0.0072 (lambda - 538 nm)), which is close to the eye's sensitivity
};

/// Draws K wavelengths a lane from one random number each: u, u + 1/K, u + 2/K, ..., less 1 where that
/// reaches 1, so that the range is covered evenly, through the inverse of the density's distribution. Shapes:
/// u [lanes], from 0 to 1 (limited to that; NaN gives NaN). Units: nm. Errors: kSizeMismatch; kBadArgument
/// for a range that does not ascend or is not within 1e-6 to 1e9 nm, and for kVisible one that holds less
/// than a millionth of the density. Source of the density: Radziszewski, Boryczko, Alda, An Improved
/// Technique for Full Spectral Rendering, Journal of WSCG 17, 2009.
Result<void> sample_wavelengths(WavelengthSampling sampling, LanesView u, SampledWavelengths& out,
                                double first_nm = kFirstVisibleNm, double last_nm = kLastVisibleNm,
                                const Execution& execution = {});

/// Terminates all but the first wavelength of every lane, or of those of a mask, as at a dispersive surface:
/// their densities become 0 and the first one's is divided by K, so that sums over the K stay unbiased. Lanes
/// that are terminated already stay as they are. Errors: kSizeMismatch for a mask of other lanes.
Result<void> terminate_secondary(SampledWavelengths& wavelengths);
Result<void> terminate_secondary(SampledWavelengths& wavelengths, const LaneMask& lanes);

/// Lanes that have only their first wavelength left; none where K is 1.
LaneMask secondary_terminated(const SampledWavelengths& wavelengths);

}  // namespace spectile
