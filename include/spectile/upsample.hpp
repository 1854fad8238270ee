// From RGB or XYZ to spectra.
#pragma once

#include <array>
#include <span>
#include <spectile/bands.hpp>
#include <spectile/result.hpp>
#include <spectile/sampled_spectra.hpp>
#include <string_view>
#include <vector>

namespace spectile {

/// Sets of basis spectra; they are not interchangeable.
enum class Method {
  kSmits,      ///< 32 samples, 380 to 720 nm, times 0.94 (reflectance) or 0.86445 (illuminant)
  kSmits1999,  ///< ten samples, as printed; as illuminant, times D65 scaled to luminance 1
};

/// What the spectra stand for.
enum class Quantity {
  kReflectance,  ///< 0 to 1, no unit
  kIlluminant,   ///< radiance, W/(m^2 sr nm)
};

/// What happens to samples below 0, which basis spectra with negative lobes and negative RGB give.
enum class NegativeSamples {
  kClampToZero,  ///< they become 0
  kKeep,         ///< they stay
};

/// How results are stored in memory.
enum class Stores {
  kAuto,       ///< round the caches when the batch is larger than 64 MiB
  kCached,     ///< ordinary stores: best when the spectra are read again at once
  kStreaming,  ///< round the caches
};

/// Name and back: "smits", "smits1999"; "reflectance", "illuminant". Errors: kUnknownName, listing the names.
Result<Method> parse_method(std::string_view name);
Result<Quantity> parse_quantity(std::string_view name);
std::string_view to_string(Method method);
std::string_view to_string(Quantity quantity);

/// Seven basis spectra averaged over the bands, ready for the kernels.
/// Source: Smits, An RGB-to-Spectrum Conversion for Reflectances, J. Graphics Tools 4(4), 1999; the 32-sample
/// refinement and its factors: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd edition.
class Upsampler {
 public:
  /// Errors: kOutOfMemory.
  static Result<Upsampler> create(Method method, Quantity quantity, const Bands& bands,
                                  NegativeSamples negative = NegativeSamples::kClampToZero);

  Method method() const noexcept { return method_; }
  Quantity quantity() const noexcept { return quantity_; }
  const Bands& bands() const noexcept { return bands_; }
  /// Least sample that comes out: 0, or minus infinity when negative ones are kept.
  float lowest() const noexcept { return lowest_; }
  /// Shapes: [bands][7], in double before rounding to the kernels' float; white, cyan, magenta, yellow, red,
  /// green, blue.
  std::span<const std::array<double, 7>> basis() const noexcept { return basis_; }
  /// Shapes: [bands][8], the eighth 0, 64-byte aligned.
  const float* table() const noexcept { return table_.data(); }

 private:
  Upsampler() = default;
  Method method_ = Method::kSmits;
  Quantity quantity_ = Quantity::kReflectance;
  Bands bands_;
  float lowest_ = 0;
  std::vector<std::array<double, 7>> basis_;
  FloatBuffer table_;
};

/// Linear sRGB to spectra.
/// Shapes: rgb three times [lanes]; spectra [block][band][64].
/// Numbers: homogeneous (twice the RGB is twice the spectrum), no upper limit. The error is below 6 * 2^-24
/// of the sum of the weights' magnitudes (|least| + greatest - least: the greatest component where none is
/// negative) times the largest basis value. NaN in any component gives NaN in every band; infinities give
/// infinities, NaN or, where the result is minus infinity and negative samples are not kept, 0. Errors:
/// kBandsMismatch when the upsampler was built for other bands; kSizeMismatch.
Result<void> upsample_srgb(const Upsampler& upsampler, ColorView rgb, SampledSpectraSpan spectra,
                           Stores stores = Stores::kAuto, const Execution& how = {});

/// CIE XYZ to spectra, by way of linear sRGB with its D65 white (see xyz_to_srgb).
/// Shapes, numbers, errors as for upsample_srgb.
Result<void> upsample_xyz(const Upsampler& upsampler, ColorView xyz, SampledSpectraSpan spectra,
                          Stores stores = Stores::kAuto, const Execution& how = {});

}  // namespace spectile
