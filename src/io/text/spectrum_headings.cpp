// Units and quantities as headings of tables of spectra name them.
#include "src/io/text/spectrum_headings.hpp"

#include <algorithm>
#include <cctype>

namespace spectile::io {
namespace {

std::string lower_ascii(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

struct UnitWord {
  std::string_view word;  ///< in lower case
  WavelengthUnit unit;
};

// With the micro sign and the letter mu of UTF-8, the micro sign and ring A of Latin-1, and the sign for
// angstrom.
constexpr UnitWord kUnitWords[] = {{"nm", WavelengthUnit::kNm},
                                   {"nanometer", WavelengthUnit::kNm},
                                   {"nanometers", WavelengthUnit::kNm},
                                   {"nanometre", WavelengthUnit::kNm},
                                   {"nanometres", WavelengthUnit::kNm},
                                   {"um", WavelengthUnit::kUm},
                                   {"\xC2\xB5m", WavelengthUnit::kUm},
                                   {"\xCE\xBCm", WavelengthUnit::kUm},
                                   {"\xB5m", WavelengthUnit::kUm},
                                   {"micron", WavelengthUnit::kUm},
                                   {"microns", WavelengthUnit::kUm},
                                   {"micrometer", WavelengthUnit::kUm},
                                   {"micrometers", WavelengthUnit::kUm},
                                   {"micrometre", WavelengthUnit::kUm},
                                   {"micrometres", WavelengthUnit::kUm},
                                   {"metre", WavelengthUnit::kM},
                                   {"metres", WavelengthUnit::kM},
                                   {"meter", WavelengthUnit::kM},
                                   {"meters", WavelengthUnit::kM},
                                   {"angstrom", WavelengthUnit::kAngstrom},
                                   {"angstroms", WavelengthUnit::kAngstrom},
                                   {"\xC3\xA5ngstr\xC3\xB6m", WavelengthUnit::kAngstrom},
                                   {"\xC3\x85ngstr\xC3\xB6m", WavelengthUnit::kAngstrom},
                                   {"\xC3\x85", WavelengthUnit::kAngstrom},
                                   {"\xE2\x84\xAB", WavelengthUnit::kAngstrom},
                                   {"\xC5", WavelengthUnit::kAngstrom}};
/// Too short to be taken for units outside brackets.
constexpr UnitWord kBracketedUnits[] = {{"m", WavelengthUnit::kM}, {"a", WavelengthUnit::kAngstrom}};
constexpr std::string_view kWavenumbers[] = {"cm-1",
                                             "cm^-1",
                                             "cm^{-1}",
                                             "1/cm",
                                             "cm\xE2\x81\xBB\xC2\xB9",
                                             "cm\xE2\x88\x92\x31",
                                             "wavenumber",
                                             "cm\xE2\x88\x92\xC2\xB9"};
constexpr std::string_view kUnreadUnits[] = {"ev", "mev", "hz", "ghz", "thz", "mm", "pm"};
constexpr std::string_view kWavelengthWords[] = {"wavelength", "wavelengths", "lambda", "\xCE\xBB", "wl"};
constexpr std::string_view kWordEnds = " \t,;:()[]{}<>=_\"'";

}  // namespace

std::optional<NamedUnit> unit_of_heading(std::string_view heading) {
  const std::string text = lower_ascii(heading);
  std::optional<NamedUnit> found;
  bool two = false;
  const auto add = [&](std::optional<WavelengthUnit> unit, std::string_view unknown) {
    two = two || (found && found->unit != unit);
    found = NamedUnit{unit, std::string(unknown)};
  };
  for (const std::string_view word : kWavenumbers) {
    if (text.find(word) != std::string::npos) add(WavelengthUnit::kPerCm, {});
  }
  std::string_view before;
  for (std::size_t at = 0; at < text.size();) {
    at = text.find_first_not_of(kWordEnds, at);
    if (at == std::string::npos) break;
    const std::size_t end = std::min(text.find_first_of(kWordEnds, at), text.size());
    std::string_view word = std::string_view(text).substr(at, end - at);
    // "wavelength /um" and "lambda/nm", as ISO 80000 divides quantities by units; never "W/nm".
    const std::size_t slash = word.rfind('/');
    if (slash != std::string_view::npos &&
        std::ranges::find(kWavelengthWords, slash == 0 ? before : word.substr(0, slash)) !=
            std::end(kWavelengthWords)) {
      word.remove_prefix(slash + 1);
    }
    before = word;
    const bool bracketed = at > 0 && (text[at - 1] == '(' || text[at - 1] == '[');
    for (const UnitWord& known : kUnitWords) {
      if (word == known.word) add(known.unit, {});
    }
    for (const UnitWord& known : kBracketedUnits) {
      if (bracketed && word == known.word) add(known.unit, {});
    }
    if (std::ranges::find(kUnreadUnits, word) != std::end(kUnreadUnits)) {
      add(std::nullopt, heading.substr(at, end - at));
    }
    at = end;
  }
  return two ? std::nullopt : found;
}

std::optional<WavelengthUnit> unit_behind_number(std::string_view text) {
  if (text.size() > 2 &&
      ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')'))) {
    text = text.substr(1, text.size() - 2);
  }
  const std::string word = lower_ascii(text);
  for (const UnitWord& known : kUnitWords) {
    if (word == known.word) return known.unit;
  }
  if (word == "a") return WavelengthUnit::kAngstrom;
  if (word == "m") return WavelengthUnit::kM;
  if (std::ranges::find(kWavenumbers, word) != std::end(kWavenumbers)) return WavelengthUnit::kPerCm;
  return std::nullopt;
}

std::string_view part_on_wavelengths(std::string_view line) {
  const std::string text = lower_ascii(line);
  for (const std::string_view key :
       {"x unit", "xunit", "x_unit", "wavelength", "wavenumber", "lambda", "\xCE\xBB"}) {
    const std::size_t at = text.find(key);
    if (at == std::string::npos) continue;
    return line.substr(at, line.find_first_of(",;\t", at) - at);
  }
  return {};
}

bool says_percent(std::string_view heading) {
  const std::string text = lower_ascii(heading);
  if (text.find("percent") != std::string::npos) return true;
  for (std::size_t at = text.find('%'); at != std::string::npos; at = text.find('%', at + 1)) {
    // "a panel of 99 %" is a title.
    const std::size_t before = at == 0 ? std::string::npos : text.find_last_not_of(' ', at - 1);
    if (before == std::string::npos || std::isdigit(static_cast<unsigned char>(text[before])) == 0)
      return true;
  }
  return false;
}

bool describes_values(std::string_view line) {
  const std::string text = lower_ascii(line);
  return text.find("y unit") != std::string::npos || text.find("yunit") != std::string::npos ||
         text.find("y_unit") != std::string::npos;
}

std::string quantity_of_heading(std::string_view heading) {
  const std::string text = lower_ascii(heading);
  for (const char* quantity : {"reflectance", "transmittance", "absorbance", "refractive index"}) {
    if (text.find(quantity) != std::string::npos) return quantity;
  }
  return {};
}

}  // namespace spectile::io
