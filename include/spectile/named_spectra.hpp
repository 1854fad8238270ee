// Spectra by name, and from files.
#pragma once

#include <spectile/spectrum.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// What there is to know of a named spectrum.
struct NamedSpectrumInfo {
  std::string name;    ///< "D65", "Cu-eta", "canon-eos-5d-mkii-r", "cie1931-x"
  std::string kind;    ///< "illuminant", "refractive index", "absorption index", "camera response", "observer",
                       ///< "reflectance"
  std::string about;   ///< a few words: "daylight, 6504 K"
  std::string source;  ///< who published it
};

/// All named spectra, in a fixed order, grouped by kind.
const std::vector<NamedSpectrumInfo>& named_spectra();

/// A spectrum by name, whatever its case: those of named_spectra(), and `blackbody:TEMPERATURE` (normalised to
/// a maximum of 1), `daylight:TEMPERATURE`, `constant:VALUE`. Values on their published scale; 0 outside the
/// published range. Errors: kUnknownName, naming those that are near; kBadArgument for a bad number.
Result<Spectrum> named_spectrum(std::string_view name);

/// Reads a spectrum from a file: CSV or plain columns ("wavelength_nm value"; comma, semicolon, tab or spaces
/// separate; blank lines, lines that start with #, and headings of words before the first sample are passed
/// over; columns after the second are an error), or CGATS (`.sp`, `.cmf`: SPECTRAL_START_NM, SPECTRAL_END_NM,
/// SPECTRAL_BANDS, SPECTRAL_NORM; BEGIN_DATA to END_DATA). Which it is is told by its text, not by its name.
/// `column` picks the data row of a CGATS file with several (x, y, z of an observer), from 0.
/// Samples out of order are sorted; two samples of one wavelength are a step (see MeasuredSpectrum); three of
/// one, a number that is not finite, or no sample at all are errors. One sample is a line of no width: an
/// error too. Errors: kBadFile with the path and the line's number; kNoPermission.
Result<Spectrum> load_spectrum(const std::string& path, std::size_t column = 0);

/// A name if there is one, else a file.
Result<Spectrum> find_spectrum(const std::string& name_or_path);

}  // namespace spectile
