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

/// Any number of images with the same display window and channels: of each the part of one name. As many stay
/// open as memory and the system's limit on open files make sensible; the others are opened for every strip.
class AverageInputs {
 public:
  /// Opens and compares all. `part`: of the first file; of the others, the part of that name, or their only
  /// one for its only one. Errors: those of ExrInput::open(); kBadFile for parts that the others lack, deep
  /// ones, subsampled channels, and images that differ from the first, which says in what.
  static Result<std::unique_ptr<AverageInputs>> open(std::span<const std::string> paths, int threads,
                                                     int part = 0);

  std::size_t count() const noexcept { return paths_.size(); }
  const std::string& path(std::size_t input) const { return paths_[input]; }
  /// Of the first file.
  int parts() const noexcept { return parts_; }
  /// The first image's, with the least data window that holds those of all.
  const PartHeader& header() const noexcept { return header_; }
  /// An image's data window, counted from the upper left corner of that one.
  PixelWindow window(std::size_t input) const;
  /// True if not all images have the same.
  bool crops() const noexcept { return crops_; }
  /// An image whose colour space is assumed, though that of another is stated; empty for none.
  const std::string& space_assumed_of() const noexcept { return space_assumed_of_; }
  /// The channels, each in the widest type that an image has it in.
  const std::vector<PlaneSpec>& planes() const noexcept { return planes_; }
  /// Lines that are decoded at once, of the image where they are most.
  int chunk_lines() const noexcept { return chunk_lines_; }

  /// Fills a strip of all planes, whose lines and width are the image's own. Calls for different images may
  /// run side by side.
  /// Errors: kBadFile, also for an image that is not any more what it was.
  Result<void> fill(std::size_t input, Strip& strip);

 private:
  AverageInputs() = default;
  Result<std::unique_ptr<ExrInput>> open_one(std::size_t input);
  Result<int> find_part(const ExrInput& input) const;
  void start(const PartHeader& first);
  Result<void> compare(const PartHeader& h, const std::string& path);
  Result<void> unite();
  bool is_as_before(const ExrInput& again, std::size_t input) const;
  std::size_t most_open() const;

  std::vector<std::string> paths_;
  int threads_each_ = 1;
  int parts_ = 0;
  std::string name_;       // of the part
  std::vector<int> part_;  // of each image
  std::vector<PixelWindow> windows_;
  bool crops_ = false;
  std::string space_assumed_of_;
  PartHeader header_;
  std::vector<PlaneSpec> planes_;
  int chunk_lines_ = 1;
  std::vector<std::unique_ptr<ExrInput>> open_;  // of the first few images
  std::mutex opening_;                           // OpenEXR has settings common to all files
};

}  // namespace spectile::io
