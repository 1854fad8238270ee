// Spectra by name, and from files.
#pragma once

#include <spectile/spectra/named_light.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <spectile/spectra/spectrum_table.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// Description of a named spectrum.
struct NamedSpectrumInfo {
  std::string name;  ///< "D65", "Cu-eta", "canon-eos-5d-mkii-r", "cie1931-x"
  std::string kind;  ///< "illuminant", "refractive index", "absorption index", "camera response", "observer",
                     ///< "reflectance"
  std::string about;   ///< a few words: "daylight, 6504 K"
  std::string source;  ///< who published it
  std::string alias;   ///< another name, or empty: "copper-eta"
};

/// All named spectra, in a fixed order, grouped by kind.
const std::vector<NamedSpectrumInfo>& named_spectra();

/// A spectrum by name or alias, whatever its case: those of named_spectra(), and `blackbody:TEMPERATURE`
/// (normalised to a maximum of 1), `daylight:TEMPERATURE`, `constant:VALUE`. Values on their published scale;
/// 0 outside the published range, but for reflectances, which keep their nearest value. Errors: kUnknownName,
/// naming those that are near; kBadArgument for a bad number.
Result<Spectrum> named_spectrum(std::string_view name);

/// One spectrum of a file, as load_spectrum_table() reads it, without its notes; 0 beyond its ends.
/// `column` counts from 0; where none is given, a file of columns must hold one spectrum, and of CGATS the
/// first row is taken. Errors: those of load_spectrum_table().
Result<Spectrum> load_spectrum(const std::string& path, std::optional<std::size_t> column = {});

/// Every spectrum of a file, in its order, as load_spectrum_table() reads them, without its notes; 0 beyond
/// their ends.
Result<std::vector<Spectrum>> load_spectra(const std::string& path);

/// A name if there is one, else a file, without its notes. Errors: those of find_loaded_spectrum().
Result<Spectrum> find_spectrum(const std::string& name_or_path);

/// The same as a light, under its published name or the file's name without its folder, with its notes. A
/// light of a file whose ends are held is continued to 300 and 830 nm. Errors: those of
/// find_loaded_spectrum() and check_light(); kBadArgument for a name that is no light: a refractive or
/// absorption index, a reflectance.
Result<NamedLight> find_light(const std::string& name_or_path, SpectrumFileOptions options = {});

}  // namespace spectile
