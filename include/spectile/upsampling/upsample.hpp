// From RGB or XYZ to spectra.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <spectile/color/colorimetry.hpp>
#include <spectile/color/rgb_space.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/spectra/measured_spectrum.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// Upsampling methods; their basis spectra are not interchangeable.
enum class Method {
  kSmits,       ///< 32 samples, 380 to 720 nm, times 0.94 (reflectance) or 0.86445 (illuminant)
  kSmits1999,   ///< ten samples, as printed; as illuminant, times D65 scaled to luminance 1
  kSmitsExact,  ///< the smoothest spectra whose colours are exactly the corners of the RGB cube
  kMallett,  ///< three spectra that sum to 1, made exact for the bands; linear, so it commutes with filters
  kSigmoid,  ///< a sigmoid of a quadratic: smooth, between 0 and 1, exact, also for colours outside sRGB
  kSigmoidObserver,  ///< the same of two functions made of the observer's: nearer to measured reflectances
  kTetrahedral,      ///< interpolated between 125 of those: exact and between 0 and 1 without a search
};

/// True for the methods whose spectra are sigmoids, of three coefficients.
constexpr bool is_sigmoid(Method method) noexcept {
  return method == Method::kSigmoid || method == Method::kSigmoidObserver;
}

/// The method where none is asked for. See docs/methods.md for the table by which it was chosen.
inline constexpr Method kDefaultMethod = Method::kTetrahedral;

/// The physical quantity of the spectra.
enum class Quantity {
  kReflectance,  ///< 0 to 1, no unit
  kUnbounded,    ///< a reflectance's shape on any scale, no unit: what may exceed 1
  kIlluminant,   ///< radiance, W/(m^2 sr nm)
};

/// Treatment of samples below 0, which basis spectra with negative lobes and negative RGB give.
enum class NegativeSamples {
  kClampToZero,  ///< they become 0
  kKeep,         ///< they stay
};

/// How results are stored in memory.
enum class StoreHint {
  kAuto,       ///< non-temporal stores for batches of more than 64 MiB
  kCached,     ///< ordinary stores: best when the spectra are read again at once
  kStreaming,  ///< non-temporal stores, which bypass the caches
};

/// Name and back: "smits", "smits1999", "smits-exact", "mallett", "sigmoid", "sigmoid-observer",
/// "tetrahedral"; "reflectance", "unbounded", "illuminant". Errors: kUnknownName, listing the names.
Result<Method> parse_method(std::string_view name);
Result<Quantity> parse_quantity(std::string_view name);
/// Names that parse_method() knows.
std::vector<std::string> method_names();
std::string_view to_string(Method method);
std::string_view to_string(Quantity quantity);

struct LearnedNodes;

/// Viewing conditions under which the spectra must have the colours asked for.
struct UpsamplerOptions {
  NegativeSamples negative = NegativeSamples::kClampToZero;
  Chromaticities primaries = kRec709;  ///< of the RGB; free for smits-exact, the sigmoids and tetrahedral
  std::optional<MeasuredSpectrum> light =
      {};  ///< under which RGB 1, 1, 1 is the perfect diffuser; D65 where none
  Observer observer = Observer::kCie1931;
  std::shared_ptr<const LearnedNodes> nodes = {};  ///< of tetrahedral: learned ones; none for sigmoids
};

struct SigmoidModel;
struct GridModel;
struct WavelengthTables;

/// A method prepared for given bands, ready for the kernels. Copies share its kernels' tables.
///
/// Its RGB: primaries of the options, and RGB 1, 1, 1 is the perfect diffuser under their light, as these
/// bands and this observer see it (for an illuminant, that light itself with luminance 1). `smits` and
/// `smits1999` are published for sRGB under D65 and come near it; the others are exact for the bands.
///
/// Sources: Smits, An RGB-to-Spectrum Conversion for Reflectances, J. Graphics Tools 4(4), 1999; the
/// 32-sample refinement and its factors: Pharr, Jakob, Humphreys, Physically Based Rendering, 3rd edition;
/// Mallett, Yuksel, Spectral Primary Decomposition for Rendering with sRGB Reflectance, EGSR 2019; Jakob,
/// Hanika, A Low-Dimensional Function Space for Efficient Spectral Upsampling, Computer Graphics Forum 38(2),
/// 2019. `sigmoid-observer` is our own: their sigmoid of other functions, the first order of the spectra with
/// the least slope of Burns, Numerical methods for smoothest reflectance reconstruction, Color Research and
/// Application 45(1), 2020. `tetrahedral` is our own too: Smits's decomposition on a grid of those, by the
/// partition of Kuhn, Some Combinatorial Lemmas in Topology, IBM J. Research and Development 4(5), 1960.
class Upsampler {
 public:
  /// Errors: kOutOfMemory; kBadArgument for options that the method, or its nodes, are not made for, and
  /// where there are no spectra with the colours of the cube's corners, naming a method that works.
  static Result<Upsampler> create(Method method, Quantity quantity, const Bands& bands,
                                  const UpsamplerOptions& options);
  static Result<Upsampler> create(Method method, Quantity quantity, const Bands& bands,
                                  NegativeSamples negative = NegativeSamples::kClampToZero);

  Method method() const noexcept { return method_; }
  Quantity quantity() const noexcept { return quantity_; }
  const Bands& bands() const noexcept { return bands_; }
  const UpsamplerOptions& options() const noexcept { return options_; }
  /// Minimum of the samples: 0, or minus infinity when negative ones are kept.
  float lowest() const noexcept { return lowest_; }
  /// Shapes: [bands][7], in double before rounding to the kernels' float; white, cyan, magenta, yellow, red,
  /// green, blue. Empty for the sigmoids and tetrahedral.
  std::span<const std::array<double, 7>> basis() const noexcept { return basis_; }
  /// XYZ of RGB 1, 1, 1, and the matrix that goes with it: see above.
  const Matrix3& rgb_to_xyz() const noexcept { return rgb_to_xyz_; }
  /// Weights of R, G and B in the luminance that gamut_clip() keeps: the primaries' under the light as the
  /// whole visible range shows it, so that they do not depend on the bands.
  const std::array<float, 3>& luminance() const noexcept { return luminance_; }

 private:
  friend struct UpsamplerAccess;
  Upsampler() = default;
  Method method_ = Method::kSmits;
  Quantity quantity_ = Quantity::kReflectance;
  Bands bands_;
  UpsamplerOptions options_;
  float lowest_ = 0;
  Matrix3 rgb_to_xyz_{};
  std::array<float, 3> luminance_{};
  std::vector<std::array<double, 7>> basis_;
  std::shared_ptr<const FloatBuffer> table_;
  std::shared_ptr<const SigmoidModel> sigmoid_;
  std::shared_ptr<const GridModel> grid_;
  std::shared_ptr<const WavelengthTables> at_wavelengths_;
};

/// Treatment of colours that a method cannot make, once they are in its RGB.
enum class GamutPolicy {
  kClip,   ///< moved to the nearest colour that it can make of the same luminance and dominant wavelength
  kKeep,   ///< kept, as are the samples below 0 that they make: basis spectra and nodes are extrapolated
           ///< linearly, sigmoids take the coefficients of the colour that they would be clipped to
  kError,  ///< an error that names the first of them and their number
};

/// Colours of a batch that the method could not make.
struct GamutReport {
  std::uint64_t outside = 0;  ///< lanes
  std::int64_t first = -1;    ///< the first of them
};

/// Makes a batch of RGB one that the upsampler can make. For the methods whose coefficients are the RGB these
/// are the colours without a component below 0 (above 1 they go on); for the sigmoids as a reflectance those
/// that some sigmoid has, which is more than the cube of sRGB. Black, white and greys are always inside.
/// Colours outside keep their luminance (limited to 0 to 1 for the sigmoids' reflectances) and their dominant
/// wavelength. What has a component that is not finite stays as it is and does not count. Shapes: rgb three
/// times [lanes]. Errors: kBadArgument for samples not aligned, and for colours outside with
/// GamutPolicy::kError, which leaves the batch as it is.
Result<GamutReport> gamut_clip(const Upsampler& upsampler, ColorSpan rgb,
                               GamutPolicy policy = GamutPolicy::kClip, const Execution& execution = {});

/// Coefficients of a method: three for every lane, and a scale for the sigmoids' unbounded ones and lights.
/// For the other methods they are the RGB itself. upsample_srgb() is coefficients() and
/// expand().
struct CoefficientLanes {
  ColorLanes c;
  ScalarLanes scale;  ///< of no lanes where the method needs none
  /// Lanes without coefficients: theirs are those of the last colour that has some on the line from the grey
  /// of their luminance, where gamut_clip() would move them.
  GamutReport unsolved;
  static Result<CoefficientLanes> create(const Upsampler& upsampler, std::size_t lanes);
};

/// Finds the coefficients for each lane's RGB. Numbers: the sigmoid's projection is within 1e-6 of the RGB
/// (times the scale), greys give a flat spectrum, black and white exactly 0 and 1, NaN or an infinity NaN.
/// Errors: kSizeMismatch, kBadArgument for samples not aligned.
Result<void> coefficients(const Upsampler& upsampler, ColorView rgb, CoefficientLanes& out,
                          const Execution& execution = {});

/// Coefficients to spectra: the bits of upsample_srgb(). Errors: kBandsMismatch, kSizeMismatch.
Result<void> expand(const Upsampler& upsampler, const CoefficientLanes& in, SampledSpectraSpan spectra,
                    StoreHint hint = StoreHint::kAuto, const Execution& execution = {});

/// Linear RGB (sRGB, or of the primaries that the upsampler was created with) to spectra.
/// Shapes: rgb three times [lanes]; spectra [block][band][64].
/// Numbers: homogeneous (twice the RGB is twice the spectrum), no upper limit. The error is below 6 * 2^-24
/// of the sum of the weights' magnitudes (|least| + greatest - least: the greatest component where none is
/// negative) times the largest basis value. NaN in any component gives NaN in every band; infinities give
/// infinities, NaN or, where the result is minus infinity and negative samples are not kept, 0. The sigmoid:
/// see coefficients(). Errors: kBandsMismatch when the upsampler was built for other bands; kSizeMismatch.
Result<void> upsample_srgb(const Upsampler& upsampler, ColorView rgb, SampledSpectraSpan spectra,
                           StoreHint hint = StoreHint::kAuto, const Execution& execution = {});

/// Linear RGB to samples at each lane's own wavelengths, by way of no other batch: the lane's rgb_spectrum()
/// there. For colours that the method cannot make see CoefficientLanes::unsolved.
/// Shapes: rgb three times [lanes]; lambda_nm, such as SampledWavelengths::lambda_nm, and samples on one
/// axis; they may be one batch. Numbers: NaN wavelengths give NaN. Mixtures and grids as upsample_srgb(),
/// then linear between the centres of two bands: 4 u of the larger one more, for wavelengths rounded to
/// float; infinite samples may become NaN. Sigmoids: see coefficients() and SpectrumSampler. Units: nm.
/// Errors: kBandsMismatch for wavelengths on bands and for other axes, kSizeMismatch, kBadArgument for
/// samples not aligned.
Result<void> upsample_srgb(const Upsampler& upsampler, ColorView rgb, SampledSpectraView lambda_nm,
                           SampledSpectraSpan samples, const Execution& execution = {});

/// Coefficients to samples at each lane's own wavelengths: the bits of upsample_srgb(). Errors likewise.
Result<void> expand(const Upsampler& upsampler, const CoefficientLanes& in, SampledSpectraView lambda_nm,
                    SampledSpectraSpan samples, const Execution& execution = {});

/// CIE XYZ to spectra, by way of the upsampler's own RGB: its primaries, and its white as its bands and
/// observer see it (Upsampler::rgb_to_xyz()), so that the exact methods' spectra, projected under that light,
/// have this XYZ. Shapes, numbers, errors as for upsample_srgb().
Result<void> upsample_xyz(const Upsampler& upsampler, ColorView xyz, SampledSpectraSpan spectra,
                          StoreHint hint = StoreHint::kAuto, const Execution& execution = {});

}  // namespace spectile
