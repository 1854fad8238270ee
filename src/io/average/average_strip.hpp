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
  std::vector<exact::Depth> depths;  // of each plane; of no matter for integers
  exact::Weights weights;
  int width = 0;

  /// Bytes of a line of a strip.
  std::size_t line_bytes() const;
};

/// Where an image's integers differ from the first's.
struct Difference {
  std::size_t plane = 0;
  int x = 0;
  int y = 0;
  std::uint32_t here = 0;
  std::uint32_t first = 0;
};

/// Findings in an image's part of a strip.
struct Added {
  PixelCount nonfinite;
  std::optional<Difference> difference;
};

/// The sums, in the planes of Strip: integers as they are, other channels as words of exact sums.
class AverageStrip : public Strip {
 public:
  /// Errors: kOutOfMemory.
  static Result<std::shared_ptr<AverageStrip>> create(const AveragePlan& plan, int first_line, int lines);

  /// Adds an image's samples, `units` times. Calls may run side by side, but for that of the first image,
  /// whose integers the others' are compared with. Errors: kOutOfMemory.
  Result<Added> add(const Strip& samples, exact::Wide units, std::size_t image,
                    const kernels::KernelTable& kernels);

  /// The averages of a line of a plane, rounded to odd. Shape: averages [width].
  void averages(std::size_t plane, int line, double* averages) const;
  /// Counts the pixels of a line of which an image has a sample that is not finite.
  void count_nonfinite(int line, PixelCount& count) const;

 private:
  struct Line {
    std::mutex adding;
    bool missing = false;
    std::vector<std::vector<exact::Wide>> units;  // missing ones, of each plane; empty where none are
  };
  explicit AverageStrip(const AveragePlan& plan) : plan_(plan) {}
  bool add_line(const Strip& samples, int line, exact::Wide units, float* row, std::vector<char>& bad,
                const kernels::KernelTable& kernels);
  std::optional<Difference> match_integers(const Strip& samples, std::size_t plane, int line, bool first);
  std::uint8_t* flags(std::size_t plane, int line) const;
  std::uint64_t* sums(std::size_t plane, int line);

  const AveragePlan& plan_;
  FloatBuffer flags_;
  std::vector<Line> lines_;
};

}  // namespace spectile::io
