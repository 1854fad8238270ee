// AverageStrip: a run of lines of exact sums, to which images are added side by side.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <spectile/result.hpp>
#include <vector>

#include "kernels/abi.hpp"
#include "src/io/average/exact_average.hpp"
#include "src/io/convert/frame/conversion.hpp"
#include "src/io/exr/strips.hpp"

namespace spectile::io {

/// How the planes of a strip are summed.
struct AveragePlan {
  std::vector<PlaneSpec> planes;
  std::vector<bool> kept;            // of each plane: not averaged, the first image's that covers a pixel
  std::vector<exact::Depth> depths;  // of each plane; of no matter for those that are kept
  exact::Weights weights;
  std::vector<PixelWindow> windows;  // of the images that are added, from the average's upper left corner
  int width = 0;

  /// Bytes of a line of a strip.
  std::size_t line_bytes() const;
  /// Bytes that a plane takes for each pixel.
  std::size_t pixel_bytes(std::size_t plane) const;
};

/// The sums, in the planes of Strip: samples that are kept as they are, of others the words of exact sums.
class AverageStrip : public Strip {
 public:
  /// Errors: kOutOfMemory.
  static Result<std::shared_ptr<AverageStrip>> create(const AveragePlan& plan, int first_line, int lines);

  /// Lines of image `image` of the plan that the strip needs, counted from its own window's top; `lines` is 0
  /// where there are none.
  struct Lines {
    int first = 0;
    int lines = 0;
  };
  Lines lines_of(std::size_t image) const;

  /// Adds an image's samples, `units` times; `samples` holds lines_of() it, null where there are none. Calls
  /// may run side by side. Returns the pixels with samples that are not finite, counted from the corner of
  /// the image's own window. Errors: kOutOfMemory.
  Result<PixelCount> add(const Strip* samples, exact::Wide units, std::size_t image,
                         const kernels::KernelTable& kernels);

  /// The averages of a line of a plane, rounded to odd. Shape: averages [width].
  void averages(std::size_t plane, int line, double* averages) const;
  /// Counts the pixels of a line of which an image has a sample that is not finite.
  void count_nonfinite(int line, PixelCount& count) const;
  /// Pixels of a line that no image covers.
  std::uint64_t uncovered(int line) const;

 private:
  struct Line {
    std::mutex adding;
    bool missing = false;
    std::vector<std::vector<exact::Wide>> units;  // missing ones, of each plane; empty where none are
    std::vector<exact::Wide> outside;             // those of images that do not cover a pixel; empty: of none
  };
  explicit AverageStrip(const AveragePlan& plan) : plan_(plan) {}
  bool add_line(const Strip& samples, int line, exact::Wide units, std::size_t image, float* row,
                std::vector<char>& bad, const kernels::KernelTable& kernels);
  void leave_out(int line, exact::Wide units, int from, int to);
  void keep_line(const Strip& samples, int line, std::size_t image);
  std::uint8_t* flags(std::size_t plane, int line) const;
  std::uint64_t* sums(std::size_t plane, int line);

  const AveragePlan& plan_;
  FloatBuffer flags_;
  std::vector<Line> lines_;
};

}  // namespace spectile::io
