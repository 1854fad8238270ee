// A spectrum drawn in the terminal.
#pragma once

#include <span>
#include <spectile/spectra/bands.hpp>
#include <string>
#include <vector>

namespace spectile::cli {

/// Lines that draw one bar a value, the values being averages over even parts of a range of wavelengths.
/// Bars stand on 0, or on the smallest value where that is below 0.
std::vector<std::string> plot_columns(std::span<const double> values, int rows, double first_nm,
                                      double last_nm);
/// Lines that draw values over wavelengths, 60 columns wide and 10 rows high.
std::vector<std::string> plot(std::span<const float> values, const Bands& bands);

}  // namespace spectile::cli
