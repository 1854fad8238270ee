// Smits's choice of basis spectra for one colour, branching as the paper does.
#pragma once

#include <cstddef>

namespace spectile::reference {

/// Rows of a Smits table are white, cyan, magenta, yellow, red, green, blue.
enum SmitsBasis : std::size_t { kWhite, kCyan, kMagenta, kYellow, kRed, kGreen, kBlue, kSmitsBases };

/// Weight of white, of one secondary and of one primary, and which two those are.
template <class T>
struct SmitsMixtureOf {
  T white, second, first;
  std::size_t second_index, first_index;
};
using SmitsMixture = SmitsMixtureOf<float>;

/// The mixture for a colour: what all three share is white, what two share is their secondary, the rest a
/// primary. Source: Smits, An RGB-to-Spectrum Conversion for Reflectances, J. Graphics Tools 4(4), 1999.
template <class T>
SmitsMixtureOf<T> smits_mixture(T r, T g, T b) {
  if (g < r) {
    if (b < g) return {b, g - b, r - g, kYellow, kRed};
    if (r < b) return {g, r - g, b - r, kMagenta, kBlue};
    return {g, b - g, r - b, kMagenta, kRed};
  }
  if (b < r) return {b, r - b, g - r, kYellow, kGreen};
  if (g < b) return {r, g - r, b - g, kCyan, kBlue};
  return {r, b - r, g - b, kCyan, kGreen};
}

}  // namespace spectile::reference
