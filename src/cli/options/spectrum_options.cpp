// Options that say how files of spectra are read, common to all commands that take one.
#include "src/cli/options/spectrum_options.hpp"

#include <cmath>

#include "src/cli/options/parse.hpp"
#include "src/cli/output/print.hpp"

namespace spectile::cli {
namespace {

constexpr const char* kTablesGroup = "Files of spectra";
constexpr Choice<Ends> kEnds[] = {{"zero", Ends::kZero}, {"held", Ends::kHeld}};
constexpr Choice<WavelengthUnit> kWavelengthUnits[] = {
    {"nm", WavelengthUnit::kNm},      {"um", WavelengthUnit::kUm},
    {"m", WavelengthUnit::kM},        {"angstrom", WavelengthUnit::kAngstrom},
    {"cm-1", WavelengthUnit::kPerCm}, {"cm^-1", WavelengthUnit::kPerCm}};

/// The value that stands for 1; nothing for other texts.
std::optional<double> value_of_one(const std::string& text) {
  if (text == "fraction") return 1;
  if (text == "percent") return 100;
  const auto number = parse_numbers<double>(text, ',');
  const bool good = number && number->size() == 1 && std::isfinite(number->front()) && number->front() > 0;
  return good ? std::optional(number->front()) : std::nullopt;
}

}  // namespace

void add_ends_option(const Command& command, std::optional<Ends>& ends, const char* flag, const char* text) {
  command.choice(flag, ends, kEnds, kTablesGroup, text);
}

void add_unit_options(const Command& command, SpectrumArguments& a) {
  command.choice("--wavelengths", a.wavelengths, kWavelengthUnits, kTablesGroup,
                 "nm, um, m, angstrom or cm-1; by default as headings or numbers say");
  command.option("--missing", a.missing, "VALUE", kTablesGroup,
                 "Value that marks missing samples, such as -1.23e34");
}

void add_values_option(const Command& command, SpectrumArguments& a) {
  command
      .option("--values", a.values, "WHAT", kTablesGroup,
              "Reflectances are fraction, percent, or the number that stands for 1")
      .check([](const std::string& text) {
        return value_of_one(text) ? std::string()
                                  : text + " is neither fraction, percent nor a number above 0";
      });
}

void add_spectrum_options(const Command& command, SpectrumArguments& a) {
  add_ends_option(command, a.ends, "--ends", "Lights beyond their data: zero, or held; zero by default");
  add_unit_options(command, a);
}

SpectrumFileOptions file_options(const SpectrumArguments& a) {
  SpectrumFileOptions out;
  out.ends = a.ends;
  out.wavelengths = a.wavelengths;
  out.missing = a.missing;
  if (!a.values.empty()) out.one = value_of_one(a.values);
  return out;
}

void print_notes(const Common& common, const std::vector<std::string>& notes) {
  if (!common.shows_text()) return;
  for (const std::string& note : notes) print("note: {}\n", note);
}

}  // namespace spectile::cli
