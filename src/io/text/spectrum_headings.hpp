// Units and quantities as headings of tables of spectra name them.
#pragma once

#include <optional>
#include <spectile/spectra/spectrum_table.hpp>
#include <string>
#include <string_view>

namespace spectile::io {

/// A unit of wavelengths that a text names, or one that is not read.
struct NamedUnit {
  std::optional<WavelengthUnit> unit;
  std::string unknown;  ///< "THz": a unit that is not read
};

/// The unit that a heading of wavelengths names: "Wavelength (micrometers)", "nm", "wavenumber". Nothing
/// where it names none, or two.
std::optional<NamedUnit> unit_of_heading(std::string_view heading);

/// The unit behind a number: "nm", "[nm]".
std::optional<WavelengthUnit> unit_behind_number(std::string_view text);

/// The part of a line that speaks of wavelengths, up to the next separator; empty where none does.
std::string_view part_on_wavelengths(std::string_view line);

/// True if a heading of values says percent.
bool says_percent(std::string_view heading);

/// True if a line describes the values of a table, not one column: "Y Units: Reflectance (percent)".
bool describes_values(std::string_view line);

/// "reflectance", "transmittance", "absorbance" or "refractive index" where a heading says so; else empty.
std::string quantity_of_heading(std::string_view heading);

}  // namespace spectile::io
