// Pieces of a pixel filter's profile along one axis, for integration.
#pragma once

#include <spectile/film/pixel_filter.hpp>
#include <vector>

namespace spectile {

/// Access to a filter's parameters.
struct FilterAccess {
  /// Distances from 0 to the radius, ascending, between which the profile is so smooth that the ten-point
  /// rule integrates it, times a linear function, to a relative 1e-12 of its magnitude.
  static std::vector<double> smooth_pieces(const PixelFilter& filter, double radius);
};

}  // namespace spectile
