// What a pixel filter looks like along one axis, for those who integrate it piece by piece.
#pragma once

#include <spectile/film/pixel_filter.hpp>
#include <vector>

namespace spectile {

/// The way to a filter's parameters, which have no names of their own for all shapes.
struct FilterAccess {
  /// Distances from 0 to the radius, ascending, between which the profile is so smooth that the ten-point
  /// rule integrates it, times a linear function, to a relative 1e-12 of its magnitude.
  static std::vector<double> smooth_pieces(const PixelFilter& filter, double radius);
};

}  // namespace spectile
