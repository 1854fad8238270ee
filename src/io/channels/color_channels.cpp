// The channels of a file that hold a colour, and the choice among them.
#include "src/io/channels/color_channels.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "src/base/errors.hpp"
#include "src/io/channels/spectral_sets.hpp"

namespace spectile::io {
namespace {

/// Names of a colour's channels, the clearest first.
constexpr struct {
  std::string_view names[3];
  std::string_view alpha;
  ColorModel model;
} kColorNames[] = {{{"R", "G", "B"}, "A", ColorModel::kRgb},
                   {{"X", "Y", "Z"}, "A", ColorModel::kXyz},
                   {{"r", "g", "b"}, "a", ColorModel::kRgb},
                   {{"red", "green", "blue"}, "alpha", ColorModel::kRgb},
                   {{"Red", "Green", "Blue"}, "Alpha", ColorModel::kRgb},
                   {{"RED", "GREEN", "BLUE"}, "ALPHA", ColorModel::kRgb},
                   {{"Y", "Y", "Y"}, "A", ColorModel::kLuminance}};

// Layers that programs give to what would be plain elsewhere. Source: Nuke and Arnold (rgba, rgb), Blender
// (Combined).
constexpr std::string_view kMainLayers[] = {"rgba", "rgb", "Combined"};

/// A name without the prefix of `prefix`, up to its last point.
std::string prefix_of(std::string_view name) {
  const std::size_t point = name.rfind('.');
  return std::string(name.substr(0, point == std::string_view::npos ? 0 : point + 1));
}

/// The layer of a prefix, without the view in it and the last point.
std::string layer_of(const ColorChannels& c) {
  std::string layer = c.prefix.substr(0, c.prefix.empty() ? 0 : c.prefix.size() - 1);
  if (c.view.empty()) return layer;
  if (layer == c.view) return {};
  if (layer.ends_with("." + c.view)) layer.resize(layer.size() - c.view.size() - 1);
  return layer;
}

bool is_main(const ColorChannels& c) {
  const std::string layer = layer_of(c);
  const std::string last = layer.substr(layer.rfind('.') == std::string::npos ? 0 : layer.rfind('.') + 1);
  return std::find(std::begin(kMainLayers), std::end(kMainLayers), last) != std::end(kMainLayers);
}

std::string joined_names(const ColorChannels& c) {
  return c.model == ColorModel::kLuminance ? c.names[0]
                                           : fmt::format("{}, {}, {}", c.names[0], c.names[1], c.names[2]);
}

std::string listed(const ExrInput& input, const std::vector<ColorChannels>& all) {
  if (all.empty()) {
    std::string out;
    std::size_t more = 0;
    for (int part = 0; part < input.parts(); ++part) {
      for (const StoredChannel& channel : input.header(part).channels()) {
        constexpr std::size_t kShown = 200;
        if (out.size() > kShown) {
          ++more;
        } else {
          out += (out.empty() ? "channels " : ", ") + channel.name;
        }
      }
    }
    return out + (more > 0 ? fmt::format(" and {} more", more) : "");
  }
  std::string out;
  for (const ColorChannels& c : all) out += (out.empty() ? "" : "; ") + description(input, c);
  return out;
}

/// True for names that are no plain R, G, B, and for those of a layer without a name.
bool is_spelled_otherwise(const ColorChannels& c) {
  const std::string plain = c.names[0].substr(c.prefix.size());
  return c.model == ColorModel::kRgb && (plain != "R" || c.prefix == ".");
}

}  // namespace

std::string description(const ExrInput& input, const ColorChannels& channels) {
  std::string out = "colour " + joined_names(channels);
  if (input.parts() > 1) out += fmt::format(" of part \"{}\"", part_label(input, channels.part));
  if (!channels.view.empty()) out += fmt::format(" of view \"{}\"", channels.view);
  return out;
}

std::string view_of(std::string_view channel, const std::vector<std::string>& views) {
  const std::string view = possible_view(channel);
  return std::find(views.begin(), views.end(), view) != views.end() ? view : std::string();
}

std::vector<ColorChannels> color_sets(const ExrInput& input) {
  std::vector<ColorChannels> out;
  for (int part = 0; part < input.parts(); ++part) {
    const PartHeader& header = input.header(part);
    if (header.deep()) continue;
    const std::vector<std::string> views = header.views();
    std::set<std::string> prefixes;
    for (const StoredChannel& channel : header.channels()) prefixes.insert(prefix_of(channel.name));
    for (const std::string& prefix : prefixes) {
      for (const auto& known : kColorNames) {
        ColorChannels c;
        c.part = part;
        c.prefix = prefix;
        c.model = known.model;
        bool all = true;
        for (std::size_t k = 0; k < 3; ++k) {
          c.names[k] = prefix + std::string(known.names[k]);
          all = all && header.find(c.names[k]) != nullptr;
        }
        if (!all) continue;
        if (header.find(prefix + std::string(known.alpha)) != nullptr)
          c.alpha = prefix + std::string(known.alpha);
        c.view = view_of(c.names[0], views);
        if (c.view.empty()) c.view = views.empty() ? header.text("view").value_or("") : views.front();
        out.push_back(std::move(c));
        break;
      }
    }
  }
  return out;
}

Result<ColorChannels> choose_colors(const ExrInput& input, const ChannelChoice& choice,
                                    std::vector<std::string>& notes) {
  SPECTILE_ASSIGN(const auto part, chosen_part(input, choice.part));
  const std::vector<ColorChannels> all = color_sets(input);
  std::vector<ColorChannels> fit;
  for (const ColorChannels& c : all) {
    if (part && c.part != *part) continue;
    if (!choice.view.empty() && c.view != choice.view) continue;
    const PartHeader& header = input.header(c.part);
    const bool plain = layer_of(c).empty();
    const bool named =
        layer_of(c) == choice.layer || c.prefix == choice.layer + "." ||
        (plain && (header.text("name") == choice.layer || header.text("view") == choice.layer));
    if (!choice.layer.empty() && !named) continue;
    fit.push_back(c);
  }
  if (fit.empty()) {
    const bool asked = !choice.layer.empty() || !choice.view.empty() || part;
    if (asked && !all.empty()) {
      return make_error(ErrorCode::kBadFile, "{}: has no colour of {}; it has {}", input.path(),
                        asked_for(choice), listed(input, all));
    }
    return make_error(ErrorCode::kBadFile, "{}: has no channels R, G, B (nor Y); it has {}", input.path(),
                      listed(input, {}));
  }
  const auto is_default = [&](const ColorChannels& c) {
    const std::vector<std::string> views = input.header(c.part).views();
    return views.empty() || c.view == views.front();
  };
  std::ranges::stable_sort(fit, {}, [&](const ColorChannels& c) {
    const bool plain = layer_of(c).empty();
    return std::tuple(!plain, !is_main(c), !is_default(c), c.part);
  });
  const ColorChannels chosen = fit.front();
  const std::string layer = layer_of(chosen);
  if (!layer.empty() && choice.layer.empty()) {
    const bool others =
        std::any_of(fit.begin(), fit.end(), [&](const auto& c) { return layer_of(c) != layer; });
    if (others && !is_main(chosen)) {
      return make_error(ErrorCode::kBadFile,
                        "{}: has colours in several layers, of which --layer states one: {}", input.path(),
                        listed(input, fit));
    }
    notes.push_back(
        fmt::format("layer \"{}\"{} is taken", layer, others ? "" : ", the only one with colours,"));
  }
  if (is_spelled_otherwise(chosen)) {
    notes.push_back(fmt::format("channels {} are taken for R, G, B", joined_names(chosen)));
  }
  if (chosen.model == ColorModel::kXyz) {
    notes.push_back(fmt::format("channels {} are taken for CIE XYZ under D65", joined_names(chosen)));
  }
  const PartHeader& header = input.header(chosen.part);
  const bool chroma =
      header.find(chosen.prefix + "RY") != nullptr && header.find(chosen.prefix + "BY") != nullptr;
  if (chosen.model == ColorModel::kLuminance && !chroma) {
    notes.push_back(fmt::format("channel {} alone is taken for grey", chosen.names[0]));
  }
  if (header.find(chosen.names[0])->type == SampleType::kUint32) {
    notes.push_back(
        fmt::format("channels {} are integers: 1 is white, as it is of floats", joined_names(chosen)));
  }
  return chosen;
}

}  // namespace spectile::io
