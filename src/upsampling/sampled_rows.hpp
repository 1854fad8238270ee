// SampledRows: tables that turn a method's coefficients into samples at chosen places of the spectrum.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <spectile/upsampling/upsample.hpp>

#include "kernels/abi.hpp"

namespace spectile::rows {

/// A row of the kernels' table for each band or wavelength: of basis samples for methods that mix basis
/// spectra, of kSigmoidRow floats for the sigmoids (of which evaluating needs p, q and the white only). It
/// does not need its upsampler any more.
class SampledRows {
 public:
  /// For bands. The upsampler's own give its own samples, to the bit. Others: basis spectra are made anew for
  /// them; the sigmoid's argument is evaluated at their centres, at the ends of the upsampler's bands
  /// beyond these, and a light's white is averaged over them, with luminance 1 over the upsampler's bands.
  /// Errors: kOutOfMemory; those of Upsampler::create() for bases.
  static Result<SampledRows> over(const Upsampler& upsampler, const Bands& bands);

  /// At wavelengths: basis samples and a light's white linear between the centres of the upsampler's bands
  /// and constant beyond them, the sigmoid as above. At a centre, the upsampler's own samples to the bit.
  /// Units: nm. Errors: kOutOfMemory.
  static Result<SampledRows> at(const Upsampler& upsampler, std::span<const double> wavelengths_nm);

  std::size_t count() const noexcept { return count_; }
  /// True where every lane has a scale besides its coefficients.
  bool has_scale() const noexcept { return has_scale_; }
  /// The seven basis samples of a place, as kernels take them; of methods that mix bases.
  const float* basis(std::size_t i) const noexcept { return table_.data() + i * row_floats_; }
  /// True if samples are linear in the weights of the bases (and for a method that is linear in RGB, in that)
  /// as long as no component is below 0, or, with `any_component`, whatever they are: if none is limited from
  /// below.
  bool linear(bool any_component) const noexcept;
  /// Largest magnitude of each coefficient, and of the scale, for which no sample can overflow.
  const std::array<float, 4>& limits() const noexcept { return limits_; }
  /// Coefficients of a black pixel, and its scale.
  const std::array<float, 4>& black() const noexcept { return black_; }
  /// An upper bound of the samples' magnitudes, from the largest magnitudes of coefficients and scale.
  float bound(const std::array<float, 4>& largest) const noexcept;

  /// Coefficients to a row of samples for each place, floats or halves; any n. Coefficients and scale (null
  /// where there is none) at multiples of 64 bytes, readable up to whole blocks.
  void expand_rows(const kernels::KernelTable& kernels, const float* const c[3], const float* scale,
                   void* const* out, bool half, std::size_t n) const;
  /// Coefficients to blocks of samples.
  void expand_blocks(const kernels::KernelTable& kernels, const float* const c[3], const float* scale,
                     float* spectra, std::size_t blocks) const;

 private:
  SampledRows() = default;
  static Result<SampledRows> sized(const Upsampler& upsampler, std::size_t count);
  void copy(const Upsampler& upsampler);
  void set_limits();
  float* row(std::size_t i) noexcept { return table_.data() + i * row_floats_; }

  FloatBuffer table_;
  std::size_t count_ = 0;
  std::size_t row_floats_ = 0;
  bool sigmoid_ = false;
  std::shared_ptr<const GridModel> grid_;  // of tetrahedral: in place of the table
  bool has_scale_ = false;
  bool white_ = false;
  kernels::SigmoidForm form_ = kernels::SigmoidForm::kQuadratic;
  float lowest_ = 0;
  float largest_ = 0;  // of the table's basis samples or whites
  std::array<float, 4> limits_{};
  std::array<float, 4> black_{};
};

}  // namespace spectile::rows
