// Names of spectral channels: written as the layout says, read in every dialect that programs write.
#include "src/io/channels/spectral_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace spectile::io {
namespace {

// The SI prefixes of the layout's grammar.
constexpr struct {
  std::string_view symbol;
  double factor;
} kPrefixes[] = {{"Y", 1e24}, {"Z", 1e21}, {"E", 1e18}, {"P", 1e15}, {"T", 1e12}, {"G", 1e9},
                 {"M", 1e6},  {"k", 1e3},  {"h", 1e2},  {"da", 1e1}, {"", 1.0},   {"d", 1e-1},
                 {"c", 1e-2}, {"m", 1e-3}, {"u", 1e-6}, {"n", 1e-9}, {"p", 1e-12}};

// Metres a second; exact by the definition of the metre.
constexpr double kSpeedOfLight = 299792458.0;

bool take(std::string_view& text, std::string_view start) {
  if (!text.starts_with(start)) return false;
  text.remove_prefix(start.size());
  return true;
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// A number above 0 at the start of `text`, which it is taken from; `point` may stand for its decimal point.
std::optional<double> take_number(std::string_view& text, char point) {
  std::string number(text);
  std::replace(number.begin(), number.end(), point, '.');
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc{} || !(value > 0) || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - number.data()));
  return value;
}

/// A number with any SI prefix, in metres or hertz, at the start of `text`, in nm.
std::optional<double> take_wavelength(std::string_view& text) {
  const auto value = take_number(text, ',');
  if (!value) return std::nullopt;
  const auto letters =
      static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_letter) - text.begin());
  const std::string_view unit = text.substr(0, letters);
  text.remove_prefix(letters);
  for (const auto& prefix : kPrefixes) {
    if (!unit.starts_with(prefix.symbol)) continue;
    const std::string_view base = unit.substr(prefix.symbol.size());
    double nm = 0;
    if (base == "m") {
      // Nanometres, the layout's own unit, are taken as they are: no factor may round them.
      nm = prefix.symbol == "n" ? *value : *value * (prefix.factor * 1e9);
    } else if (base == "Hz") {
      nm = kSpeedOfLight / (*value * prefix.factor) * 1e9;
    } else {
      continue;
    }
    // Units can take a number out of the range of double.
    return nm > 0 && std::isfinite(nm) ? std::optional(nm) : std::nullopt;
  }
  return std::nullopt;
}

std::optional<SpectralChannel> parse_layout(std::string_view name, const PartHeader& /*header*/) {
  SpectralChannel channel;
  const int component =
      name.size() > 2 && name[0] == 'S' && name[1] >= '1' && name[1] <= '3' ? name[1] - '0' : 0;
  if (take(name, "T.")) {
    channel.kind = SpectralKind::kReflective;
  } else if (take(name, "S0.")) {
    channel.kind = SpectralKind::kEmissive;
  } else if (component > 0 && name[2] == '.') {
    name.remove_prefix(3);
    channel.kind = SpectralKind::kPolarised;
    channel.stokes = component;
  } else {
    return std::nullopt;
  }
  const auto first = take_wavelength(name);
  if (!first) return std::nullopt;
  channel.wavelength_nm = *first;
  if (name.empty()) return channel;
  if (channel.kind != SpectralKind::kReflective || !take(name, ".")) return std::nullopt;
  const auto second = take_wavelength(name);
  if (!second || !name.empty()) return std::nullopt;
  channel.kind = SpectralKind::kReradiating;
  channel.from_nm = *first;
  channel.wavelength_nm = *second;
  return channel;
}

/// A number with six decimals, as the layout writes it.
std::string wavelength_text(double nm) {
  std::string out = fmt::format("{:.6f}nm", nm);
  out[out.find('.')] = ',';
  return out;
}

WrittenChannel write_layout(const Band& band, std::size_t /*number*/, SpectralKind kind) {
  const std::string name = spectral_channel_name(kind, band.centre_nm);
  return {name, parse_layout(name, {}).value_or(SpectralChannel())};
}

/// A number of `least` to 6 decimals, no more than it has.
std::string decimals(double value, std::size_t least) {
  std::string out = fmt::format("{:.6f}", value);
  const std::size_t kept = out.find('.') + 1 + least;
  while (out.size() > kept && out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  return out;
}

/// As spectral OpenEXR files of Mitsuba 0.6 name their channels.
std::optional<SpectralChannel> parse_range(std::string_view name, const PartHeader& /*header*/) {
  SpectralChannel channel;
  channel.kind = SpectralKind::kEmissive;
  const auto lower = take_number(name, ',');
  if (!lower || !take(name, "-")) return std::nullopt;
  const auto upper = take_number(name, ',');
  if (!upper || name != "nm" || !(*lower < *upper)) return std::nullopt;
  channel.lower_nm = *lower;
  channel.upper_nm = *upper;
  channel.wavelength_nm = (*lower + *upper) / 2;
  return channel;
}

/// With the two decimals that Mitsuba writes, or more where edges have more.
WrittenChannel write_range(const Band& band, std::size_t /*number*/, SpectralKind /*kind*/) {
  const std::string name = fmt::format("{}-{}nm", decimals(band.lower_nm, 2), decimals(band.upper_nm, 2));
  return {name, parse_range(name, {}).value_or(SpectralChannel())};
}

/// As spectral OpenEXR files of Indigo name their channels.
std::optional<SpectralChannel> parse_indigo(std::string_view name, const PartHeader& /*header*/) {
  SpectralChannel channel;
  channel.kind = SpectralKind::kEmissive;
  channel.lower_edge = true;
  if (!take(name, "wavelength")) return std::nullopt;
  const auto value = take_number(name, '_');
  if (!value || !name.empty()) return std::nullopt;
  channel.wavelength_nm = *value;
  return channel;
}

WrittenChannel write_indigo(const Band& band, std::size_t /*number*/, SpectralKind /*kind*/) {
  std::string name = "wavelength" + decimals(band.lower_nm, 0);
  std::replace(name.begin(), name.end(), '.', '_');
  return {name, parse_indigo(name, {}).value_or(SpectralChannel())};
}

SpectralChannel ocean_channel(double metres) {
  SpectralChannel channel;
  channel.kind = SpectralKind::kEmissive;
  // Metres as doubles are nanometres but for their last digits.
  channel.wavelength_nm = std::round(metres * 1e15) / 1e6;
  return channel;
}

/// As Ocean's spectral OpenEXR files have it: the wavelength in metres is an attribute named after the
/// channel.
std::optional<SpectralChannel> parse_ocean(std::string_view name, const PartHeader& header) {
  // Its documents allow any name.
  if (name.find('.') != std::string_view::npos) return std::nullopt;
  const auto metres = header.number(std::string(name) + ".wavelength");
  if (!metres) return std::nullopt;
  const SpectralChannel channel = ocean_channel(*metres);
  if (!(channel.wavelength_nm > 0) || !std::isfinite(channel.wavelength_nm)) return std::nullopt;
  return channel;
}

WrittenChannel write_ocean(const Band& band, std::size_t number, SpectralKind /*kind*/) {
  const double metres = band.centre_nm * 1e-9;
  return {fmt::format("wl{}", number), ocean_channel(metres), metres};
}

constexpr Dialect kDialects[] = {
    {"layout", "spectral layout", "T.500,000000nm, S0.500,000000nm", "centre", true, parse_layout,
     write_layout},
    {"mitsuba06", "Mitsuba 0.6", "360.00-375.67nm", "lower and upper edge", false, parse_range, write_range},
    {"indigo", "Indigo", "wavelength430_25", "lower edge", false, parse_indigo, write_indigo},
    {"ocean", "Ocean", "wl0 and an attribute wl0.wavelength", "centre, in metres", false, parse_ocean,
     write_ocean},
};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

void skip_digits(std::string_view& text) {
  while (!text.empty() && is_digit(text.front())) text.remove_prefix(1);
}

/// A number and a unit of the layout's grammar at the start of `text`, which they are taken from:
/// digits, a comma and more digits, a power of ten, an SI prefix, m or Hz.
bool take_strict_wavelength(std::string_view& text) {
  const std::string_view number = text;
  skip_digits(text);
  if (take(text, ",")) skip_digits(text);
  const std::string_view mantissa = number.substr(0, number.size() - text.size());
  if (std::none_of(mantissa.begin(), mantissa.end(), is_digit)) return false;
  if (text.starts_with('e') || text.starts_with('E')) {
    std::string_view power = text.substr(1);
    if (power.starts_with('+') || power.starts_with('-')) power.remove_prefix(1);
    const std::size_t before = power.size();
    skip_digits(power);
    // E stands for exa too.
    if (power.size() < before) text = power;
  }
  for (const auto& prefix : kPrefixes) {
    std::string_view unit = text;
    if (!take(unit, prefix.symbol) || !(take(unit, "m") || take(unit, "Hz"))) continue;
    if (!unit.empty() && unit.front() != '.') continue;
    text = unit;
    return true;
  }
  return false;
}

}  // namespace

std::span<const Dialect> dialects() {
  return kDialects;
}

const Dialect* find_dialect(std::string_view key) {
  for (const Dialect& dialect : kDialects) {
    if (dialect.key == key) return &dialect;
  }
  return nullptr;
}

std::string spectral_channel_name(SpectralKind kind, double wavelength_nm) {
  return (kind == SpectralKind::kReflective ? "T." : "S0.") + wavelength_text(wavelength_nm);
}

std::string stokes_channel_name(int component, double wavelength_nm) {
  return fmt::format("S{}.{}", component, wavelength_text(wavelength_nm));
}

std::string reradiation_channel_name(double from_nm, double to_nm) {
  return fmt::format("T.{}.{}", wavelength_text(from_nm), wavelength_text(to_nm));
}

bool is_strict_layout_name(std::string_view name) {
  const bool reflective = take(name, "T.");
  if (!reflective && !(take(name, "S0.") || take(name, "S1.") || take(name, "S2.") || take(name, "S3."))) {
    return false;
  }
  if (!take_strict_wavelength(name)) return false;
  if (name.empty()) return true;
  return reflective && take(name, ".") && take_strict_wavelength(name) && name.empty();
}

std::optional<SpectralChannel> parse_spectral_channel(std::string_view name, const PartHeader& header) {
  // Numbers hold points too: the first of them after which a name of a dialect follows ends the prefix.
  for (std::size_t start = 0; start < name.size();) {
    for (const Dialect& dialect : kDialects) {
      auto channel = dialect.parse(name.substr(start), header);
      if (!channel) continue;
      channel->prefix = name.substr(0, start == 0 ? 0 : start - 1);
      channel->dialect = &dialect;
      return channel;
    }
    const std::size_t point = name.find('.', start);
    if (point == std::string_view::npos) break;
    start = point + 1;
  }
  return std::nullopt;
}

}  // namespace spectile::io
