// AverageInputs: the images of an average, checked to be of one frame, and read side by side.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <spectile/result.hpp>
#include <string>
#include <vector>

#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// Any number of images with the same windows and channels. As many stay open as memory and the system's
/// limit on open files make sensible; the others are opened for every strip.
class AverageInputs {
 public:
  /// Opens and compares all. Errors: those of ExrInput::open(); kBadFile for several parts, subsampled
  /// channels, and images that differ from the first.
  static Result<std::unique_ptr<AverageInputs>> open(std::span<const std::string> paths, int threads);

  std::size_t count() const noexcept { return paths_.size(); }
  const std::string& path(std::size_t input) const { return paths_[input]; }
  /// The first image's.
  const PartHeader& header() const noexcept { return header_; }
  /// The channels, each in the widest type that an image has it in.
  const std::vector<PlaneSpec>& planes() const noexcept { return planes_; }
  /// Lines that are decoded at once, of the image where they are most.
  int chunk_lines() const noexcept { return chunk_lines_; }

  /// Fills a strip of all planes. Calls for different images may run side by side.
  /// Errors: kBadFile, also for an image that is not any more what it was.
  Result<void> fill(std::size_t input, Strip& strip);

 private:
  AverageInputs() = default;
  Result<std::unique_ptr<ExrInput>> open_one(std::size_t input);
  Result<void> start(const ExrInput& first);
  Result<void> compare(const ExrInput& other);
  bool is_as_before(const ExrInput& again) const;
  std::size_t most_open() const;

  std::vector<std::string> paths_;
  int threads_each_ = 1;
  PartHeader header_;
  std::vector<PlaneSpec> planes_;
  int chunk_lines_ = 1;
  std::vector<std::unique_ptr<ExrInput>> open_;  // of the first few images
  std::mutex opening_;                           // OpenEXR has settings common to all files
};

}  // namespace spectile::io
