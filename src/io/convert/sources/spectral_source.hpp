// SpectralSource: an open spectral image, its bands in order, and what else passes through.
#pragma once

#include <memory>
#include <optional>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <vector>

#include "src/dispatch/dispatch.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/region.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// The spectral channels of one part: names in ascending order of wavelength.
struct SpectralChannels {
  Quantity quantity = Quantity::kReflectance;
  std::vector<std::string> names;
  std::vector<double> centres_nm;
};

/// Finds a part's spectral channels of the quantity asked for, else the reflective ones, else the emissive
/// ones. Nothing where there are none.
std::optional<SpectralChannels> spectral_channels(const Imf::Header& header, std::optional<Quantity> wanted);

/// Planes 0 to bands - 1 of its strips are the bands, the others pass through.
class SpectralSource {
 public:
  /// Errors: kBadFile, kNoPermission; those of RegionReader.
  static Result<std::unique_ptr<SpectralSource>> open(const std::string& path, std::optional<Quantity> wanted,
                                                      int threads, const Crop& region = {});

  /// That of the part, with the region as data window.
  const Imf::Header& header() const { return region_ ? region_->header() : input_->header(part_); }
  /// Of the region within the data window.
  std::array<int, 2> offset() const { return region_ ? region_->offset() : std::array<int, 2>{}; }
  int width() const { return width_of(header()); }
  int height() const { return height_of(header()); }
  Quantity quantity() const noexcept { return channels_.quantity; }
  const Bands& bands() const noexcept { return bands_; }
  const std::vector<PlaneSpec>& planes() const noexcept { return planes_; }
  const std::vector<std::string>& notes() const noexcept { return notes_; }

  /// Reads lines into a new strip. Errors: kBadFile, kOutOfMemory.
  Result<std::shared_ptr<Strip>> read(int first_line, int lines);

  /// The spectra of kLanesPerBlock pixels from x on, as a block [band][64]; x a multiple of kLanesPerBlock,
  /// pixels after the line's end zero.
  void block(const kernels::KernelTable& kernels, const Strip& strip, int line, std::size_t x,
             float* block) const;

 private:
  SpectralSource() = default;
  std::unique_ptr<ExrInput> input_;
  std::optional<RegionReader> region_;
  int part_ = 0;
  SpectralChannels channels_;
  Bands bands_;
  std::vector<PlaneSpec> planes_;
  std::vector<std::string> notes_;
};

}  // namespace spectile::io
