// Tables of spectra as files hold them, before units and missing samples are known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <spectile/result.hpp>
#include <spectile/spectra/spectrum_table.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/io/text/text_file.hpp"

namespace spectile::io {

inline constexpr std::size_t kMaxSpectra = 100000;

/// Wavelengths that spectra share, in the unit of the file, each with the number of its line.
struct RawAxis {
  std::vector<double> wavelengths;
  std::vector<std::uint32_t> lines;  ///< 0: of no line of its own
};

/// Values as a file has them. Shapes: as many as wavelengths of the axis.
struct RawSpectrum {
  std::string name;
  std::size_t axis = 0;
  std::vector<double> values;  ///< NaN: an empty cell
  std::uint32_t line = 0;      ///< of all values; 0: those of the axis
  bool percent = false;
};

/// The spectra of a file, unsorted, and what it says about them.
struct RawTable {
  std::vector<RawAxis> axes;
  std::vector<RawSpectrum> spectra;
  std::optional<WavelengthUnit> unit;  ///< as the file states it
  std::string unit_source;             ///< "as its heading says"
  bool sure_of_unit = false;           ///< nm by definition of the format
  std::string quantity;                ///< that headings name: "reflectance", or empty
  std::size_t empty_cells = 0;
  bool first_by_default = false;   ///< of several the first is taken where one is asked for
  std::vector<std::string> notes;  ///< without the file's name
};

/// Where one spectrum of a file is wanted: its name, or its number from 0.
struct ColumnChoice {
  std::string name;                   ///< empty: by number
  std::optional<std::size_t> number;  ///< none and no name: any
};

/// Columns, pairs, lists by name and rows under wavelengths; see load_spectrum_table(). Errors: kBadFile.
Result<RawTable> read_columns(const TextFile& file, std::optional<WavelengthUnit> stated_unit);

/// True if a text is CGATS: its first word is SPECT, CMF or CGATS and something, or a line begins with
/// SPECTRAL_BANDS, BEGIN_DATA or BEGIN_DATA_FORMAT.
bool is_cgats(const TextFile& file);

/// All rows of CGATS data, or the chosen one. Errors: kBadFile; kBadArgument for a row that there is not.
Result<RawTable> read_cgats(const TextFile& file, const ColumnChoice& choice);

/// True if a text is XML.
bool is_xml(const TextFile& file);

/// IES TM-27. Errors: kBadFile.
Result<RawTable> read_spdx(const TextFile& file);

/// The spectrum that is chosen among names; a name wins over a number, which is noted. Errors: kBadArgument
/// for one that there is not, listing what there is.
Result<std::size_t> chosen(const TextFile& file, const std::vector<std::string>& names,
                           const ColumnChoice& choice, const char* noun, std::vector<std::string>& notes);

/// A few of the names, for an error or a note: "a, b, c and 21 more".
std::string list_names(const std::vector<std::string>& names);

/// The unit in which wavelengths lie in the visible range, where there is no doubt.
struct UnitGuess {
  std::optional<WavelengthUnit> unit;     ///< none: none does, or two do
  std::optional<WavelengthUnit> another;  ///< in which they could be as well
};
UnitGuess guess_unit(const std::vector<double>& wavelengths);

/// In nm, without what multiplying by a power of ten adds in the last bits.
double in_nm(double wavelength, WavelengthUnit unit);

/// True if samples lie within the visible range, or on both sides of it.
bool covers_visible(const std::vector<double>& wavelengths, WavelengthUnit unit);

/// Spectra in nm with what there is to say about them. Errors: as for load_spectrum_table().
Result<SpectrumTable> finish_table(const TextFile& file, RawTable raw, const SpectrumFileOptions& options);

}  // namespace spectile::io
