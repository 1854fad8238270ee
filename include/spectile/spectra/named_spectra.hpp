// Spectra by name, and from files.
#pragma once

#include <spectile/spectra/named_light.hpp>
#include <spectile/spectra/spectrum.hpp>
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
/// 0 outside the published range. Errors: kUnknownName, naming those that are near; kBadArgument for a bad
/// number.
Result<Spectrum> named_spectrum(std::string_view name);

/// Reads a spectrum from a text file: CSV or plain columns ("wavelength_nm value"; comma, semicolon, tab or
/// spaces separate; blank lines, lines that start with #, and headings, lines before the first sample that
/// begin with neither digit, sign nor point, are passed over; columns after the second are an error), or
/// CGATS as Argyll CMS writes it (`.sp`, `.cmf`: SPECTRAL_START_NM, SPECTRAL_END_NM, SPECTRAL_BANDS; values
/// are divided by SPECTRAL_NORM, 1 where there is none; BEGIN_DATA to END_DATA, of the fields named SPEC_*
/// where fields are named; what follows is not read). The format is detected from the content,
/// not from the name.
/// `column` picks the data row of a CGATS file with several (x, y, z of an observer), from 0.
/// Samples out of order are sorted; two samples of one wavelength are a step (see MeasuredSpectrum); three of
/// one, a number that is not finite, a wavelength not above 0, or no sample at all are errors, and so are
/// samples all at one wavelength, a line of no width. A byte order mark and any kind of line ends are read.
/// Units: nm. Errors: kBadFile with the path and, but for what is missing altogether, the line's number; a
/// file above 64 MiB or 100000 bands; kNoPermission; kBadArgument for a `column` that there is not.
/// Source: CGATS.17; Argyll CMS, File formats.
Result<Spectrum> load_spectrum(const std::string& path, std::size_t column = 0);

/// Every spectrum of a file, in its order: those of a text of columns, whose lines hold a wavelength and a
/// value for each spectrum; of lines "name,wavelength_nm,value" (comma, semicolon or tab), put together by
/// name; or the rows of CGATS data. At most 100000. Rules, units and errors as for load_spectrum(); kBadFile
/// too for a line with more or fewer values than the first.
Result<std::vector<Spectrum>> load_spectra(const std::string& path);

/// A name if there is one, else a file. Errors: those of named_spectrum() for a text that is no path of a
/// file and has neither point nor slash in it, else those of load_spectrum().
Result<Spectrum> find_spectrum(const std::string& name_or_path);

/// The same as a light, under its published name or the file's name without its folder. Errors: those of
/// tabulated() too.
Result<NamedLight> find_light(const std::string& name_or_path);

}  // namespace spectile
