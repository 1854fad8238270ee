// RgbSource: where an image's red, green and blue come from, and what else passes through.
#pragma once

#include <OpenEXR/ImfRgbaFile.h>

#include <memory>
#include <optional>
#include <spectile/result.hpp>
#include <string>
#include <vector>

#include "src/dispatch/dispatch.hpp"
#include "src/io/convert/sources/color_space.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/region.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// An open RGB image. Planes 0, 1, 2 of its strips are red, green, blue; the others pass through.
class RgbSource {
 public:
  /// Finds R, G, B (or Y, or Y, RY, BY) of a layer, view or part, or the plain ones for an empty name.
  /// Errors: kBadFile, kNoPermission; those of RegionReader.
  static Result<std::unique_ptr<RgbSource>> open(const std::string& path, const std::string& layer,
                                                 int threads, const Crop& region = {});

  /// That of the part, with the region as data window.
  const Imf::Header& header() const { return region_ ? region_->header() : input_->header(part_); }
  /// That of the part as it is in the file.
  const Imf::Header& whole() const { return input_->header(part_); }
  /// Of the region within the data window.
  std::array<int, 2> offset() const { return region_ ? region_->offset() : std::array<int, 2>{}; }
  int width() const { return width_of(header()); }
  int height() const { return height_of(header()); }
  const RgbSpace& color_space() const noexcept { return space_; }
  const std::vector<PlaneSpec>& planes() const noexcept { return planes_; }
  /// The plane of the colours' own alpha, where they have one.
  std::optional<std::size_t> alpha() const noexcept { return alpha_; }
  /// What cannot pass through, in words.
  const std::vector<std::string>& notes() const noexcept { return notes_; }

  /// Reads lines into a new strip. Errors: kBadFile, kOutOfMemory.
  Result<std::shared_ptr<Strip>> read(int first_line, int lines);

  /// A line's R, G, B as floats, zero after the last pixel up to a whole block. rgb: three rows of padded
  /// width.
  void float_rows(const kernels::KernelTable& kernels, const Strip& strip, int line,
                  float* const rgb[3]) const;

 private:
  RgbSource() = default;
  Result<void> choose(const std::string& layer);
  bool choose_in_part(int part, const std::string& prefix);
  void choose_passing(const std::string& prefix);
  Result<void> read_chroma(Strip& strip);

  std::unique_ptr<ExrInput> input_;
  std::optional<RegionReader> region_;
  std::unique_ptr<Imf::RgbaInputFile> chroma_;  // luminance and chroma are put together by OpenEXR
  int part_ = 0;
  std::string red_, green_, blue_;  // channel names in the file; all the same for luminance alone
  bool with_chroma_ = false;
  std::vector<PlaneSpec> planes_;
  std::vector<std::string> file_names_;
  std::optional<std::size_t> alpha_;
  RgbSpace space_;
  std::vector<std::string> notes_;
};

}  // namespace spectile::io
