// Operations on one line of colour that the image jobs share.
#pragma once

#include <cstddef>
#include <spectile/image/image.hpp>

#include "kernels/abi.hpp"
#include "src/io/convert/frame/conversion.hpp"

namespace spectile::io {

/// Work space for one line: three rows of floats, padded to whole blocks.
struct ColorLine {
  FloatBuffer memory;
  float* rows[3] = {nullptr, nullptr, nullptr};
  std::size_t padded = 0;
  static Result<ColorLine> create(int width);
  /// For lines of less pixels than it was made for, those of a tile.
  void set_width(std::size_t width) { padded = blocks_for(width) * kLanesPerBlock; }
};

/// Largest magnitude of a component that is converted: beyond it sums of products could overflow.
inline constexpr float kLargestComponent = 0x1p124F;

/// Counts and, when asked to, blackens the pixels of a line that are not finite, or beyond kLargestComponent.
/// Rows are padded with zeros.
void sanitize_nonfinite(const kernels::KernelTable& kernels, float* const rows[3], std::size_t width,
                        int line, NonFinite policy, LineStats& stats);

/// Counts pixels with a component below 0 and above 1, and clips the former when asked to. Returns the
/// largest magnitude of a component.
float sanitize_range(const kernels::KernelTable& kernels, float* const rows[3], std::size_t width, int line,
                     NegativeInput policy, LineStats& stats);

}  // namespace spectile::io
