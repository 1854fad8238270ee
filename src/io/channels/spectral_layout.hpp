// Names of spectral channels: written as the layout says, read in every dialect that programs write.
#pragma once

#include <optional>
#include <span>
#include <spectile/spectra/bands.hpp>
#include <string>
#include <string_view>

#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// Kinds of spectral channels.
enum class SpectralKind {
  kReflective,   ///< T: reflectance or transmittance
  kReradiating,  ///< T of two wavelengths: light absorbed at one and emitted at another (fluorescence)
  kEmissive,     ///< S0: emitted or arriving light
  kPolarised,    ///< S1, S2, S3: the other Stokes components
};

struct SpectralChannel;
struct WrittenChannel;

/// A way to name spectral channels. The reader, the writer, `info` and the documentation have this table in
/// common.
struct Dialect {
  std::string_view key;  ///< by which options name it
  std::string_view name;
  std::string_view example;  ///< of a channel
  std::string_view meaning;  ///< of its numbers
  bool says_quantity;        ///< false: taken for light
  /// Reads a name without anything before it; some dialects have the wavelength in an attribute.
  std::optional<SpectralChannel> (*parse)(std::string_view name, const PartHeader& header);
  /// Names the band of that number, of light, or of reflectance where the dialect says the quantity.
  WrittenChannel (*write)(const Band& band, std::size_t number, SpectralKind kind);
};

std::span<const Dialect> dialects();
/// The dialect of a key, or null.
const Dialect* find_dialect(std::string_view key);

/// A channel name taken apart. Units: nm.
struct SpectralChannel {
  SpectralKind kind = SpectralKind::kReflective;
  int stokes = 0;            ///< kPolarised: 1 to 3
  double wavelength_nm = 0;  ///< the centre, or the lower edge where `lower_edge`
  double from_nm = 0;        ///< kReradiating: where the light is absorbed
  double lower_nm = 0;       ///< edges, where the name has both
  double upper_nm = 0;
  bool lower_edge = false;  ///< the band ends where the next one starts
  std::string prefix;       ///< layer, view or both, without the last point; empty: none
  const Dialect* dialect = nullptr;
};

/// A channel to be written, and what its name will be read as.
struct WrittenChannel {
  std::string name;
  SpectralChannel read;
  std::optional<double> metres = {};  ///< for an attribute NAME.wavelength, where a dialect needs one
};

/// "T.402,500000nm" or "S0.402,500000nm".
/// Source: Fichet, Pacanowski, Wilkie, An OpenEXR Layout for Spectral Images, JCGT 10(3), 2021.
std::string spectral_channel_name(SpectralKind kind, double wavelength_nm);

/// "S1.402,500000nm", of a Stokes component from 0 to 3.
std::string stokes_channel_name(int component, double wavelength_nm);
/// "T.402,500000nm.502,500000nm".
std::string reradiation_channel_name(double from_nm, double to_nm);

/// True for a name that the grammar of the layout has, to the letter: decimal commas, an SI prefix, m or Hz.
bool is_strict_layout_name(std::string_view name);

/// Nothing for a name that is not spectral.
std::optional<SpectralChannel> parse_spectral_channel(std::string_view name, const PartHeader& header);

}  // namespace spectile::io
