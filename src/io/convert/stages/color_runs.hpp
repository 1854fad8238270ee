// Runs of a line's blocks whose spectra need not be computed: black ones, and those of one colour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spectile::io {

/// Blocks side by side that are dealt with in one way.
struct ColorRun {
  enum class Kind { kComputed, kConstant, kBlack };
  Kind kind = Kind::kComputed;
  std::size_t first = 0;  ///< pixel; a multiple of 64
  std::size_t pixels = 0;
};

/// Finds the runs of a line, and counts its black pixels and those of constant runs. Black is 0 with all its
/// bits, constant what has the same bits, of the scale too where there is one. The scale of black is 1.
struct FoundRuns {
  std::uint64_t black = 0;
  std::uint64_t constant = 0;
};
FoundRuns find_runs(const float* const rgb[3], const float* scale, std::size_t width,
                    std::vector<ColorRun>& runs);

}  // namespace spectile::io
