// CoefficientSource: an open image of a method's coefficients, the method, and what else passes through.
#pragma once

#include <array>
#include <memory>
#include <spectile/upsampling/upsample.hpp>
#include <string>
#include <vector>

#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/region.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// Whether a part is meant to hold coefficients, whole or not.
bool claims_coefficients(const Imf::Header& header);

/// Planes 0 to coefficients() - 1 of its strips are the coefficients (and the scale) in float, the others
/// pass through.
class CoefficientSource {
 public:
  /// Takes the first flat part that claims coefficients. Errors: kBadFile where there is none, where
  /// attributes are missing or damaged, channels missing, subsampled or too many, or spectral channels there
  /// already; those of RegionReader.
  static Result<std::unique_ptr<CoefficientSource>> open(std::unique_ptr<ExrInput> input,
                                                         const Crop& region = {});

  ExrInput& input() noexcept { return *input_; }
  int part() const noexcept { return part_; }
  /// That of the part, with the region as data window.
  const Imf::Header& header() const { return region_ ? region_->header() : input_->header(part_); }
  /// Of the region within the data window.
  std::array<int, 2> offset() const { return region_ ? region_->offset() : std::array<int, 2>{}; }
  int width() const { return width_of(header()); }
  int height() const { return height_of(header()); }
  /// The upsampler that made the coefficients.
  const Upsampler& upsampler() const noexcept { return *upsampler_; }
  std::size_t coefficients() const noexcept { return coefficients_; }
  const std::vector<PlaneSpec>& planes() const noexcept { return planes_; }
  /// What cannot pass through, in words.
  const std::vector<std::string>& notes() const noexcept { return notes_; }

  /// Reads lines into a new strip. Errors: kBadFile, kOutOfMemory.
  Result<std::shared_ptr<Strip>> read(int first_line, int lines);

 private:
  CoefficientSource() = default;
  Result<void> choose_channels();

  std::unique_ptr<ExrInput> input_;
  std::optional<RegionReader> region_;
  int part_ = 0;
  std::unique_ptr<Upsampler> upsampler_;
  std::size_t coefficients_ = 0;
  std::vector<PlaneSpec> planes_;
  std::vector<std::string> notes_;
};

}  // namespace spectile::io
