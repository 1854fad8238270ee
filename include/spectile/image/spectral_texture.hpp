// SpectralTexture: the spectra of a part of an image at the wavelengths asked for, whichever way they are
// stored.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <spectile/image/texture_cache.hpp>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/pixel_window.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>

namespace spectile {

/// The texels beyond a texture's edges.
enum class TextureWrap { kRepeat, kMirror, kClamp, kBlack };

/// How a lane's sample is made of texels.
enum class TextureFilter {
  kNearest,    ///< the texel that holds the point, of the nearest mip level
  kBilinear,   ///< the four around it, of the nearest mip level
  kTrilinear,  ///< these of the two mip levels around the lane's own
};

struct TextureLookup {
  TextureFilter filter = TextureFilter::kTrilinear;
  TextureWrap wrap_u = TextureWrap::kRepeat;
  TextureWrap wrap_v = TextureWrap::kRepeat;
};

/// Where lanes look a texture up: 0 to 1 is its width, from the left, and its height, from the top; a point
/// of float has 24 bits, a 256th of a texel in a width of 65536. At most one of the last two is given: the
/// mip level, or the footprint, the side of a square in parts of the texture's larger side, whose level is
/// log2 of its texels at powers of two and linear between. Level 0 where neither is.
struct TexturePoints {
  LanesView u = {};
  LanesView v = {};
  LanesView level = {};
  LanesView footprint = {};
};

struct TextureOptions {
  int threads = 0;                         ///< that decode and compute; 0: every core
  std::optional<TextureCache> cache = {};  ///< shared with other textures; its own where none
};

/// An open spectral image to look samples up in: a full one, with a channel for each band, or a compact one
/// of a method's coefficients. Cheap to copy; copies share the file. May be used from several threads at
/// once: they read the file one after the other and compute side by side.
class SpectralTexture {
 public:
  /// Opens the first part that holds spectra or coefficients; where one holds reflectances and light, the
  /// reflectances. `threads` decode and compute; 0: every core that the process may use.
  /// Errors: kBadFile, kNoPermission; as for project_image() and expand_image().
  static Result<SpectralTexture> open(const std::string& path, int threads = 0);
  static Result<SpectralTexture> open(const std::string& path, const TextureOptions& options);

  int width() const noexcept;
  int height() const noexcept;
  /// A full image does not tell unbounded ones from reflectances.
  Quantity quantity() const noexcept;
  /// Bands that are stored, or that the coefficients were made for.
  const Bands& bands() const noexcept;
  /// True if it holds coefficients.
  bool compact() const noexcept;

  /// Samples at wavelengths, strictly ascending, for each pixel of a region, which counts from the data
  /// window's upper left corner.
  ///
  /// At the centre of one of bands() a full image gives its stored sample, and a compact one the very bits
  /// that expand_image() stores there as float. So both forms of a texture agree there: to the bit as float,
  /// after rounding (and clamping to 65504) as half. This holds where the layout's channel names, of six
  /// decimals, hold the centres exactly.
  /// Between centres, full images, mixtures of basis spectra and a light's white are linear and a sigmoid is
  /// evaluated at the wavelength. So mixtures agree within rounding, but where just one of two neighbours was
  /// clamped to 0; sigmoids do as far as they are straight from band to band.
  /// Below the first centre and above the last the value there goes on.
  ///
  /// Only chunks with lines of the region are decoded; of a full image only the channels next to the
  /// wavelengths are taken from them.
  /// Shapes: pixel x, y of the region in lane (y * region.width() + x); a band for each wavelength, centred
  /// there. Units: nm; the image's own.
  /// Numbers: stored samples as they are, NaN and infinities too; coefficients that are not finite, or whose
  /// samples could overflow, give NaN in every band.
  /// Errors: kBadArgument for a region without pixels or not within the image, for no wavelengths, more than
  /// Bands::kMaxBands, or ones not positive or not ascending; kBadFile for a damaged file, to be opened anew
  /// if other lines of it are wanted; kOutOfMemory.
  Result<SampledSpectra> evaluate(const PixelWindow& region, std::span<const double> wavelengths_nm) const;

  /// The same at the centres of a batch's bands, into the batch. Errors: kSizeMismatch too, for lanes other
  /// than the region's pixels; kBadArgument for samples not aligned.
  Result<void> evaluate(const PixelWindow& region, SampledSpectraSpan spectra) const;

  /// Filtered samples at each lane's own wavelengths. Filtered are spectra: the sample is the weighted mean
  /// of the texels' samples. Numbers that spectra are linear in are filtered themselves: samples of full
  /// images, the RGB of `mallett`, the weights of the basis spectra of the other mixtures (what colours below
  /// 0 make is clamped after that), but not of `smits`, whose basis spectra have samples below 0. The
  /// coefficients of that, of sigmoids and of `tetrahedral` are evaluated first, texel by texel. Wavelengths
  /// as in evaluate(), but for rounding to float. Tiles of 64 x 64 texels come from the cache. A miss reads
  /// the file, whose other readers wait.
  ///
  /// Shapes: points, lambda_nm and samples
  /// of the same lanes; lambda_nm and samples on one axis; they may be one batch. Units: nm; the image's own.
  /// Numbers: u, v not finite, or a level or footprint NaN, gives NaN. Texels of weight 0 do not count. Each
  /// product and sum of the filter rounds once: within 10 u of the largest texel's sample. Errors:
  /// kBandsMismatch, kSizeMismatch; kBadArgument for level and footprint both, and for samples not aligned;
  /// kBadFile for a damaged file, one that was changed, and one whose data window is not its display window,
  /// of which 0 to 1 could be either; kOutOfMemory.
  Result<void> sample(const TexturePoints& at, SampledSpectraView lambda_nm, SampledSpectraSpan samples,
                      const TextureLookup& lookup = {}, const Execution& execution = {}) const;
  /// The same at the centres of a batch's bands: on those that coefficients were made for, the samples that
  /// expand_image() stores, filtered.
  Result<void> sample(const TexturePoints& at, SampledSpectraSpan samples, const TextureLookup& lookup = {},
                      const Execution& execution = {}) const;

  /// Mip levels that sample() has: 1 where the file has none. Errors: kBadFile.
  Result<int> levels() const;

  /// Of the cache that it uses.
  TextureCacheStats cache_stats() const;

  /// Samples taken from the file by evaluate() so far, by all copies: lines times the image's width times
  /// channels.
  std::uint64_t samples_read() const noexcept;

 private:
  class Image;
  explicit SpectralTexture(std::shared_ptr<Image> image) : image_(std::move(image)) {}
  std::shared_ptr<Image> image_;
};

}  // namespace spectile
