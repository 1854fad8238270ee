// PixelMask: which pixels of an image need no spectra, by its own alpha or by another image.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <spectile/image/image.hpp>
#include <string>
#include <vector>

#include "src/io/convert/sources/rgb_source.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/region.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

class PixelMask {
 public:
  /// Errors: kBadArgument where a file is asked for without a name, and the other way round; for that file,
  /// those of ExrInput::open(), kBadFile where it has another size or no channel to take.
  static Result<PixelMask> open(const UpsampleImageOptions& options, const RgbSource& source, int threads);

  /// Adds the mask's plane to a strip of the source, where it has one of its own, and makes R, G, B of masked
  /// pixels 0. Returns how many of those were not, or no numbers. Errors: kBadFile, also for a file that was
  /// changed when its last line is read; kOutOfMemory.
  Result<std::uint64_t> apply(Strip& strip);

  /// True if strips get a plane of floats from it, after their own.
  bool adds_plane() const noexcept { return file_ != nullptr; }

  /// "channel A of mask.exr" where the file has other channels that could be a mask too; empty elsewhere.
  std::string chosen() const;

  /// Sets masked[x] to 1 or 0 for each pixel of a line, and returns how many are.
  std::uint64_t line(const Strip& strip, int line, std::uint8_t* masked) const;

 private:
  Result<void> read(Strip& strip);
  Result<void> choose(const RgbSource& source);
  Result<void> crop(const RgbSource& source);

  std::optional<std::size_t> plane_;  // of strips; none where no pixel is masked
  SampleType type_ = SampleType::kFloat;
  std::array<SampleType, 3> color_types_{};     // of planes 0, 1, 2
  std::vector<std::uint8_t> masked_, colored_;  // of a line
  std::unique_ptr<ExrInput> file_;
  std::optional<RegionReader> region_;  // where the source reads a part only
  int part_ = 0;
  std::string channel_;
  int choices_ = 0;
};

}  // namespace spectile::io
