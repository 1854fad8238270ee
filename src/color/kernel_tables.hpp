// Tables of projectors and response curves in the kernels' layout.
#pragma once

#include <spectile/color/colorimetry.hpp>
#include <spectile/color/response_curves.hpp>

namespace spectile {

struct ProjectorAccess {
  /// Shapes: [bands][4], three weights and 0.
  static const float* weights(const Projector& projector) noexcept { return projector.float_weights_.data(); }
  /// Shapes: [bands], the second of the three weights.
  static const float* luminance_weights(const Projector& projector) noexcept {
    return projector.luminance_weights_.data();
  }
};

struct ResponseCurvesAccess {
  /// Shapes: [3][470][2], a curve's value at 360 nm, 361 nm, ..., and its difference from the next value.
  static const float* table(const ResponseCurves& curves) noexcept { return curves.table_->data(); }
};

}  // namespace spectile
