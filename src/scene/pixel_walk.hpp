// The order in which the pixels of a film's window are drawn: tile by tile, and row by row within one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <spectile/film/film.hpp>

namespace spectile::scene {

/// StepPlan from pixel to pixel.
class PixelWalk {
 public:
  /// Stands before the pixel number `first` of the window; next() goes there.
  PixelWalk(const PixelWindow& window, std::uint64_t first) : window_(window) {
    const auto width = static_cast<std::uint64_t>(window.width());
    y0_ = window.y0;
    y1_ = end_offset(window.y0, window.y1);
    // Rows of tiles but the first and the last are whole.
    while (y1_ < window.y1 && first >= width * static_cast<std::uint64_t>(y1_ - y0_)) {
      first -= width * static_cast<std::uint64_t>(y1_ - y0_);
      to_next_row();
    }
    x0_ = window.x0;
    x1_ = end_offset(window.x0, window.x1);
    const auto rows = static_cast<std::uint64_t>(y1_ - y0_);
    while (x1_ < window.x1 && first >= rows * static_cast<std::uint64_t>(x1_ - x0_)) {
      first -= rows * static_cast<std::uint64_t>(x1_ - x0_);
      to_next_tile();
    }
    const auto columns = static_cast<std::uint64_t>(x1_ - x0_);
    y_ = y0_ + static_cast<int>(first / columns);
    x_ = x0_ + static_cast<int>(first % columns) - 1;
  }

  void next() {
    if (++x_ < x1_) return;
    x_ = x0_;
    if (++y_ < y1_) return;
    if (x1_ < window_.x1) {
      to_next_tile();
    } else {
      to_next_row();
      x0_ = window_.x0;
      x1_ = end_offset(x0_, window_.x1);
    }
    x_ = x0_;
    y_ = y0_;
  }

  int x() const noexcept { return x_; }
  int y() const noexcept { return y_; }

 private:
  /// Where the tile that begins at or before `from` ends.
  static int end_offset(int from, int limit) { return std::min(limit, (from / kFilmTile + 1) * kFilmTile); }
  void to_next_tile() {
    x0_ = x1_;
    x1_ = end_offset(x0_, window_.x1);
  }
  void to_next_row() {
    y0_ = y1_;
    y1_ = end_offset(y0_, window_.y1);
  }
  PixelWindow window_;
  int x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0;  ///< of the tile, cut off at the window
  int x_ = 0, y_ = 0;
};

}  // namespace spectile::scene
