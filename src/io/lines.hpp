// Operations on one line of colour that the image jobs share.
#pragma once

#include <cstddef>

#include <spectile/image.hpp>

#include "kernels/abi.hpp"
#include "src/io/conversion.hpp"

namespace spectile::io {

/// Work space for one line: three rows of floats, padded to whole blocks.
struct ColorLine {
  FloatBuffer memory;
  float* rows[3] = {nullptr, nullptr, nullptr};
  std::size_t padded = 0;
  static Result<ColorLine> create(int width);
};

/// Counts and, when asked to, blackens the pixels of a line that are not finite.
/// Rows are padded with finite values. Returns the number of those pixels.
std::uint64_t settle_nonfinite(const kernels::KernelTable& kernels, float* const rows[3], std::size_t width, int line,
                               NonFinite policy, LineStats& stats);

/// Counts pixels with a component below 0 and above 1, and clips the former when asked to. Returns the largest
/// component.
float settle_range(const kernels::KernelTable& kernels, float* const rows[3], std::size_t width, int line,
                   Negative policy, LineStats& stats);

}  // namespace spectile::io
