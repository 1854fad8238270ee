// The published tables: observers, illuminants, basis spectra.
#pragma once

#include <span>

namespace spectile::data {

/// Colour matching functions at even wavelengths. Units: nm.
struct MatchingFunctions {
  double first_nm;
  double step_nm;
  std::span<const double> x_bar, y_bar, z_bar;
};

/// A spectral power distribution at even wavelengths, on its published scale. Units: nm.
struct NamedTable {
  const char* name;
  double first_nm;
  double step_nm;
  std::span<const double> values;
};

/// Smits's seven basis spectra and the factor that goes with them.
struct SmitsData {
  double scale;
  std::span<const double> wavelengths_nm;
  std::span<const double> basis[7];  // white, cyan, magenta, yellow, red, green, blue
};

extern const MatchingFunctions kCie1931;
extern const MatchingFunctions kCie1964;
std::span<const NamedTable> illuminants();
extern const SmitsData kSmitsReflectance;
extern const SmitsData kSmitsIlluminant;
extern const SmitsData kSmits1999;

}  // namespace spectile::data
