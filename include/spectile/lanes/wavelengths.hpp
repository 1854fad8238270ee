// Sampled wavelengths in batches: drawing them, looking spectra up at them, and adding them up to colours.
#pragma once

#include <memory>
#include <spectile/color/colorimetry.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <vector>

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

/// From which density wavelengths are drawn.
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

/// Terminates all but the first wavelength of the lanes whose `lanes_hit` is not 0 (of all, where it is
/// empty), as at a dispersive surface: their densities become 0 and the first one's is divided by K, so that
/// sums over the K stay unbiased. Lanes that are terminated already stay as they are. Shapes: lanes_hit
/// [lanes] or empty. Errors: kSizeMismatch.
Result<void> terminate_secondary(SampledWavelengths& wavelengths,
                                 std::span<const std::uint8_t> lanes_hit = {});

/// A spectrum made ready to be looked up in batches.
///
/// Numbers: NaN wavelengths give NaN, infinite ones what the distribution is there. In float: tables within 4
/// u (u = 2^-24) of the larger neighbour in magnitude, for wavelengths and knots rounded to float; black
/// bodies within 6 u from 0.1 to 10^7 nm (and the least float); Gaussians within 1 u of the sum of the lobes'
/// magnitudes; sigmoids as upsampled.
class SpectrumSampler {
 public:
  /// Errors: kOutOfMemory; kBadArgument for samples, slopes and ranges beyond that of float.
  static Result<SpectrumSampler> create(const Spectrum& spectrum);

  /// Shapes: values [k][lanes], as the wavelengths, in other memory. Errors: kSizeMismatch.
  Result<void> sample(WavelengthView lambda_nm, WavelengthSpan values, const Execution& execution = {}) const;

 private:
  SpectrumSampler() = default;
  struct Tables;
  std::shared_ptr<const Tables> tables_;
};

/// The same for a spectrum that is looked up once.
Result<void> sample(const Spectrum& spectrum, WavelengthView lambda_nm, WavelengthSpan values,
                    const Execution& execution = {});

/// Three response curves that radiance at sampled wavelengths is weighed with.
class ResponseCurves {
 public:
  /// Of an observer: XYZ, scaled so that Y is 1 for a spectrum that is 1 everywhere.
  static Result<ResponseCurves> of_observer(Observer observer = Observer::kCie1931);
  /// Any three, times a factor each, tabulated at 1 nm over the range of the observers.
  /// Errors: kOutOfMemory; kBadArgument for a value that is not finite.
  static Result<ResponseCurves> create(const std::array<Spectrum, 3>& curves,
                                       const std::array<double, 3>& factors = {1, 1, 1});
  /// [3][intervals][2], see the kernels.
  const float* table() const noexcept { return table_->data(); }

 private:
  ResponseCurves() = default;
  std::shared_ptr<const FloatBuffer> table_;
};

/// Radiance at K sampled wavelengths a lane to XYZ or sensor RGB: the mean over k of curve(lambda_k) *
/// radiance_k / density_k. Unbiased for wavelengths drawn with those densities; a terminated wavelength adds
/// nothing, whatever its radiance.
/// Shapes: radiance [k][lanes], color three times [lanes].
/// Numbers: error below (K + 6) u of the sum of the magnitudes, each with the larger value of the curve at
/// the nanometres beside the wavelength; NaN and infinities go through. Errors: kSizeMismatch.
Result<void> project(const ResponseCurves& curves, WavelengthView radiance,
                     const SampledWavelengths& wavelengths, ColorSpan color, const Execution& execution = {});

}  // namespace spectile
