// Options that say how files of spectra are read, common to all commands that take one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/cli/options/common_options.hpp"

namespace spectile::cli {

/// As given on the command line.
struct SpectrumArguments {
  std::optional<Ends> ends;
  std::optional<WavelengthUnit> wavelengths;
  std::optional<double> missing;
  std::string values;  ///< of reflectances: "fraction", "percent" or a number
};

/// Adds --ends, of lights, --wavelengths and --missing.
void add_spectrum_options(const Command& command, SpectrumArguments& a);
/// Adds --ends of any spectrum under this flag.
void add_ends_option(const Command& command, std::optional<Ends>& ends, const char* flag, const char* text);
/// Adds --wavelengths and --missing.
void add_unit_options(const Command& command, SpectrumArguments& a);
/// Adds --values.
void add_values_option(const Command& command, SpectrumArguments& a);

/// The options of the library.
SpectrumFileOptions file_options(const SpectrumArguments& a);

/// Prints notes on spectra, a line each.
void print_notes(const Common& common, const std::vector<std::string>& notes);

}  // namespace spectile::cli
