// Spectra from text files, and by name or file: the one loader of every table.
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/spectra/spectrum_table.hpp>

#include "src/base/errors.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile {
namespace {

/// A light or reflectance that an option continues, or ends, otherwise than usual does so up to here, in nm:
/// the range in which the CIE tabulates illuminants.
constexpr double kFirstContinuedNm = 300;
constexpr double kLastContinuedNm = 830;

bool is_file(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0;
}

/// All spectra of a file, or the chosen one.
Result<SpectrumTable> load_chosen(const std::string& path, const io::ColumnChoice& choice,
                                  const SpectrumFileOptions& options) {
  SPECTILE_ASSIGN(const auto file, io::read_text_file(path));
  const bool cgats = io::is_cgats(file);
  SPECTILE_ASSIGN(auto raw, io::is_xml(file) ? io::read_spdx(file)
                            : cgats          ? io::read_cgats(file, choice)
                                             : io::read_columns(file, options.wavelengths));
  if (!cgats && (choice.number || !choice.name.empty())) {
    std::vector<std::string> names;
    for (const io::RawSpectrum& s : raw.spectra) names.push_back(s.name);
    SPECTILE_ASSIGN(const auto at, io::chosen(file, names, choice, "spectrum", raw.notes));
    io::RawSpectrum one = std::move(raw.spectra[at]);
    one.axis = 0;
    raw.axes = {std::move(raw.axes[raw.spectra[at].axis])};
    raw.spectra.clear();
    raw.spectra.push_back(std::move(one));
  }
  return io::finish_table(file, std::move(raw), options);
}

/// One spectrum of a file: the chosen one, the only one, or the first of CGATS.
Result<SpectrumTable> load_one(const std::string& path, const io::ColumnChoice& choice,
                               const SpectrumFileOptions& options) {
  SPECTILE_ASSIGN(auto table, load_chosen(path, choice, options));
  if (table.spectra.size() == 1) return table;
  SPECTILE_ASSIGN(const auto file, io::read_text_file(path));
  const std::string what = fmt::format("{} spectra: {}", table.names.size(), io::list_names(table.names));
  if (!io::is_cgats(file)) {
    return io::line_error(
        file, 1, fmt::format("the file holds {}; choose one as FILE:NAME or FILE:NUMBER, from 0", what));
  }
  table.notes.push_back(
      fmt::format("{}: the first of {}; FILE:NAME or FILE:NUMBER takes another", path, what));
  table.spectra.erase(table.spectra.begin() + 1, table.spectra.end());
  return table;
}

/// The kind of a name, as named_spectra() has it; empty for formulas and files.
std::string kind_of(const std::string& name) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (std::ranges::equal(info.name, name, same) ||
        (!info.alias.empty() && std::ranges::equal(info.alias, name, same))) {
      return info.kind;
    }
  }
  return {};
}

std::string published_name(const std::string& text) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (std::ranges::equal(info.name, text, same)) return info.name;
  }
  return text;
}

/// Samples of a table and, up to the limits, those that its ends stand for. Shapes: none.
Result<MeasuredSpectrum> continued(const MeasuredSpectrum& table, Ends ends) {
  std::vector<double> nm(table.wavelengths_nm().begin(), table.wavelengths_nm().end());
  std::vector<double> values(table.values().begin(), table.values().end());
  const double left = ends == Ends::kHeld ? values.front() : 0;
  const double right = ends == Ends::kHeld ? values.back() : 0;
  if (nm.front() > kFirstContinuedNm) {
    if (left != values.front()) {
      nm.insert(nm.begin(), nm.front());
      values.insert(values.begin(), left);
    }
    nm.insert(nm.begin(), kFirstContinuedNm);
    values.insert(values.begin(), left);
  }
  if (nm.back() < kLastContinuedNm) {
    if (right != values.back()) {
      nm.push_back(nm.back());
      values.push_back(right);
    }
    nm.push_back(kLastContinuedNm);
    values.push_back(right);
  }
  return MeasuredSpectrum::from_samples(nm, values, table.ends());
}

/// True if a text is to be read as a file although no name is like it.
bool like_a_file(const std::string& text) {
  return text.find_first_of("./") != std::string::npos || is_file(text) ||
         is_file(parse_spectrum_path(text).file);
}

}  // namespace

SpectrumPath parse_spectrum_path(const std::string& text) {
  if (is_file(text)) return {text, {}};
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || !is_file(text.substr(0, colon))) return {text, {}};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

Result<SpectrumTable> load_spectrum_table(const std::string& path, const SpectrumFileOptions& options) {
  return load_chosen(path, {options.column, std::nullopt}, options);
}

Result<MeasuredSpectrum> load_spectrum_csv(const std::string& path) {
  SPECTILE_ASSIGN(const auto spectrum, load_spectrum(path));
  return std::get<PiecewiseLinearSpectrum>(spectrum.kind()).measured();
}

Result<Spectrum> load_spectrum(const std::string& path, std::optional<std::size_t> column) {
  SPECTILE_ASSIGN(const auto table, load_one(path, {{}, column}, {}));
  return table.spectra.front();
}

Result<std::vector<Spectrum>> load_spectra(const std::string& path) {
  SPECTILE_ASSIGN(auto table, load_spectrum_table(path));
  return std::move(table.spectra);
}

Result<LoadedSpectrum> find_loaded_spectrum(const std::string& name_or_path,
                                            const SpectrumFileOptions& options) {
  auto known = named_spectrum(name_or_path);
  if (known) return LoadedSpectrum{published_name(name_or_path), *std::move(known), {}};
  if (known.error().code != ErrorCode::kUnknownName || !like_a_file(name_or_path)) return known.error();
  SpectrumPath path = parse_spectrum_path(name_or_path);
  if (!options.column.empty()) path = {name_or_path, options.column};
  SPECTILE_ASSIGN(auto table, load_one(path.file, {path.column, std::nullopt}, options));
  std::string name = std::filesystem::path(path.file).filename().string();
  if (!path.column.empty()) name += ":" + path.column;
  return LoadedSpectrum{std::move(name), table.spectra.front(), std::move(table.notes)};
}

Result<Spectrum> find_spectrum(const std::string& name_or_path) {
  SPECTILE_ASSIGN(auto found, find_loaded_spectrum(name_or_path));
  return std::move(found.spectrum);
}

Result<NamedLight> find_light(const std::string& name_or_path, SpectrumFileOptions options) {
  options.use = SpectrumUse::kLight;
  const std::string kind = kind_of(name_or_path);
  if (kind == "refractive index" || kind == "absorption index" || kind == "reflectance") {
    return make_error(ErrorCode::kBadArgument,
                      "{} is a{} {}, not a light; spectile spectra lists the illuminants", name_or_path,
                      kind.front() == 'a' ? "n" : "", kind);
  }
  SPECTILE_ASSIGN(auto found, find_loaded_spectrum(name_or_path, options));
  const bool file = !named_spectrum(name_or_path);
  SPECTILE_ASSIGN(auto light, named_light(std::move(found.name), found.spectrum));
  light.notes = std::move(found.notes);
  if (!kind.empty() && kind != "illuminant") {
    light.notes.push_back(fmt::format("{} is a spectrum of kind {}; taken as a light", light.name, kind));
  }
  if (file && options.ends == Ends::kHeld) {
    SPECTILE_ASSIGN(light.spectrum, continued(light.spectrum.with_ends(Ends::kZero), Ends::kHeld));
  }
  SPECTILE_TRY(check_light(light));
  return light;
}

Result<SpectrumTable> find_reflectances(const std::string& name_or_path, SpectrumFileOptions options) {
  options.use = SpectrumUse::kReflectance;
  const std::string kind = kind_of(name_or_path);
  if (!kind.empty() && kind != "reflectance") {
    return make_error(ErrorCode::kBadArgument, "{} is a spectrum of kind {}, not a reflectance", name_or_path,
                      kind);
  }
  if (auto known = named_spectrum(name_or_path);
      known || known.error().code != ErrorCode::kUnknownName || !like_a_file(name_or_path)) {
    if (!known) return known.error();
    SpectrumTable out;
    out.names.push_back(published_name(name_or_path));
    out.spectra.push_back(*std::move(known));
    return out;
  }
  const SpectrumPath path = parse_spectrum_path(name_or_path);
  if (!path.column.empty()) options.column = path.column;
  SPECTILE_ASSIGN(auto out, load_spectrum_table(path.file, options));
  if (options.ends != Ends::kZero) return out;
  for (Spectrum& spectrum : out.spectra) {
    const auto& linear = std::get<PiecewiseLinearSpectrum>(spectrum.kind());
    SPECTILE_ASSIGN(auto whole, continued(linear.measured(), Ends::kZero));
    spectrum = PiecewiseLinearSpectrum(std::move(whole), Ends::kZero);
  }
  return out;
}

}  // namespace spectile
