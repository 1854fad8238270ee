// Names of spectral channels: written as the layout says, read liberally.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace spectile::io {

/// Kinds of spectral channels.
enum class SpectralKind {
  kReflective,  ///< T: reflectance or transmittance
  kEmissive,    ///< S0: emitted or arriving light
  kPolarised,   ///< S1, S2, S3: the other Stokes components
};

/// A channel name taken apart. Units: nm.
struct SpectralChannel {
  SpectralKind kind = SpectralKind::kReflective;
  double wavelength_nm = 0;
};

/// "T.402,500000nm" or "S0.402,500000nm".
/// Source: Fichet, Pacanowski, Wilkie, An OpenEXR Layout for Spectral Images, JCGT 10(3), 2021.
std::string spectral_channel_name(SpectralKind kind, double wavelength_nm);

/// Reads a name with any number of decimals, a comma or a point, any SI prefix, metres or hertz.
/// Nothing for a name that is not spectral.
std::optional<SpectralChannel> parse_spectral_channel(std::string_view name);

}  // namespace spectile::io
