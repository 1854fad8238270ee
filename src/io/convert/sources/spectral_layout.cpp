// Names of spectral channels: written as the layout says, read liberally.
#include "src/io/convert/sources/spectral_layout.hpp"

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

}  // namespace

std::string spectral_channel_name(SpectralKind kind, double wavelength_nm) {
  std::string name =
      fmt::format("{}.{:.6f}nm", kind == SpectralKind::kReflective ? "T" : "S0", wavelength_nm);
  const std::size_t point = name.rfind('.');
  name[point] = ',';
  return name;
}

std::optional<SpectralChannel> parse_spectral_channel(std::string_view name) {
  SpectralChannel channel;
  if (take(name, "T.")) {
    channel.kind = SpectralKind::kReflective;
  } else if (take(name, "S0.")) {
    channel.kind = SpectralKind::kEmissive;
  } else if (take(name, "S1.") || take(name, "S2.") || take(name, "S3.")) {
    channel.kind = SpectralKind::kPolarised;
  } else {
    return std::nullopt;
  }
  std::string number(name);
  std::replace(number.begin(), number.end(), ',', '.');
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc{} || !(value > 0) || !std::isfinite(value)) return std::nullopt;
  const std::string_view unit = name.substr(static_cast<std::size_t>(end - number.data()));
  for (const auto& prefix : kPrefixes) {
    if (!unit.starts_with(prefix.symbol)) continue;
    const std::string_view base = unit.substr(prefix.symbol.size());
    if (base == "m") {
      // Nanometres, the layout's own unit, are taken as they are: no factor may round them.
      channel.wavelength_nm = prefix.symbol == "n" ? value : value * (prefix.factor * 1e9);
    } else if (base == "Hz") {
      channel.wavelength_nm = kSpeedOfLight / (value * prefix.factor) * 1e9;
    } else {
      continue;
    }
    // Units can take a number out of the range of double.
    if (!(channel.wavelength_nm > 0) || !std::isfinite(channel.wavelength_nm)) return std::nullopt;
    return channel;
  }
  return std::nullopt;
}

}  // namespace spectile::io
