// Basis spectra whose colours are exactly the corners of the RGB cube.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "src/color/working_space.hpp"

namespace spectile {

/// Seven spectra over bands: white, cyan, magenta, yellow, red, green, blue; each in [0, 1] times the white.
using BasisTable = std::vector<std::array<double, 7>>;

/// White is the constant 1; each of the others is the smoothest spectrum in [0, 1] (least integral of the
/// squared second derivative) whose colour is exactly its corner of the cube. Nothing where a corner is no
/// colour of a reflectance.
std::optional<BasisTable> smoothest_basis(const Bands& bands, const WorkingSpace& space);

/// Three spectra that sum to 1 and whose colours are exactly red, green and blue: those of Mallett and Yuksel
/// with the smoothest change that makes them exact for these bands and this light; the secondaries are their
/// sums. Nothing where there are none in [0, 1]. Source: Mallett, Yuksel, Spectral Primary Decomposition for
/// Rendering with sRGB Reflectance, EGSR 2019.
std::optional<BasisTable> primary_decomposition(const Bands& bands, const WorkingSpace& space);

/// Integral of the squared second derivative of a spectrum through the bands' centres, in units of a band.
double roughness(const Bands& bands, std::span<const double> spectrum);

}  // namespace spectile
