// AreaFilter: one plane of an image becomes smaller levels of itself, line by line, each pixel the average of
// the area that it covers.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// Levels that are made together, and what each of them is made from. An average of averages is that of the
/// whole area where a level's pixels are whole pixels of the next; elsewhere a level is made from the image.
class LevelTree {
 public:
  struct Level {
    LevelSize size;
    LevelSize from;  // what it is made from: the image, or another level
    bool of_image = true;
    std::vector<std::size_t> children;  // levels that are made from it
  };
  LevelTree(LevelSize image, int first, int count);
  LevelSize image() const noexcept { return image_; }
  std::span<const Level> levels() const noexcept { return levels_; }

 private:
  LevelSize image_;
  std::vector<Level> levels_;
};

/// First line of an image that a level's lines before `end` don't need.
int lines_needed(int image_height, int level_height, int end);

/// Takes the lines of one plane, in order, and gives those of its levels as they are complete. Sums are
/// doubles, whose error is far below a float's rounding. NaN and infinities spread to all that they touch.
class AreaFilter {
 public:
  /// level: index in the tree; row: of the level's width.
  using Emit = std::function<void(std::size_t level, int line, const double* row)>;
  /// The tree must outlive it.
  explicit AreaFilter(const LevelTree& tree);
  /// The image's line y. Sample: float, or the bits of halves.
  template <class Sample>
  void add(int y, const Sample* row, const Emit& emit);

 private:
  template <class Sample>
  void feed(std::size_t level, int y, const Sample* row, const Emit& emit);
  const LevelTree& tree_;
  struct Sums {
    std::vector<double> across;  // averages along the present line
    std::vector<double> line;    // of the level's line that is being made
  };
  std::vector<Sums> sums_;
};

/// The image's column, or line, whose pixel lies nearest to the centre of a level's; the later of two.
inline int nearest(int image_side, int level_side, int at) {
  return static_cast<int>((2 * std::int64_t{at} + 1) * image_side / (2 * std::int64_t{level_side}));
}

}  // namespace spectile::io
