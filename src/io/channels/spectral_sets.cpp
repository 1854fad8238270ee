// SpectralSet: spectral channels that belong together, and the choice among those that a file holds.
#include "src/io/channels/spectral_sets.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "src/base/errors.hpp"
#include "src/io/channels/plan_attribute.hpp"

namespace spectile::io {
namespace {

/// A prefix's layer and view: its last component is a view where the file knows one of that name.
std::pair<std::string, std::string> layer_and_view(const std::string& prefix,
                                                   const std::vector<std::string>& views) {
  const std::size_t point = prefix.rfind('.');
  const std::string last = point == std::string::npos ? prefix : prefix.substr(point + 1);
  if (std::find(views.begin(), views.end(), last) == views.end()) {
    return {prefix, views.empty() ? std::string() : views.front()};
  }
  return {point == std::string::npos ? std::string() : prefix.substr(0, point), last};
}

const char* quantity_noun(Quantity quantity) {
  return quantity == Quantity::kReflectance ? "reflectance" : "emission";
}

bool is_part(const SpectralSet& set, const std::string& name) {
  return !name.empty() && set.part_name == name;
}

/// Lists what each set is called, without repetitions.
template <class Name>
std::string list(const std::vector<SpectralSet>& sets, Name name) {
  std::string out;
  std::set<std::string> said;
  for (const SpectralSet& set : sets) {
    const std::string text = name(set);
    if (said.insert(text).second) out += (out.empty() ? "" : "; ") + text;
  }
  return out;
}

Result<SpectralSet> mapped_set(const ExrInput& input, const ChannelChoice& choice,
                               std::optional<Quantity> quantity, std::vector<std::string>& notes) {
  SPECTILE_ASSIGN(const auto part, chosen_part(input, choice.part));
  SpectralSet out;
  out.part = part.value_or(0);
  while (!part && input.header(out.part).deep()) ++out.part;
  for (const MappedChannel& channel : choice.map) {
    if (input.header(out.part).find(channel.name) == nullptr) {
      std::string there;
      for (const StoredChannel& stored : input.header(out.part).channels()) {
        there += (there.empty() ? "" : ", ") + stored.name;
      }
      return make_error(ErrorCode::kBadFile, "{}: has no channel \"{}\" of the channel map; it has {}",
                        input.path(), channel.name, there);
    }
    out.names.push_back(channel.name);
  }
  out.mapped = choice.map;
  out.quantity = quantity.value_or(Quantity::kIlluminant);
  if (!quantity)
    notes.emplace_back("mapped channels are taken for light; --quantity reflectance states the other");
  return out;
}

}  // namespace

Result<Bands> bands_read(const std::vector<SpectralChannel>& read) {
  std::vector<Band> list;
  for (std::size_t i = 0; i < read.size(); ++i) {
    const SpectralChannel& channel = read[i];
    if (channel.upper_nm > 0) list.push_back({channel.lower_nm, channel.wavelength_nm, channel.upper_nm});
    if (!channel.lower_edge) continue;
    // The last band is as wide as the one before.
    const double lower = channel.wavelength_nm;
    double width = 1;
    if (i + 1 < read.size()) {
      width = read[i + 1].wavelength_nm - lower;
    } else if (i > 0) {
      width = lower - read[i - 1].wavelength_nm;
    }
    list.push_back({lower, lower + width / 2, lower + width});
  }
  if (!list.empty()) return Bands::from_list(std::move(list));
  std::vector<double> centres;
  centres.reserve(read.size());
  for (const SpectralChannel& channel : read) centres.push_back(channel.wavelength_nm);
  return Bands::from_centres(centres);
}

Result<Bands> SpectralSet::bands(const PartHeader& header, const std::string& path) const {
  std::vector<Band> list;
  for (const MappedChannel& channel : mapped) list.push_back(channel.band);
  auto out = list.empty() ? bands_read(read) : Bands::from_list(std::move(list));
  if (!out) return make_error(ErrorCode::kBadFile, "{}: {}", path, out.error().message);
  return with_plan(header, *out, path);
}

Result<std::vector<ReradiationChannel>> SpectralSet::reradiation(const Bands& bands,
                                                                 const std::string& path) const {
  const auto band_of = [&](double nm) {
    std::size_t i = 0;
    // Names have six decimals.
    while (i < bands.count() && std::abs(bands[i].centre_nm - nm) > 1e-6) ++i;
    return i;
  };
  std::vector<ReradiationChannel> out;
  for (const auto& [name, channel] : reradiating) {
    const std::size_t from = band_of(channel.from_nm);
    const std::size_t to = band_of(channel.wavelength_nm);
    if (from == bands.count() || to == bands.count()) {
      return make_error(ErrorCode::kBadFile, "{}: channel \"{}\" re-radiates {} a wavelength without a band",
                        path, name, from == bands.count() ? "from" : "at");
    }
    out.push_back({name, from, to});
  }
  return out;
}

std::string SpectralSet::description() const {
  std::string out =
      fmt::format("{} band{} of {}", names.size(), names.size() == 1 ? "" : "s", quantity_noun(quantity));
  if (!reradiating.empty()) out += " with re-radiation";
  if (!part_name.empty()) out += fmt::format(", part \"{}\"", part_name);
  if (!layer.empty()) out += fmt::format(", layer \"{}\"", layer);
  if (!view.empty()) out += fmt::format(", view \"{}\"", view);
  return out;
}

std::vector<SpectralSet> spectral_sets(const ExrInput& input) {
  std::vector<SpectralSet> out;
  for (int part = 0; part < input.parts(); ++part) {
    const PartHeader& header = input.header(part);
    if (header.deep()) continue;
    const std::vector<std::string> views = header.views();
    using Key = std::tuple<std::string, std::string, Quantity>;
    std::map<Key, std::vector<std::pair<std::string, SpectralChannel>>> found;
    for (const StoredChannel& stored : header.channels()) {
      const auto channel = parse_spectral_channel(stored.name, header);
      if (!channel) continue;
      auto [layer, view] = layer_and_view(channel->prefix, views);
      if (view.empty()) view = header.text("view").value_or("");
      const bool light =
          channel->kind == SpectralKind::kEmissive || channel->kind == SpectralKind::kPolarised;
      const Quantity quantity = light ? Quantity::kIlluminant : Quantity::kReflectance;
      found[{layer, view, quantity}].emplace_back(stored.name, *channel);
    }
    for (auto& [key, channels] : found) {
      std::ranges::stable_sort(channels, {}, [](const auto& c) { return c.second.wavelength_nm; });
      SpectralSet set;
      set.part = part;
      if (input.parts() > 1) set.part_name = part_label(input, part);
      std::tie(set.layer, set.view, set.quantity) = key;
      set.default_view = views.empty() || set.view == views.front();
      for (auto& [name, channel] : channels) {
        if (channel.kind == SpectralKind::kReradiating) {
          set.reradiating.emplace_back(name, channel);
          continue;
        }
        if (channel.kind == SpectralKind::kPolarised) {
          set.polarised.emplace_back(name, channel);
          continue;
        }
        set.dialect = channel.dialect;
        set.quantity_assumed = !channel.dialect->says_quantity;
        set.names.push_back(name);
        set.read.push_back(channel);
      }
      if (!set.names.empty()) out.push_back(std::move(set));
    }
  }
  return out;
}

namespace {

/// The set that the choice and the quantity ask for, and where `all_quantities` that of the other quantity
/// beside it. Empty where the file holds no spectra.
Result<std::vector<SpectralSet>> choose(const ExrInput& input, const ChannelChoice& choice,
                                        std::optional<Quantity> quantity, bool all_quantities,
                                        std::vector<std::string>& notes) {
  if (!choice.map.empty()) {
    SPECTILE_ASSIGN(auto set, mapped_set(input, choice, quantity, notes));
    return std::vector{std::move(set)};
  }
  const std::vector<SpectralSet> all = spectral_sets(input);
  if (all.empty()) return std::vector<SpectralSet>();
  SPECTILE_ASSIGN(const auto part, chosen_part(input, choice.part));
  std::vector<SpectralSet> fit;
  for (SpectralSet set : all) {
    if (quantity && set.quantity_assumed) set.quantity = *quantity;
    if (part && set.part != *part) continue;
    if (!choice.view.empty() && set.view != choice.view) continue;
    if (!choice.layer.empty() && set.layer != choice.layer && set.view != choice.layer &&
        !is_part(set, choice.layer)) {
      continue;
    }
    if (quantity && set.quantity != *quantity) continue;
    fit.push_back(std::move(set));
  }
  const auto described = [](const SpectralSet& set) { return set.description(); };
  if (fit.empty()) {
    return make_error(ErrorCode::kBadFile, "{}: has no {} of {}; it has {}", input.path(),
                      quantity ? quantity_noun(*quantity) : "spectra", asked_for(choice),
                      list(all, described));
  }
  // Plain channels before layers, then the default view, the first part, reflectance.
  std::ranges::stable_sort(fit, {}, [](const SpectralSet& s) {
    return std::tuple(!s.layer.empty(), !s.default_view, s.part, s.quantity != Quantity::kReflectance);
  });
  const SpectralSet chosen = fit.front();
  const bool other_layers =
      std::any_of(fit.begin(), fit.end(), [&](const auto& s) { return s.layer != chosen.layer; });
  if (!chosen.layer.empty() && choice.layer.empty()) {
    if (other_layers) {
      return make_error(ErrorCode::kBadFile,
                        "{}: has spectra in several layers, of which --layer states one: {}", input.path(),
                        list(fit, [](const SpectralSet& s) { return s.layer; }));
    }
    notes.push_back(fmt::format("layer \"{}\", the only one with spectra, is taken", chosen.layer));
  }
  if (chosen.quantity_assumed && !quantity) {
    notes.push_back(fmt::format("{}'s channels are taken for light; --quantity reflectance states the other",
                                chosen.dialect->name));
  }
  std::vector<SpectralSet> out = {chosen};
  std::vector<SpectralSet> rest;
  for (const SpectralSet& set : all) {
    if (set.names == chosen.names && set.part == chosen.part) continue;
    const bool beside = set.part == chosen.part && set.layer == chosen.layer && set.view == chosen.view;
    (all_quantities && !quantity && beside ? out : rest).push_back(set);
  }
  if (!rest.empty()) {
    notes.push_back(
        fmt::format("left out: {} (see --layer, --view, --part, --quantity)", list(rest, described)));
  }
  return out;
}

}  // namespace

Result<std::optional<SpectralSet>> choose_spectra(const ExrInput& input, const ChannelChoice& choice,
                                                  std::optional<Quantity> quantity,
                                                  std::vector<std::string>& notes) {
  SPECTILE_ASSIGN(auto chosen, choose(input, choice, quantity, false, notes));
  if (chosen.empty()) return std::optional<SpectralSet>();
  return std::optional(std::move(chosen.front()));
}

Result<std::vector<SpectralSet>> choose_all_spectra(const ExrInput& input, const ChannelChoice& choice,
                                                    std::optional<Quantity> quantity,
                                                    std::vector<std::string>& notes) {
  return choose(input, choice, quantity, true, notes);
}

std::string asked_for(const ChannelChoice& choice) {
  std::string out;
  const auto add = [&](const char* what, const std::string& name) {
    if (!name.empty()) out += fmt::format("{}{} \"{}\"", out.empty() ? "" : ", ", what, name);
  };
  add("layer", choice.layer);
  add("view", choice.view);
  add("part", choice.part);
  return out.empty() ? "its own" : out;
}

Result<std::vector<PlaneSpec>> band_planes(const PartHeader& header, const SpectralSet& set,
                                           const std::string& path) {
  std::vector<PlaneSpec> out;
  const auto add = [&](const std::string& name) -> Result<void> {
    const StoredChannel& channel = *header.find(name);
    SPECTILE_TRY(check_sampling(channel, path));
    out.push_back({name, readable_type(channel.type)});
    return {};
  };
  for (const std::string& name : set.names) SPECTILE_TRY(add(name));
  for (const auto& [name, channel] : set.reradiating) SPECTILE_TRY(add(name));
  return out;
}

std::string part_label(const ExrInput& input, int part) {
  return input.header(part).text("name").value_or(std::to_string(part));
}

Result<std::optional<int>> chosen_part(const ExrInput& input, const std::string& part) {
  if (part.empty()) return std::optional<int>();
  std::string there;
  for (int i = 0; i < input.parts(); ++i) {
    if (input.header(i).deep()) continue;
    if (part_label(input, i) == part || std::to_string(i) == part) return std::optional(i);
    there += fmt::format("{}{} \"{}\"", there.empty() ? "" : ", ", i, part_label(input, i));
  }
  return make_error(ErrorCode::kBadFile, "{}: has no part \"{}\"; it has {}", input.path(), part, there);
}

}  // namespace spectile::io
