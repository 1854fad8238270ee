// Where a distribution is not smooth, or where its mass is.
#pragma once

#include <spectile/spectra/spectrum.hpp>
#include <vector>

namespace spectile {

/// Adds places to start a quadrature from: samples, widths of lobes, octaves of thermal radiation.
void add_breaks(const Spectrum& spectrum, std::vector<double>& breaks);

}  // namespace spectile
