// The oracle: the same mathematics in double, straight from the definitions and independent of the library's
// own way.
#pragma once

#include <array>
#include <span>
#include <spectile/color/colorimetry.hpp>
#include <spectile/spectra/bands.hpp>
#include <spectile/upsampling/upsample.hpp>
#include <vector>

namespace spectile::oracle {

/// Average over [lower, upper] of the piecewise-linear function through sorted samples, constant beyond both
/// ends, as the difference of antiderivatives.
double average(std::span<const double> wavelengths_nm, std::span<const double> values, double lower_nm,
               double upper_nm);

/// Smits's seven bases over bands: [bands][7].
std::vector<std::array<double, 7>> smits_basis(Method method, Quantity quantity, const Bands& bands);

/// The spectrum of one linear sRGB colour; samples below `lowest` become it.
std::vector<double> smits_spectrum(const std::vector<std::array<double, 7>>& basis,
                                   const std::array<double, 3>& rgb, double lowest);

/// XYZ weights of each band by summing at 0.01 nm: [bands][3]. `light` null for emitted light. Then those of
/// pairs of bands, of which the first absorbs what the second emits.
std::vector<std::array<double, 3>> projection_weights(
    const Bands& bands, Observer observer, const MeasuredSpectrum* light,
    std::span<const std::pair<std::size_t, std::size_t>> pairs = {});

/// XYZ of a spectrum.
std::array<double, 3> project(const std::vector<std::array<double, 3>>& weights,
                              std::span<const double> spectrum);

/// Linear sRGB of XYZ, and back, from the four chromaticities of IEC 61966-2-1:1999.
std::array<double, 3> xyz_to_srgb(const std::array<double, 3>& xyz);
std::array<double, 3> srgb_to_xyz(const std::array<double, 3>& rgb);

/// CIEDE2000 of two XYZ colours in long double, with vectors in place of angles.
struct Difference {
  double value = 0;
  double size = 0;  ///< the largest of the colours' coordinates in CIELAB, by magnitude
  bool undecided =
      false;  ///< hues nearly opposite, or nearly no chroma: a rounding moves the result by a step
};
Difference ciede2000(const std::array<double, 3>& xyz_a, const std::array<double, 3>& xyz_b,
                     const std::array<double, 3>& white);

}  // namespace spectile::oracle
