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

/// Planes 0 to bands - 1 of its strips are the bands, those up to samples() - 1 re-radiation, if there is
/// any; the others pass through.
class SpectralSource : public ImageSource {
 public:
  /// Errors: kBadFile, kNoPermission; those of choose_spectra() and RegionReader.
  static Result<std::unique_ptr<SpectralSource>> open(const std::string& path, const ChannelChoice& choice,
                                                      std::optional<Quantity> wanted, int threads,
                                                      const std::optional<PixelWindow>& region = {});

  Quantity quantity() const noexcept { return set_.quantity; }
  const Bands& bands() const noexcept { return bands_; }

  const std::vector<ReradiationChannel>& reradiation() const noexcept { return reradiation_; }
  /// Bands and channels of re-radiation.
  std::size_t samples() const noexcept { return bands_.count() + reradiation_.size(); }

  /// See load_block().
  void block(const kernels::KernelTable& kernels, const Strip& strip, int line, std::size_t x,
             float* block) const {
    load_block(kernels, planes_, samples(), strip, line, x, block);
  }

 private:
  SpectralSource() = default;
  SpectralSet set_;
  Bands bands_;
  std::vector<ReradiationChannel> reradiation_;
};

}  // namespace spectile::io
