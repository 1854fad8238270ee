// SpectralSource: an open spectral image, its bands in order, and what else passes through.
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

namespace spectile::io {

/// The error for a file without spectral channels.
Error no_spectra(const ExrInput& input);

/// The samples of kLanesPerBlock pixels from x on, of the first `samples` planes of a strip, as a block
/// [sample][64]; x a multiple of kLanesPerBlock, pixels after the line's end zero.
void load_block(const kernels::KernelTable& kernels, const std::vector<PlaneSpec>& planes,
                std::size_t samples, const Strip& strip, int line, std::size_t x, float* block);

/// Part of a file's spectra that is read.
enum class SpectralContent {
  kOneQuantity,         ///< the bands, then re-radiation
  kBothQuantities,      ///< the same of reflectance, then the bands of emission
  kLinearPolarisation,  ///< the bands of emission, S0, then those of S1 and of S2
};

/// Planes 0 to samples() - 1 of its strips are what the content says; the others pass through.
class SpectralSource : public ImageSource {
 public:
  /// Errors: kBadFile, kNoPermission; those of choose_spectra() and RegionReader.
  static Result<std::unique_ptr<SpectralSource>> open(const std::string& path, const ChannelChoice& choice,
                                                      std::optional<Quantity> wanted, int threads,
                                                      const std::optional<PixelWindow>& region = {},
                                                      SpectralContent content = {});

  Quantity quantity() const noexcept { return set_.quantity; }
  const Bands& bands() const noexcept { return bands_; }
  /// Of the emission, where both quantities are read.
  const Bands& emission_bands() const noexcept { return emission_bands_; }

  const std::vector<ReradiationChannel>& reradiation() const noexcept { return reradiation_; }
  /// Planes of spectra.
  std::size_t samples() const noexcept { return samples_; }

  /// See load_block().
  void block(const kernels::KernelTable& kernels, const Strip& strip, int line, std::size_t x,
             float* block) const {
    load_block(kernels, planes_, samples(), strip, line, x, block);
  }

 private:
  SpectralSource() = default;
  /// Errors: those of open().
  Result<void> choose(const ChannelChoice& choice, std::optional<Quantity> wanted, SpectralContent content);
  Result<void> add_passing();
  SpectralSet set_;
  Bands bands_;
  Bands emission_bands_;
  std::size_t samples_ = 0;
  std::vector<ReradiationChannel> reradiation_;
};

}  // namespace spectile::io
