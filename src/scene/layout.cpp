// The plan of a procedural scene: painting rectangles into a grid of all their edges.
#include "src/scene/layout.hpp"

#include <algorithm>

namespace spectile::scene {
namespace {

std::vector<double> sorted_edges(const std::vector<Rectangle>& rectangles, double Rectangle::*low,
                                 double Rectangle::*high) {
  std::vector<double> out;
  for (const Rectangle& r : rectangles) {
    out.push_back(r.*low);
    out.push_back(r.*high);
  }
  return out;
}

}  // namespace

Edges::Edges(std::vector<double> at) : at_(std::move(at)) {
  std::erase_if(at_, [](double t) { return !(t > 0 && t < 1); });
  at_.push_back(0);
  at_.push_back(1);
  std::ranges::sort(at_);
  at_.erase(std::unique(at_.begin(), at_.end()), at_.end());
  std::uint32_t i = 0;
  for (std::size_t g = 0; g < kGuides; ++g) {
    // A product with a power of two is exact, so a number's guide never lies above it.
    const double from = static_cast<double>(g) / kGuides;
    while (at_[i + 1] <= from) ++i;
    guide_[g] = i;
  }
}

Layout::Layout(Picture picture)
    : spectra_(std::move(picture.spectra)),
      rectangles_{Rectangle{}},
      x_(sorted_edges(picture.rectangles, &Rectangle::x0, &Rectangle::x1)),
      y_(sorted_edges(picture.rectangles, &Rectangle::y0, &Rectangle::y1)),
      cells_(x_.intervals() * y_.intervals()) {
  rectangles_.insert(rectangles_.end(), picture.rectangles.begin(), picture.rectangles.end());
  for (std::size_t r = 1; r < rectangles_.size(); ++r) {
    const Rectangle& paint = rectangles_[r];
    for (std::size_t row = 0; row < y_.intervals(); ++row) {
      if (y_.at()[row] < paint.y0 || y_.at()[row] >= paint.y1) continue;
      for (std::size_t column = 0; column < x_.intervals(); ++column) {
        if (x_.at()[column] < paint.x0 || x_.at()[column] >= paint.x1) continue;
        cells_[row * x_.intervals() + column] = static_cast<std::uint16_t>(r);
      }
    }
  }
}

}  // namespace spectile::scene
