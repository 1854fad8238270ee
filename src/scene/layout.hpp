// The plan of a procedural scene: rectangles cut into the cells of a grid, in which points are found quickly.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <vector>

namespace spectile::scene {

/// at0 + slope * t, which is nowhere meant to be below 0: where it ends at 0 rounding must not take it there.
struct Linear {
  double at0 = 1;
  double slope = 0;
  double operator()(double t) const noexcept { return std::max(0.0, at0 + slope * t); }
};

/// A rectangle of the unit square, lower ends inclusive: scale * along_x(x) * along_y(y) times a spectrum.
struct Rectangle {
  double x0 = 0, x1 = 1, y0 = 0, y1 = 1;
  double scale = 0;
  Linear along_x, along_y;
  std::size_t spectrum = 0;
  double factor(double x, double y) const noexcept { return scale * along_x(x) * along_y(y); }
};

/// Spectra, and rectangles of them over one another.
struct Picture {
  std::vector<DenselySampledSpectrum> spectra;
  std::vector<Rectangle> rectangles;
};

/// Ascending edges from 0 to 1, and which interval between them a number lies in.
class Edges {
 public:
  Edges() = default;
  /// Any numbers; those outside 0 to 1 are left out.
  explicit Edges(std::vector<double> at);
  const std::vector<double>& at() const noexcept { return at_; }
  std::size_t intervals() const noexcept { return at_.size() - 1; }
  /// The interval of t in [0, 1), lower ends inclusive.
  std::size_t find(double t) const noexcept {
    std::size_t i = guide_[static_cast<std::size_t>(t * kGuides)];
    while (at_[i + 1] <= t) ++i;
    return i;
  }

 private:
  static constexpr std::size_t kGuides = 256;
  std::vector<double> at_ = {0, 1};
  std::array<std::uint32_t, kGuides> guide_{};
};

/// Visible parts of a picture: each cell of the grid that all edges make belongs to one rectangle.
class Layout {
 public:
  explicit Layout(Picture picture);
  /// The rectangle at a point; outside the unit square and where nothing is painted one of scale 0.
  const Rectangle& at(double x, double y) const noexcept {
    if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return rectangles_[0];
    return of_cell(x_.find(x), y_.find(y));
  }
  const Rectangle& of_cell(std::size_t column, std::size_t row) const noexcept {
    return rectangles_[cells_[row * x_.intervals() + column]];
  }
  const Edges& x() const noexcept { return x_; }
  const Edges& y() const noexcept { return y_; }
  const std::vector<DenselySampledSpectrum>& spectra() const noexcept { return spectra_; }

 private:
  std::vector<DenselySampledSpectrum> spectra_;
  std::vector<Rectangle> rectangles_;  ///< the first is black
  Edges x_, y_;
  std::vector<std::uint16_t> cells_;
};

/// The pictures: their names, and each by its place among them.
std::vector<std::string> picture_names();
Picture picture(std::size_t which);

}  // namespace spectile::scene
