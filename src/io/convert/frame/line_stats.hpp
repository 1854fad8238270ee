// LineStats: what a run of lines was found to hold, and what was and was not spent on it.
#pragma once

#include <array>
#include <cstdint>
#include <spectile/image/image.hpp>

namespace spectile::io {

/// Pixels and chunks computed, reused and filled, and the time that they took.
struct SkipCosts {
  std::uint64_t computed_pixels = 0;  // that went through a method's arithmetic
  double computing_seconds = 0;
  std::uint64_t filled_pixels = 0;  // that got the samples of a constant colour
  double filling_seconds = 0;
  std::uint64_t colors_looked_up = 0;
  std::uint64_t colors_solved = 0;
  std::uint64_t lanes_solved = 0;  // with those that fill up blocks
  double lookup_seconds = 0;       // without solving
  double solving_seconds = 0;
  std::uint64_t chunks = 0;
  std::uint64_t chunks_reused = 0;
  double reused_seconds = 0;  // that the first of the same chunks took
  void add(const SkipCosts& later);
};

/// Pixels of one kind in a run of lines: how many, and where the first is.
struct PixelCount {
  std::uint64_t count = 0;
  int first_x = -1;
  int first_y = -1;
  void add(std::uint64_t more, int x, int y);
  void add(const PixelCount& later);
  /// The same with a first pixel that is counted from elsewhere.
  PixelCount moved(const std::array<int, 2>& by) const { return {count, first_x + by[0], first_y + by[1]}; }
};

/// Counts of a run of lines.
struct LineStats {
  PixelCount nonfinite;
  PixelCount negative;
  PixelCount outside;  // colours that the method cannot make
  std::uint64_t over_one = 0;
  std::uint64_t clamped = 0;
  std::uint64_t divided_by_alpha = 0;
  std::uint64_t above_alpha = 0;  // colours, premultiplied, that no reflectance has
  std::uint64_t masked = 0;
  std::uint64_t black = 0;     // masked ones too
  std::uint64_t constant = 0;  // in whole blocks of one colour, not black
  SkipCosts costs;
  void add(const LineStats& later);
  /// The same of pixels elsewhere.
  LineStats moved(int right, int down) const;
};

/// The report of what was not computed.
SkipStats skip_stats(const LineStats& stats);

}  // namespace spectile::io
