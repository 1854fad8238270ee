// SpectralTexture: the spectra of a part of an image at the wavelengths asked for, whichever way they are
// stored.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <spectile/lanes/sampled_spectra.hpp>
#include <spectile/pixel_window.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>

namespace spectile {

/// An open spectral image to look samples up in: a full one, with a channel for each band, or a compact one
/// of a method's coefficients. Cheap to copy; copies share the file. May be used from several threads at
/// once: they read the file one after the other and compute side by side.
class SpectralTexture {
 public:
  /// Opens the first part that holds spectra or coefficients; where one holds reflectances and light, the
  /// reflectances. `threads` decode and compute; 0: every core that the process may use.
  /// Errors: kBadFile, kNoPermission; as for project_image() and expand_image().
  static Result<SpectralTexture> open(const std::string& path, int threads = 0);

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

  /// Samples taken from the file so far, by all copies: lines times the image's width times channels.
  std::uint64_t samples_read() const noexcept;

 private:
  class Image;
  explicit SpectralTexture(std::shared_ptr<Image> image) : image_(std::move(image)) {}
  std::shared_ptr<Image> image_;
};

}  // namespace spectile
