// SpectralSource: an open spectral image, its bands in order, and what else passes through.
#pragma once

#include <memory>
#include <optional>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <vector>

#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/sources/image_source.hpp"

namespace spectile::io {

/// The spectral channels of one part: names in ascending order of wavelength.
struct SpectralChannels {
  Quantity quantity = Quantity::kReflectance;
  std::vector<std::string> names;
  std::vector<double> centres_nm;
};

/// Finds a part's spectral channels of the quantity asked for, else the reflective ones, else the emissive
/// ones. Nothing where there are none.
std::optional<SpectralChannels> spectral_channels(const PartHeader& header, std::optional<Quantity> wanted);

/// The planes of spectral channels, in their order. Errors: kBadFile for one that is subsampled.
Result<std::vector<PlaneSpec>> band_planes(const PartHeader& header, const SpectralChannels& channels,
                                           const std::string& path);

/// Planes 0 to bands - 1 of its strips are the bands, the others pass through.
class SpectralSource : public ImageSource {
 public:
  /// Errors: kBadFile, kNoPermission; those of RegionReader.
  static Result<std::unique_ptr<SpectralSource>> open(const std::string& path, std::optional<Quantity> wanted,
                                                      int threads,
                                                      const std::optional<PixelWindow>& region = {});

  Quantity quantity() const noexcept { return channels_.quantity; }
  const Bands& bands() const noexcept { return bands_; }

  /// The spectra of kLanesPerBlock pixels from x on, as a block [band][64]; x a multiple of kLanesPerBlock,
  /// pixels after the line's end zero.
  void block(const kernels::KernelTable& kernels, const Strip& strip, int line, std::size_t x,
             float* block) const;

 private:
  SpectralSource() = default;
  SpectralChannels channels_;
  Bands bands_;
};

}  // namespace spectile::io
