// A working space: weights of a sampled spectrum to RGB such that white is exactly 1, 1, 1.
#pragma once

#include <array>
#include <spectile/color/colorimetry.hpp>
#include <vector>

namespace spectile {

/// Weights from the samples of a spectrum to RGB, band by band.
struct WorkingSpace {
  std::vector<std::array<double, 3>> weights;  ///< [bands]; times `white`, they sum to 1, 1, 1
  std::vector<double> white;  ///< [bands]: samples of the spectrum of RGB 1, 1, 1: ones, or the light's
  /// Of the light in the bands on its own scale, which `white` is divided by; 1 for reflectances.
  double luminance = 1;
  std::array<double, 3> white_xyz{};  ///< its XYZ, Y = 1
  Matrix3 rgb_to_xyz{};               ///< with that white
};

/// For reflectances: RGB 1, 1, 1 is the perfect diffuser under `light`. For emission: it is `light` itself,
/// scaled to Y = 1. The space's own white only says which light that should be; the bands' and the light's
/// own white counts, so that bands that cut off part of the visible range do not tint it. Errors:
/// kBadArgument where the light has no luminance in the bands, or primaries and white span no RGB.
Result<WorkingSpace> working_space(const Bands& bands, bool emission, const Chromaticities& primaries,
                                   const MeasuredSpectrum& light, Observer observer);

}  // namespace spectile
