// The arrangement of a text of columns: where headings end, and what a line of samples holds.
#pragma once

#include <cstddef>
#include <optional>
#include <spectile/spectra/spectrum_table.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/io/text/spectrum_cells.hpp"
#include "src/io/text/text_file.hpp"

namespace spectile::io {

/// How spectra are arranged in a text.
enum class Arrangement {
  kColumns,      ///< "wavelength value value ..."
  kPairs,        ///< "wavelength value wavelength value ..."
  kNamed,        ///< "name,wavelength,value"
  kRows,         ///< "name value value ..." under a heading row of wavelengths
  kNamelessRows  ///< "value value ..." under a row of wavelengths
};

/// Facts from a first pass over a file.
struct Layout {
  Arrangement arrangement = Arrangement::kColumns;
  CellFormat format;
  std::size_t first_line = 0;    ///< of samples; in front of it are headings; 0: there is none
  std::size_t heading_line = 0;  ///< of the last heading; of rows, that of wavelengths; 0: none
  std::size_t orphan_line = 0;   ///< a name and many values without wavelengths; 0: none
  bool two_readings = false;     ///< first row and first column could both be wavelengths
  bool labelled = false;         ///< "Spectral Data 380[nm],..."; lines without the label are passed over
  std::size_t run_first = 0;     ///< of wavelengths that begin anew: samples of the finest run, from 0
  std::size_t run_count = 0;     ///< 0: all of them
  std::size_t runs = 1;
};

/// A wavelength with the unit behind it.
struct WavelengthCell {
  double value = 0;
  std::optional<WavelengthUnit> unit;
};

/// The wavelength that a cell is: "380", "380nm", "380 [nm]", and after a meter's label "Spectral Data".
/// Nothing for others.
std::optional<WavelengthCell> wavelength_cell(std::string_view cell, bool decimal_comma);

/// The wavelength in a heading: as above, and "nm380", "R_400", "SPECTRAL_NM380".
std::optional<WavelengthCell> wavelength_heading(std::string_view cell, bool decimal_comma);

/// Facts that the lines in front of the samples state.
struct TableHeadings {
  std::optional<WavelengthUnit> unit;
  std::string unknown_unit;        ///< "THz": a unit that is not read
  bool percent = false;            ///< of all values
  std::string quantity;            ///< "reflectance", or empty
  std::vector<std::string> cells;  ///< of the last heading of columns
};

TableHeadings read_headings(const TextFile& file, const Layout& layout);

/// Finds the arrangement of a file, passing over it once.
Layout find_layout(const TextFile& file, std::optional<WavelengthUnit> stated_unit);

}  // namespace spectile::io
