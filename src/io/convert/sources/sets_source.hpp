// SetsSource: an open spectral image with all quantities of one layer and view, and what else passes through.
#pragma once

#include <memory>
#include <optional>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <vector>

#include "src/dispatch/dispatch.hpp"
#include "src/io/channels/spectral_sets.hpp"
#include "src/io/convert/sources/image_source.hpp"
#include "src/io/convert/sources/spectral_source.hpp"

namespace spectile::io {

/// A Stokes component beside S0, of the same wavelengths: a plane for each band.
struct StokesPlanes {
  int component = 1;
  std::size_t first = 0;
};

/// One quantity, and where its planes are among those of the strips.
struct SourceSpectra {
  SpectralSet set;
  Bands bands;
  std::size_t first = 0;  ///< a plane for each band
  std::vector<StokesPlanes> stokes;
  std::size_t first_reradiating = 0;  ///< a plane for each of the set's channels of re-radiation
};

/// Planes 0 to samples() - 1 of its strips are spectral, the others pass through.
class SetsSource : public ImageSource {
 public:
  /// Errors: kBadFile, kNoPermission; those of choose_all_spectra() and RegionReader.
  static Result<std::unique_ptr<SetsSource>> open(const std::string& path, const ChannelChoice& choice,
                                                  std::optional<Quantity> wanted, int threads,
                                                  const std::optional<PixelWindow>& region);

  /// At most one of each quantity, reflectance first.
  const std::vector<SourceSpectra>& spectra() const noexcept { return spectra_; }
  std::size_t samples() const noexcept { return samples_; }
  /// See load_block().
  void block(const kernels::KernelTable& kernels, const Strip& strip, int line, std::size_t x,
             float* block) const {
    load_block(kernels, planes_, samples_, strip, line, x, block);
  }

 private:
  SetsSource() = default;
  Result<void> add(SpectralSet set);
  void add_stokes(SourceSpectra& spectra);
  void add_passing();

  std::vector<SourceSpectra> spectra_;
  std::size_t samples_ = 0;
};

}  // namespace spectile::io
