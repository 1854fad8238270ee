// The meaning of two images' samples, which must be the same for an average.
#include "src/io/average/same_meaning.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/errors.hpp"
#include "src/io/convert/sources/color_space.hpp"

namespace spectile::io {
namespace {

/// Texts that must be the same, and what they are where they are missing.
constexpr struct {
  const char* name;
  const char* usual;
} kTexts[] = {{"emissiveUnits", "W.m^-2.sr^-1"},
              {"polarisationHandedness", ""},
              {"lensTransmission", ""},
              {"cameraResponse", ""}};

std::string shown(const std::string& text) {
  constexpr std::size_t kMost = 40;
  if (text.empty()) return "none";
  return '"' + (text.size() > kMost ? text.substr(0, kMost) + "..." : text) + '"';
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

/// OpenImageIO's name of the colour space; empty for its names of what files without one are taken for.
std::string named_space(const PartHeader& header) {
  const std::string name = lower(header.text("oiio:ColorSpace").value_or(""));
  const bool usual = name == "linear" || name == "scene_linear" || name == "lin_srgb" || name == "lin_rec709";
  return usual ? "" : name;
}

std::string primaries_text(const RgbSpace& space) {
  const Chromaticities& c = space.chromaticities;
  return fmt::format("red {:.4g},{:.4g} green {:.4g},{:.4g} blue {:.4g},{:.4g} white {:.4g},{:.4g}", c.red[0],
                     c.red[1], c.green[0], c.green[1], c.blue[0], c.blue[1], c.white[0], c.white[1]);
}

bool same_primaries(const RgbSpace& a, const RgbSpace& b) {
  const auto close = [](const std::array<double, 2>& p, const std::array<double, 2>& q) {
    return std::abs(p[0] - q[0]) < 1e-4 && std::abs(p[1] - q[1]) < 1e-4;
  };
  const Chromaticities& p = a.chromaticities;
  const Chromaticities& q = b.chromaticities;
  return close(p.red, q.red) && close(p.green, q.green) && close(p.blue, q.blue) && close(p.white, q.white);
}

std::optional<std::string> color_difference(const PartHeader& other, const PartHeader& first,
                                            const std::string& first_path) {
  const auto a = color_space_of(other, "");
  const auto b = color_space_of(first, first_path);
  if (a && b) {
    if (!same_primaries(*a, *b)) {
      return fmt::format("its colour space is {} ({}), but that of {} is {} ({})", a->description,
                         primaries_text(*a), first_path, b->description, primaries_text(*b));
    }
  } else {
    // Names that are not known here can be compared all the same.
    const std::string here = other.text("colorInteropID").value_or("");
    const std::string there = first.text("colorInteropID").value_or("");
    if (here != there) {
      return fmt::format("its colorInteropID is {}, but that of {} is {}", shown(here), first_path,
                         shown(there));
    }
  }
  if (named_space(other) != named_space(first)) {
    return fmt::format("its oiio:ColorSpace is {}, but that of {} is {}",
                       shown(other.text("oiio:ColorSpace").value_or("")), first_path,
                       shown(first.text("oiio:ColorSpace").value_or("")));
  }
  return {};
}

}  // namespace

std::optional<std::string> difference_of_meaning(const PartHeader& other, const PartHeader& first,
                                                 const std::string& first_path) {
  if (auto found = color_difference(other, first, first_path)) return found;
  const double ev = other.number("EV").value_or(0);
  const double first_ev = first.number("EV").value_or(0);
  if (ev != first_ev) {
    return fmt::format("its exposure value (EV) is {}, but that of {} is {}", ev, first_path, first_ev);
  }
  const auto white = other.number("whiteLuminance");
  const auto first_white = first.number("whiteLuminance");
  if (white && first_white && *white != *first_white) {
    return fmt::format("its whiteLuminance is {}, but that of {} is {}", *white, first_path, *first_white);
  }
  const auto text_difference = [&](const std::string& name,
                                   const std::string& usual) -> std::optional<std::string> {
    const std::string here = other.text(name).value_or(usual);
    const std::string there = first.text(name).value_or(usual);
    if (here == there) return {};
    return fmt::format("its {} is {}, but that of {} is {}", name, shown(here), first_path, shown(there));
  };
  for (const auto& text : kTexts) {
    if (auto found = text_difference(text.name, text.usual)) return found;
  }
  // The curve of a channel's filter has the channel's name.
  for (const StoredChannel& channel : first.channels()) {
    if (auto found = text_difference(channel.name, "")) return found;
  }
  return {};
}

}  // namespace spectile::io
