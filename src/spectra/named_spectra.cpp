// Spectra by name: the published tables, and formulas with a number in their name.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>
#include <optional>
#include <spectile/spectra/named_spectra.hpp>

#include "src/base/errors.hpp"
#include "src/base/text.hpp"
#include "src/data/tables.hpp"

namespace spectile {
namespace {

/// A table of any of the files in src/data; wavelengths are first_nm + i * step_nm where there are none.
struct Entry {
  NamedSpectrumInfo info;
  std::span<const double> wavelengths_nm;
  double first_nm = 0;
  double step_nm = 0;
  std::span<const double> values;
};

/// Of a table with even steps.
Entry even(NamedSpectrumInfo info, double first_nm, double step_nm, std::span<const double> values) {
  return {std::move(info), {}, first_nm, step_nm, values};
}

struct Description {
  const char* name;
  const char* about;
};

// Descriptions after CIE 015:2018.
constexpr Description kIlluminants[] = {{"A", "incandescent lamp, Planckian, 2856 K"},
                                        {"C", "average daylight of 1931, 6774 K"},
                                        {"D50", "daylight, 5003 K"},
                                        {"D55", "daylight, 5503 K"},
                                        {"D60", "daylight, 6003 K"},
                                        {"D65", "daylight, 6504 K"},
                                        {"D75", "daylight, 7504 K"},
                                        {"E", "equal energy"},
                                        {"FL1", "fluorescent lamp, standard, 6430 K"},
                                        {"FL2", "fluorescent lamp, standard, 4230 K"},
                                        {"FL3", "fluorescent lamp, standard, 3450 K"},
                                        {"FL4", "fluorescent lamp, standard, 2940 K"},
                                        {"FL5", "fluorescent lamp, standard, 6350 K"},
                                        {"FL6", "fluorescent lamp, standard, 4150 K"},
                                        {"FL7", "fluorescent lamp, broad-band, 6500 K"},
                                        {"FL8", "fluorescent lamp, broad-band, 5000 K"},
                                        {"FL9", "fluorescent lamp, broad-band, 4150 K"},
                                        {"FL10", "fluorescent lamp, three-band, 5000 K"},
                                        {"FL11", "fluorescent lamp, three-band, 4000 K"},
                                        {"FL12", "fluorescent lamp, three-band, 3000 K"},
                                        {"HP1", "high-pressure sodium lamp, 1959 K"},
                                        {"LED-B1", "blue LED with phosphor, 2733 K"},
                                        {"LED-B3", "blue LED with phosphor, 4103 K"},
                                        {"LED-RGB1", "red, green and blue LEDs, 2840 K"}};

constexpr const char* kCie = "CIE 015:2018";
constexpr const char* kPbrt = "Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, 2023";

/// "neutral 6.5 (.44 D)" to "neutral-6.5".
std::string patch_name(std::string_view patch) {
  std::string name(patch.substr(0, patch.find(" (")));
  std::ranges::replace(name, ' ', '-');
  return name;
}

void add_optical_constants(std::vector<Entry>& out, bool absorption) {
  for (const data::OpticalConstants& m : data::optical_constants()) {
    if (absorption && m.k.empty()) continue;
    const char* const suffix = absorption ? "-k" : "-eta";
    const std::string symbol = m.symbol;
    const std::string material = m.material;
    // The glasses have none: there are many of each kind.
    const std::string alias = m.k.empty() ? "" : material + suffix;
    const char* const kind = absorption ? "absorption index" : "refractive index";
    out.push_back(
        {{symbol + suffix, kind, material, kPbrt, alias}, m.wavelengths_nm, 0, 0, absorption ? m.k : m.eta});
  }
}

void add_observer(std::vector<Entry>& out, const data::MatchingFunctions& f, const char* name,
                  const char* about) {
  const std::array bars = {f.x_bar, f.y_bar, f.z_bar};
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const char letter = static_cast<char>('x' + i);
    out.push_back(even({fmt::format("{}-{}", name, letter), "observer",
                        fmt::format("colour matching function {} of the {}", letter, about), kCie, ""},
                       f.first_nm, f.step_nm, bars[i]));
  }
}

std::vector<Entry> make_entries() {
  std::vector<Entry> out;
  for (const data::NamedTable& t : data::illuminants()) {
    const auto* const d = std::ranges::find_if(
        kIlluminants, [&](const Description& known) { return std::string_view(known.name) == t.name; });
    const char* const about = d == std::end(kIlluminants) ? "CIE illuminant" : d->about;
    out.push_back(even({t.name, "illuminant", about, kCie, ""}, t.first_nm, t.step_nm, t.values));
  }
  add_optical_constants(out, false);
  add_optical_constants(out, true);
  for (const data::NamedTable& t : data::canon_eos_5d_mkii()) {
    const char* const color = *t.name == 'r' ? "red" : *t.name == 'g' ? "green" : "blue";
    out.push_back(even({fmt::format("canon-eos-5d-mkii-{}", t.name), "camera response",
                        fmt::format("Canon EOS 5D Mark II, {}", color), kPbrt, ""},
                       t.first_nm, t.step_nm, t.values));
  }
  add_observer(out, data::kCie1931, "cie1931", "2 degree observer");
  add_observer(out, data::kCie1964, "cie1964", "10 degree observer");
  int number = 1;
  for (const data::NamedTable& t : data::colorchecker()) {
    out.push_back(even({"colorchecker-" + patch_name(t.name), "reflectance",
                        fmt::format("ColorChecker, patch {}, {}", number++, t.name), "BabelColor", ""},
                       t.first_nm, t.step_nm, t.values));
  }
  return out;
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = make_entries();
  return all;
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

template <class Kind>
Result<Spectrum> widened(Result<Kind> result) {
  if (!result) return result.error();
  return Spectrum(*std::move(result));
}

Result<Spectrum> named_table(const Entry& e) {
  if (e.step_nm == 1) {
    return widened(DenselySampledSpectrum::from_values(static_cast<int>(e.first_nm),
                                                       {e.values.begin(), e.values.end()}));
  }
  std::vector<double> wavelengths(e.wavelengths_nm.begin(), e.wavelengths_nm.end());
  for (std::size_t i = wavelengths.size(); i < e.values.size(); ++i) {
    wavelengths.push_back(e.first_nm + static_cast<double>(i) * e.step_nm);
  }
  const Ends ends = e.info.kind == "reflectance" ? Ends::kHeld : Ends::kZero;
  return widened(PiecewiseLinearSpectrum::from_samples(wavelengths, e.values, ends));
}

/// How many letters must be put in, taken out or exchanged to make `b` of `a`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t kept = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({kept, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

/// The longest name takes part in comparisons; longer texts are near none, and are not quoted whole.
constexpr std::size_t kLongestName = 64;
constexpr std::size_t kMaxNear = 5;

/// Names that were perhaps meant, the nearest first, at most kMaxNear.
std::vector<std::string> names_near(std::string_view text) {
  if (text.empty() || text.size() > kLongestName) return {};
  const std::string wanted = lower(text);
  std::vector<std::pair<std::size_t, std::string>> near;
  const auto consider = [&](const std::string& name) {
    const std::string known = lower(name);
    const std::size_t distance = edit_distance(wanted, known);
    // One slip in three letters; in two letters anything would be near.
    const bool slip = distance <= std::min<std::size_t>(2, wanted.size() / 3);
    const bool begun = wanted.size() >= 2 && known.starts_with(wanted);
    if (slip || begun) near.emplace_back(distance, name);
  };
  for (const Entry& e : entries()) {
    consider(e.info.name);
    if (!e.info.alias.empty()) consider(e.info.alias);
  }
  for (const char* formula : {"blackbody:3200", "daylight:5003", "constant:0.5"}) {
    const std::string_view known(formula);
    const std::string word = lower(text.substr(0, text.find(':')));
    const std::string_view stem = known.substr(0, known.find(':'));
    if (stem.starts_with(word) ? word.size() >= 2 : edit_distance(word, stem) <= 2) {
      near.emplace_back(edit_distance(word, stem), formula);
    }
  }
  std::ranges::stable_sort(near, {}, &std::pair<std::size_t, std::string>::first);
  std::vector<std::string> out;
  for (std::size_t i = 0; i < std::min(near.size(), kMaxNear); ++i) out.push_back(near[i].second);
  if (near.size() > kMaxNear) out.push_back(fmt::format("and {} more", near.size() - kMaxNear));
  return out;
}

Error unknown(std::string_view text) {
  const std::string shown =
      fmt::format("{}{}", text.substr(0, kLongestName), text.size() > kLongestName ? "..." : "");
  if (const auto near = names_near(text); !near.empty()) {
    return make_error(ErrorCode::kUnknownName, "spectrum \"{}\" is unknown; near it: {}", shown,
                      fmt::join(near, ", "));
  }
  std::vector<std::string> kinds;
  std::string last;
  for (const Entry& e : entries()) {
    if (e.info.kind == last) continue;
    last = e.info.kind;
    kinds.push_back(fmt::format("{} ({})", last, e.info.name));
  }
  return make_error(ErrorCode::kUnknownName,
                    "spectrum \"{}\" is unknown; there are names by kind, for example {}; and "
                    "blackbody:KELVIN, daylight:KELVIN, constant:VALUE",
                    shown, fmt::join(kinds, ", "));
}

/// "blackbody:3200" and the like; nothing for other texts.
std::optional<Result<Spectrum>> formula(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const std::string word = lower(text.substr(0, colon));
  if (word != "blackbody" && word != "daylight" && word != "constant") return std::nullopt;
  const std::string_view number = text.substr(colon + 1);
  const auto value = parse_number<double>(number);
  if (!value || !std::isfinite(*value)) {
    return make_error(ErrorCode::kBadArgument, "{}: \"{}\" is not a finite number{}", word,
                      number.substr(0, kLongestName), word == "constant" ? "" : " of kelvin");
  }
  if (word == "constant") return Spectrum(ConstantSpectrum(*value));
  if (word == "daylight") return widened(daylight_spectrum(*value));
  return widened(BlackbodySpectrum::create(*value, BlackbodySpectrum::Scale::kNormalized));
}

}  // namespace

const std::vector<NamedSpectrumInfo>& named_spectra() {
  static const std::vector<NamedSpectrumInfo> infos = [] {
    std::vector<NamedSpectrumInfo> out;
    for (const Entry& e : entries()) out.push_back(e.info);
    return out;
  }();
  return infos;
}

Result<Spectrum> named_spectrum(std::string_view name) {
  if (auto made = formula(name)) return *std::move(made);
  const std::string wanted = lower(name);
  for (const Entry& e : entries()) {
    if (wanted == lower(e.info.name) || (!e.info.alias.empty() && wanted == lower(e.info.alias)))
      return named_table(e);
  }
  return unknown(name);
}

}  // namespace spectile
