// The published tables: observers, illuminants, basis spectra, materials, a camera, a colour chart.
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

/// Daylight is S0 + M1 S1 + M2 S2. Units: nm.
struct DaylightBasis {
  double first_nm;
  double step_nm;
  std::span<const double> s0, s1, s2;
};

/// A material's refractive index eta and absorption index k, which glasses lack. Units: nm.
struct OpticalConstants {
  const char* symbol;
  const char* material;
  std::span<const double> wavelengths_nm;
  std::span<const double> eta, k;
};

/// Smits's seven basis spectra and the factor that goes with them.
struct SmitsData {
  double scale;
  std::span<const double> wavelengths_nm;
  std::span<const double> basis[7];  // white, cyan, magenta, yellow, red, green, blue
};

/// Three basis spectra that sum to 1. Units: nm.
struct PrimaryDecomposition {
  std::span<const double> wavelengths_nm;
  std::span<const double> primaries[3];  // red, green, blue
};

/// Seven basis spectra over the default bands (400:700:5), for sRGB under D65 and the 2 degree observer:
/// [60][7], white, cyan, magenta, yellow, red, green, blue.
using BasisRows = std::span<const double[7]>;

/// Coefficients of sigmoids at the nodes of a grid of sRGB colours: [3][steps][steps][steps][3].
struct SigmoidStart {
  int steps;
  std::span<const double> nodes;
};

extern const MatchingFunctions kCie1931;
extern const MatchingFunctions kCie1964;
std::span<const NamedTable> illuminants();
extern const DaylightBasis kDaylightBasis;
std::span<const OpticalConstants> optical_constants();
std::span<const NamedTable> canon_eos_5d_mkii();  // r, g, b
std::span<const NamedTable> colorchecker();       // 24 patches
extern const SmitsData kSmitsReflectance;
extern const SmitsData kSmitsIlluminant;
extern const SmitsData kSmits1999;
extern const PrimaryDecomposition kMallettYuksel;
// Computed by tools/generate_tables.
extern const BasisRows kSmitsExact;
extern const BasisRows kMallettExact;
extern const SigmoidStart kSigmoidStart;

}  // namespace spectile::data
