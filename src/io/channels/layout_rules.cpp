// Rules of the spectral layout that a part's header can break.
#include "src/io/channels/layout_rules.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "src/base/errors.hpp"
#include "src/io/channels/spectral_layout.hpp"

namespace spectile::io {
namespace {

constexpr const char* kUsualUnits = "W.m^-2.sr^-1";
// Names have six decimals.
constexpr double kSameNm = 1e-6;

/// True for names that begin as the layout's do: "T.5...", "S0.5...".
bool begins_like_layout(std::string_view name) {
  const std::size_t point = name.find('.');
  if (point == std::string_view::npos || point + 1 == name.size()) return false;
  const std::string_view kind = name.substr(0, point);
  const char next = name[point + 1];
  const bool number = (next >= '0' && next <= '9') || next == ',';
  return number && (kind == "T" || (kind.size() == 2 && kind[0] == 'S' && kind[1] >= '0' && kind[1] <= '9'));
}

bool is_spectral(const StoredChannel& stored, const PartHeader& header) {
  return parse_spectral_channel(stored.name, header) || begins_like_layout(stored.name);
}

/// Wavelengths in ascending order, each within rounding of the other list's.
bool same_wavelengths(std::vector<double> a, std::vector<double> b) {
  std::ranges::sort(a);
  std::ranges::sort(b);
  return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) <= kSameNm; });
}

bool holds(const std::vector<double>& list, double nm) {
  return std::ranges::any_of(list, [nm](double other) { return std::abs(other - nm) <= kSameNm; });
}

/// "a", or "a and N more".
std::string shortened(const std::vector<std::string>& names) {
  std::string out = fmt::format("\"{}\"", names.front());
  if (names.size() > 1) out += fmt::format(" and {} more", names.size() - 1);
  return out;
}

/// The checks of one part.
class Checker {
 public:
  explicit Checker(const PartHeader& header) : header_(header) {}

  std::vector<LayoutFinding> run() {
    check_channels();
    if (!spectral_) return {};
    if (header_.deep()) breaks("deep", "spectral channels are in a deep part");
    check_version();
    check_duplicates();
    check_stokes();
    check_units();
    check_reradiation();
    check_sidecars();
    check_recommended();
    return std::move(findings_);
  }

 private:
  void breaks(const char* rule, std::string detail) { findings_.push_back({rule, std::move(detail), false}); }
  void remark(const char* rule, std::string detail) { findings_.push_back({rule, std::move(detail), true}); }

  void check_channels() {
    std::vector<std::string> malformed;
    std::vector<std::string> layered;
    std::vector<std::string> foreign;
    std::vector<std::string> subsampled;
    for (const StoredChannel& stored : header_.channels()) {
      if (!is_spectral(stored, header_)) continue;
      spectral_ = true;
      if (stored.subsampled()) subsampled.push_back(stored.name);
      const auto channel = parse_spectral_channel(stored.name, header_);
      if (!channel) {
        malformed.push_back(stored.name);
      } else if (!channel->dialect->says_quantity) {
        foreign.push_back(stored.name);
      } else {
        const std::size_t start = channel->prefix.empty() ? 0 : channel->prefix.size() + 1;
        if (start > 0) layered.push_back(stored.name);
        if (!is_strict_layout_name(std::string_view(stored.name).substr(start)))
          malformed.push_back(stored.name);
        sort_in(stored.name, *channel);
      }
    }
    const auto report = [&](const char* rule, const std::vector<std::string>& names, const char* what) {
      if (!names.empty()) breaks(rule, fmt::format("{}: {}", what, shortened(names)));
    };
    report("channel-name", malformed,
           "not S0, S1, S2, S3 or T, a point, a number with a decimal comma, m or Hz");
    report("dialect", foreign, "channels named in another way than the layout's");
    report("layer", layered, "a layer or view before the names of spectral channels");
    report("subsampled", subsampled, "spectral channels that are subsampled");
  }

  void sort_in(const std::string& name, const SpectralChannel& channel) {
    if (channel.kind == SpectralKind::kReradiating) {
      pairs_.emplace_back(channel.from_nm, channel.wavelength_nm);
      return;
    }
    Component& to =
        components_[{channel.prefix, channel.kind == SpectralKind::kReflective ? -1 : channel.stokes}];
    to.wavelengths.push_back(channel.wavelength_nm);
    to.names.push_back(name);
  }

  void check_version() {
    const auto version = header_.text("spectralLayoutVersion");
    if (!version) return breaks("version", "no attribute spectralLayoutVersion of type string");
    if (*version != "1.0")
      breaks("version", fmt::format("spectralLayoutVersion is \"{}\", not \"1.0\"", *version));
  }

  void check_duplicates() {
    for (const auto& entry : components_) {
      const Component& component = entry.second;
      std::vector<std::size_t> order(component.names.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::ranges::stable_sort(order, {}, [&](std::size_t i) { return component.wavelengths[i]; });
      for (std::size_t i = 1; i < order.size(); ++i) {
        const std::size_t a = order[i - 1];
        const std::size_t b = order[i];
        if (component.wavelengths[b] - component.wavelengths[a] > kSameNm) continue;
        breaks("duplicate", fmt::format("\"{}\" and \"{}\" are of one wavelength", component.names[a],
                                        component.names[b]));
      }
    }
  }

  /// Wavelengths of a component of plain channels; -1 for T.
  std::vector<double> plain(int component) const {
    const auto found = components_.find({"", component});
    return found == components_.end() ? std::vector<double>() : found->second.wavelengths;
  }

  void check_stokes() {
    bool polarised = false;
    for (const auto& [key, component] : components_) {
      const auto& [prefix, stokes] = key;
      if (stokes < 1) continue;
      polarised = true;
      const auto base = components_.find({prefix, 0});
      if (base == components_.end()) {
        breaks("stokes", fmt::format("S{} without S0", stokes));
      } else if (!same_wavelengths(component.wavelengths, base->second.wavelengths)) {
        breaks("stokes", fmt::format("the wavelengths of S{} are not those of S0", stokes));
      }
    }
    if (polarised) check_handedness();
  }

  void check_handedness() {
    const auto stated = header_.text("polarisationHandedness");
    if (!stated) return breaks("handedness", "polarised light without an attribute polarisationHandedness");
    if (*stated == "left" || *stated == "right") return;
    breaks("handedness", fmt::format("polarisationHandedness is \"{}\", not \"left\" or \"right\"", *stated));
  }

  void check_units() {
    const bool light = std::ranges::any_of(components_, [](const auto& c) { return c.first.second >= 0; });
    if (!light) return;
    const auto units = header_.text("emissiveUnits");
    if (!units) return breaks("units", "emission without an attribute emissiveUnits");
    if (*units != kUsualUnits) {
      remark("units",
             fmt::format("emissiveUnits is \"{}\"; readers may take it for {}", *units, kUsualUnits));
    }
  }

  void check_reradiation() {
    const std::vector<double> diagonal = plain(-1);
    std::set<std::pair<double, double>> seen;
    for (const auto& [from, to] : pairs_) {
      const std::string name = reradiation_channel_name(from, to);
      if (!seen.insert({from, to}).second) breaks("duplicate", fmt::format("\"{}\" is there twice", name));
      if (!holds(diagonal, from) || !holds(diagonal, to)) {
        breaks("reradiation", fmt::format("\"{}\" needs a channel T of both of its wavelengths", name));
      }
      if (to < from + kSameNm) {
        breaks("reradiation",
               fmt::format("\"{}\" does not emit at a longer wavelength than it absorbs", name));
      }
    }
    const std::size_t n = diagonal.size();
    if (!pairs_.empty() && seen.size() < n * (n - 1) / 2) {
      remark("reradiation", fmt::format("{} of {} pairs of wavelengths; readers may want all", seen.size(),
                                        n * (n - 1) / 2));
    }
  }

  void check_curve(const std::string& name) {
    if (!header_.has_attribute(name)) return;
    const auto text = header_.text(name);
    if (text && is_curve_text(*text)) return;
    breaks("curve", fmt::format("attribute {} is no list such as \"400nm:0.5;410nm:0.75;\"", name));
  }

  void check_sidecars() {
    check_curve("lensTransmission");
    check_curve("cameraResponse");
    for (const StoredChannel& stored : header_.channels()) {
      if (is_spectral(stored, header_)) check_curve(stored.name);
    }
    const std::string type = header_.attribute_type("EV");
    if (!type.empty() && type != "float")
      breaks("exposure", fmt::format("attribute EV is {}, not float", type));
  }

  void check_recommended() {
    if (header_.find("R") == nullptr || header_.find("G") == nullptr || header_.find("B") == nullptr) {
      remark("preview", "no channels R, G, B, which other programs would show");
    }
    const std::vector<double> reflective = plain(-1);
    const std::vector<double> emissive = plain(0);
    if (!reflective.empty() && !emissive.empty() && !same_wavelengths(reflective, emissive)) {
      remark("wavelengths", "those of T are not those of S0; readers may want the same");
    }
  }

  /// Channels of one prefix and component.
  struct Component {
    std::vector<double> wavelengths;
    std::vector<std::string> names;
  };
  const PartHeader& header_;
  bool spectral_ = false;
  std::map<std::pair<std::string, int>, Component> components_;  // -1 for T
  std::vector<std::pair<double, double>> pairs_;
  std::vector<LayoutFinding> findings_;
};

/// A number with a decimal point at the start of `text`, which it is taken from.
bool take_decimal(std::string_view& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

/// A wavelength or frequency up to the colon, which is taken too.
bool take_abscissa(std::string_view& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return false;
  // As a channel is named, but for its decimal point.
  std::string name = "T." + std::string(text.substr(0, colon));
  if (name.find(',') != std::string::npos) return false;
  const std::size_t point = name.find('.', 2);
  if (point != std::string::npos) name[point] = ',';
  text.remove_prefix(colon + 1);
  return name.find('.', 2) == std::string::npos && is_strict_layout_name(name);
}

}  // namespace

std::vector<LayoutFinding> layout_findings(const PartHeader& header) {
  return Checker(header).run();
}

bool has_spectral_names(const PartHeader& header) {
  return std::ranges::any_of(header.channels(), [&](const auto& c) { return is_spectral(c, header); });
}

bool is_curve_text(std::string_view text) {
  if (text.empty()) return false;
  while (!text.empty()) {
    if (!take_abscissa(text) || !take_decimal(text) || !text.starts_with(';')) return false;
    text.remove_prefix(1);
  }
  return true;
}

}  // namespace spectile::io
