// Tables of spectra in files: how they are read, and what was found out about them.
#pragma once

#include <optional>
#include <spectile/spectra/measured_spectrum.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// Units of the wavelengths of a table; a wavenumber counts waves in a centimetre.
enum class WavelengthUnit { kNm, kUm, kM, kAngstrom, kPerCm };

/// "nm", "um", "m", "angstrom" or "cm^-1".
std::string_view to_string(WavelengthUnit unit) noexcept;

/// Use that a table is read for. It decides on the ends and on which values are refused.
enum class SpectrumUse {
  kAny,          ///< 0 beyond its ends, any values
  kLight,        ///< 0 beyond its ends
  kReflectance,  ///< held beyond its ends; values far outside 0 to 1 are an error
};

/// Facts about a table that its file does not state, or states wrongly.
struct SpectrumFileOptions {
  SpectrumUse use = SpectrumUse::kAny;
  std::optional<Ends> ends = {};                   ///< none: as the use has it
  std::optional<WavelengthUnit> wavelengths = {};  ///< none: as headings say, else by the numbers
  std::optional<double> one = {};      ///< the value that stands for 1: 1 for fractions, 100 for percent
  std::optional<double> missing = {};  ///< a value that marks a missing sample: -1.23e34
  std::string column = {};             ///< name of one spectrum, or its number from 0; empty: all of them
};

/// The spectra of a file, in its order.
struct SpectrumTable {
  std::vector<std::string> names;  ///< as headings have them, else numbers from 0
  std::vector<Spectrum> spectra;   ///< piecewise linear
  /// Lines for people, each with the file's name: units other than nm, percent, missing samples, a choice
  /// among several spectra.
  std::vector<std::string> notes;
};

/// Reads the spectra of a text file. Read are:
/// - columns "wavelength value value ...", apart by comma, semicolon, tab or spaces; or pairs of both on one
///   line, "380:0.9" too;
/// - lines "name,wavelength,value", put together by name;
/// - rows "name value value ..." under a heading row of wavelengths;
/// - CGATS (Argyll CMS's .sp and .cmf; fields nm380 or SPECTRAL_NM380 where there is no SPECTRAL_BANDS);
/// - IES TM-27 (.spdx);
/// - text exports of Sekonic, UPRtek and X-Rite i1 meters.
/// UTF-8 or UTF-16, any line ends, quotation marks, decimal commas where a comma cannot separate, comments
/// from # or // on, or lines that begin with ;. Headings are lines before the samples that begin with neither
/// digit, sign nor point. Units behind numbers are read. An empty cell is a missing sample. The format is
/// detected from the content, not from the name.
///
/// Wavelengths are nm where neither a heading nor the numbers say otherwise; samples out of order are sorted;
/// two samples at one wavelength are a step. Values in percent, by a heading, are divided by 100.
/// Errors: kBadFile with the path and, but for what is missing altogether, line and column; a table
/// without a sample within 360 to 830 nm; one whose wavelengths can be read in two units; for
/// reflectances, values far outside 0 to 1; a file above 64 MiB, 100000 spectra or bands; kNoPermission;
/// kBadArgument for a column that there is not. Source: CGATS.17; ANSI/IES TM-27-14; Argyll CMS, File
/// formats.
Result<SpectrumTable> load_spectrum_table(const std::string& path, const SpectrumFileOptions& options = {});

/// "FILE:COLUMN" apart: the file, and the column or an empty text. A text that is a file's path is that.
struct SpectrumPath {
  std::string file;
  std::string column;
};
SpectrumPath parse_spectrum_path(const std::string& text);

/// A spectrum by name, or one of a file, with what there is to say about it.
struct LoadedSpectrum {
  std::string name;  ///< published, or the file's without its folder
  Spectrum spectrum;
  std::vector<std::string> notes;
};

/// A name if there is one, else FILE or FILE:COLUMN. Of several columns one must be chosen; of several rows
/// of CGATS the first is taken, and said. Errors: those of named_spectrum() for a text that is no path of a
/// file and has neither point nor slash in it, else those of load_spectrum_table(). For a reflectance,
/// kBadArgument for a name that is none.
Result<LoadedSpectrum> find_loaded_spectrum(const std::string& name_or_path,
                                            const SpectrumFileOptions& options = {});

/// Reflectances for a scene: all spectra of FILE, one of FILE:COLUMN, or one by its name. Options and errors
/// as above.
Result<SpectrumTable> find_reflectances(const std::string& name_or_path, SpectrumFileOptions options = {});

}  // namespace spectile
