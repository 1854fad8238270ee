// spectile spectra: lists the spectra known by name, and shows one of them or of a file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "src/cli/commands.hpp"
#include "src/cli/options/common_options.hpp"
#include "src/cli/options/parse.hpp"
#include "src/cli/options/spectrum_options.hpp"
#include "src/cli/output/plot.hpp"
#include "src/cli/output/print.hpp"

namespace spectile::cli {
namespace {

constexpr int kColumns = 66;
constexpr int kRows = 16;

struct SpectraArguments {
  Common common;
  std::optional<std::string> which;
  bool csv = false;
  std::vector<double> at;
  std::string column;
  SpectrumArguments spectra;
};

/// A spectrum as a list of samples, and its description.
struct Shown {
  std::string name;
  std::string kind;  ///< of NamedSpectrumInfo, or "formula" or "file"
  std::string about;
  std::string source;  ///< empty: none
  Spectrum spectrum;
  std::vector<double> wavelengths_nm;  ///< as published, or every nanometre of a formula
  std::vector<double> values;
  std::vector<std::string> notes;  ///< on how a file was read
};

/// True if it could be an illuminant: all but those that are surely something else.
bool may_be_illuminant(const Shown& s) {
  return s.kind == "illuminant" || s.kind == "formula" || s.kind == "file";
}

int list_all(const SpectraArguments& a) {
  std::string last;
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (a.csv) {
      if (last.empty()) print("name,kind,about,source,alias\n");
      print("{},\"{}\",\"{}\",\"{}\",{}\n", info.name, info.kind, info.about, info.source, info.alias);
    } else if (a.common.json) {
      print_json({{"name", info.name},
                  {"kind", info.kind},
                  {"about", info.about},
                  {"source", info.source},
                  {"alias", info.alias}});
    } else if (!a.common.quiet) {
      if (info.kind != last && !last.empty()) print("\n");
      if (info.kind != last) print("{}\n", info.kind);
      print("  {:<28} {}{}\n", info.name, info.about, info.alias.empty() ? "" : ", also " + info.alias);
    }
    last = info.kind;
  }
  if (!a.csv && !a.common.json && !a.common.quiet) {
    print("\nformula\n");
    print("  {:<28} {}\n", "blackbody:KELVIN", "thermal radiation, 1 at its maximum");
    print("  {:<28} {}\n", "daylight:KELVIN", "CIE daylight, 4000 to 25000 K, 100 at 560 nm");
    print("  {:<28} {}\n", "constant:VALUE", "the same at every wavelength");
  }
  return kOk;
}

Result<LoadedSpectrum> spectrum_of(const SpectraArguments& a) {
  SpectrumFileOptions options = file_options(a.spectra);
  options.column = a.column;
  if (!a.column.empty() && named_spectrum(*a.which)) {
    return Error{ErrorCode::kBadArgument,
                 fmt::format("\"{}\" is one spectrum by name; --column is for files", *a.which)};
  }
  return find_loaded_spectrum(*a.which, options);
}

/// Text on the values beyond the data.
std::string ends_text(const Shown& s, const SpectraArguments& a) {
  if (s.kind == "formula") return "continues beyond these";
  const auto* const linear = std::get_if<PiecewiseLinearSpectrum>(&s.spectrum.kind());
  const bool held = linear != nullptr && linear->ends() == Ends::kHeld;
  if (s.kind != "file" || a.spectra.ends) return held ? "held beyond its ends" : "0 beyond its ends";
  return "0 beyond its ends as a light, held as a reflectance";
}

Shown describe(const SpectraArguments& a, const Spectrum& spectrum) {
  Shown out{.name = *a.which,
            .kind = named_spectrum(*a.which) ? "formula" : "file",
            .about = spectrum.to_text(),
            .source = {},
            .spectrum = spectrum,
            .wavelengths_nm = {},
            .values = {},
            .notes = {}};
  for (const NamedSpectrumInfo& info : named_spectra()) {
    const std::string wanted = lower_case(*a.which);
    if (lower_case(info.name) != wanted && lower_case(info.alias) != wanted) continue;
    out.name = info.name;
    out.kind = info.kind;
    out.about = info.about;
    out.source = info.source;
  }
  if (const auto* const linear = std::get_if<PiecewiseLinearSpectrum>(&out.spectrum.kind())) {
    out.wavelengths_nm.assign(linear->wavelengths_nm().begin(), linear->wavelengths_nm().end());
    out.values.assign(linear->values().begin(), linear->values().end());
  } else if (const auto* const dense = std::get_if<DenselySampledSpectrum>(&out.spectrum.kind())) {
    for (int nm = dense->first_nm(); nm <= dense->last_nm(); ++nm) out.wavelengths_nm.push_back(nm);
    out.values.assign(dense->values().begin(), dense->values().end());
  } else {
    const MeasuredSpectrum table = *tabulated(out.spectrum);  // formulas are finite
    out.wavelengths_nm.assign(table.wavelengths_nm().begin(), table.wavelengths_nm().end());
    out.values.assign(table.values().begin(), table.values().end());
  }
  return out;
}

/// Chromaticity for the 2 degree observer; nothing where the spectrum has no luminance.
std::optional<std::array<double, 2>> chromaticity(const Spectrum& spectrum) {
  std::array<double, 3> xyz{};
  const char* const observer[] = {"cie1931-x", "cie1931-y", "cie1931-z"};
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const auto bar = named_spectrum(observer[i]);
    if (!bar) return std::nullopt;
    xyz[i] = inner_product(spectrum, *bar);
  }
  const double sum = xyz[0] + xyz[1] + xyz[2];
  if (!(xyz[1] > 0 && std::isfinite(sum))) return std::nullopt;
  return std::array{xyz[0] / sum, xyz[1] / sum};
}

struct Facts {
  double maximum = 0;
  double maximum_at_nm = 0;
  double average = 0;  ///< over 400 to 700 nm
  std::optional<std::array<double, 2>> xy;
};

Facts facts_of(const Shown& s) {
  Facts out;
  const auto top = std::max_element(s.values.begin(), s.values.end());
  out.maximum = *top;
  out.maximum_at_nm = s.wavelengths_nm[static_cast<std::size_t>(top - s.values.begin())];
  out.average = s.spectrum.integral(400, 700) / 300;
  if (may_be_illuminant(s)) out.xy = chromaticity(s.spectrum);
  return out;
}

void print_shown_json(const Shown& s, const SpectraArguments& a) {
  const Facts facts = facts_of(s);
  nlohmann::json out = {{"name", s.name},
                        {"kind", s.kind},
                        {"about", s.about},
                        {"first_nm", s.wavelengths_nm.front()},
                        {"last_nm", s.wavelengths_nm.back()},
                        {"maximum", facts.maximum},
                        {"maximum_at_nm", facts.maximum_at_nm},
                        {"average_400_700_nm", facts.average},
                        {"wavelengths_nm", s.wavelengths_nm},
                        {"values", s.values}};
  out["ends"] = ends_text(s, a);
  out["notes"] = s.notes;
  if (!s.source.empty()) out["source"] = s.source;
  if (facts.xy) out["chromaticity"] = *facts.xy;
  for (const double nm : a.at) out["at"].push_back({{"wavelength_nm", nm}, {"value", s.spectrum(nm)}});
  print_json(out);
}

void print_csv(const Shown& s, const SpectraArguments& a) {
  print("wavelength_nm,value\n");
  for (const double nm : a.at) print("{},{}\n", nm, s.spectrum(nm));
  if (!a.at.empty()) return;
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    print("{},{}\n", s.wavelengths_nm[i], s.values[i]);
  }
}

void print_drawing(const Shown& s) {
  const double first = s.wavelengths_nm.front();
  const double width = (s.wavelengths_nm.back() - first) / kColumns;
  std::vector<double> columns;
  columns.reserve(kColumns);
  for (int i = 0; i < kColumns; ++i) {
    columns.push_back(s.spectrum.integral(first + i * width, first + (i + 1) * width) / width);
  }
  for (const std::string& line : plot_columns(columns, kRows, first, s.wavelengths_nm.back())) {
    print("{}\n", line);
  }
}

void print_text(const Shown& s, const SpectraArguments& a) {
  print("{}: {}, {}{}\n", s.name, s.kind, s.about, s.source.empty() ? "" : " (" + s.source + ")");
  if (!a.at.empty()) {
    for (const double nm : a.at) print("  {:.10g} nm  {:.10g}\n", nm, s.spectrum(nm));
    return;
  }
  print_drawing(s);
  const Facts facts = facts_of(s);
  print("{:.6g} to {:.6g} nm, {} {}\n", s.wavelengths_nm.front(), s.wavelengths_nm.back(), s.values.size(),
        s.kind == "formula" ? "values drawn" : "samples");
  print("{}\n", ends_text(s, a));
  print("maximum {:.6g} at {:.6g} nm, average over 400 to 700 nm {:.6g}\n", facts.maximum,
        facts.maximum_at_nm, facts.average);
  if (facts.xy) {
    print("chromaticity {}x {:.4f}, y {:.4f} (2 degree observer)\n",
          s.kind == "file" ? "as an illuminant " : "", (*facts.xy)[0], (*facts.xy)[1]);
  }
}

int run_spectra(const SpectraArguments& a) {
  apply_common(a.common);
  if (!a.which) return list_all(a);
  LoadedSpectrum loaded = take(spectrum_of(a));
  Shown shown = describe(a, loaded.spectrum);
  shown.notes = std::move(loaded.notes);
  if (a.csv) {
    print_csv(shown, a);
  } else if (a.common.json) {
    print_shown_json(shown, a);
  } else if (!a.common.quiet) {
    print_text(shown, a);
    print_notes(a.common, shown.notes);
  }
  return kOk;
}

}  // namespace

void add_spectra(const Command& app, int& exit) {
  auto a = std::make_shared<SpectraArguments>();
  const Command command = app.subcommand("spectra", "List the spectra known by name, or show one");
  command.positional("SPECTRUM", a->which,
                     "Name, FILE or FILE:COLUMN, or blackbody:KELVIN, daylight:KELVIN, constant:VALUE", "");
  constexpr const char* kGroup = "Values";
  const Option csv = command.flag("--csv", a->csv, kGroup, "Print comma-separated values only");
  command.option("--at", a->at, "NM", kGroup, "Print the value at this wavelength in nm; may be repeated")
      .one_value()
      .check([](const std::string& text) {
        const auto nm = parse_numbers<double>(text, ',');
        return nm && nm->size() == 1 && std::isfinite(nm->front()) ? std::string()
                                                                   : text + " is not a wavelength";
      });
  command.option("--column", a->column, "NAME", kGroup,
                 "Spectrum of a file that holds several, by name or by number from 0");
  add_ends_option(command, a->spectra.ends, "--ends", "The spectrum beyond its data: zero, or held");
  add_unit_options(command, a->spectra);
  add_values_option(command, a->spectra);
  add_common(command, a->common, "spectile spectra blackbody:3200 --at 555");
  csv.excludes("--json");
  command.on_run([a, &exit] {
    if (!a->which && (!a->at.empty() || !a->column.empty())) {
      throw_usage_error("SPECTRUM, of which --at or --column asks, is required");
    }
    exit = run_spectra(*a);
  });
}

}  // namespace spectile::cli
