// PixelWindow: a rectangle of pixels, the one convention for windows, regions and crops.
#pragma once

#include <limits>

namespace spectile {

/// Pixels x0 to x1 - 1 of lines y0 to y1 - 1. Empty where x1 <= x0 or y1 <= y0.
struct PixelWindow {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  /// The window from its first to its last pixel, both included, as image files and option texts give it.
  /// The largest int is taken for one less.
  static constexpr PixelWindow inclusive(int first_x, int first_y, int last_x, int last_y) noexcept {
    constexpr int kLast = std::numeric_limits<int>::max() - 1;
    return {first_x, first_y, (last_x < kLast ? last_x : kLast) + 1, (last_y < kLast ? last_y : kLast) + 1};
  }
  /// Only for windows whose sides an int can hold.
  constexpr int width() const noexcept { return x1 - x0; }
  constexpr int height() const noexcept { return y1 - y0; }
  constexpr bool empty() const noexcept { return x1 <= x0 || y1 <= y0; }
  friend bool operator==(const PixelWindow&, const PixelWindow&) = default;
};

}  // namespace spectile
