// A texture's colour under another light, without its spectra.
#pragma once

#include <array>
#include <memory>
#include <spectile/color/colorimetry.hpp>
#include <spectile/result.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <vector>

namespace spectile {

/// From a method's RGB to colour under a light.
///
/// For mixtures of bases the colour is linear in the weights of white, secondary and primary, so bands and
/// light fold into a table of 3 x 7 (3 x 3 for mallett), whatever the bands; for tetrahedral into one of 3 x
/// 125. Sigmoids are not linear: their coefficients are found and its samples summed in registers. Cheap to
/// copy; it keeps an upsampler and a projector of its own.
class Relighter {
 public:
  /// `under` projects the upsampler's bands, `to` takes its XYZ to the colour wanted:
  /// Projector::xyz_to_srgb(), the identity, an adaptation. Errors: kBandsMismatch when both were made for
  /// other bands; kBadArgument for an upsampler of light.
  static Result<Relighter> create(const Upsampler& upsampler, const Projector& under, const Matrix3& to);

  const Upsampler& upsampler() const noexcept { return *upsampler_; }
  const Projector& projector() const noexcept { return *projector_; }
  const Matrix3& matrix() const noexcept { return matrix_; }
  /// Largest distance of a component from upsample_srgb(), project() and transform() in turn, over the
  /// largest component of the RGB, for RGB without negative components: rounding, and for smits and smits1999
  /// the samples below 0 that those clamp. 0 for the sigmoids, whose bits are the same.
  const std::array<double, 3>& bound() const noexcept { return bound_; }

 private:
  friend struct RelighterAccess;
  Relighter() = default;
  Result<void> fold_grid();
  std::shared_ptr<const Upsampler> upsampler_;
  std::shared_ptr<const Projector> projector_;
  Matrix3 matrix_{};
  std::shared_ptr<const FloatBuffer> table_;
  std::shared_ptr<const GridModel> grid_;
  std::array<double, 3> bound_{};
};

/// The colour of each lane. Shapes: in, out three times [lanes]; they may be the same. Numbers: NaN and
/// infinities as for upsample_srgb() and project(). Errors: kSizeMismatch; kBadArgument for samples not
/// aligned.
Result<void> relight(const Relighter& relighter, ColorView rgb, ColorSpan out,
                     const Execution& execution = {});

}  // namespace spectile
