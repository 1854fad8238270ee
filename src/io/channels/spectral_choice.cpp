// The choice among the spectra that a file holds.
#include <algorithm>
#include <set>
#include <span>
#include <tuple>

#include "src/base/errors.hpp"
#include "src/io/channels/spectral_sets.hpp"

namespace spectile::io {
namespace {

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

std::string described(const SpectralSet& set) {
  return set.description();
}

/// That of all sets which fits a choice best. Errors: those of choose_spectra().
Result<SpectralSet> best_fit(const ExrInput& input, const std::vector<SpectralSet>& all,
                             const ChannelChoice& choice, std::optional<Quantity> quantity,
                             std::vector<std::string>& notes) {
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
  if (fit.empty()) {
    return make_error(ErrorCode::kBadFile, "{}: has no {} of {}; it has {}", input.path(),
                      quantity ? quantity_noun(*quantity) : "spectra", asked_for(choice),
                      list(all, described));
  }
  // Plain channels before layers, then the default view, the first part, reflectance.
  std::ranges::stable_sort(fit, {}, [](const SpectralSet& s) {
    return std::tuple(!s.layer.empty(), !s.default_view, s.part, s.quantity != Quantity::kReflectance);
  });
  SpectralSet chosen = fit.front();
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
  if (!chosen.read.empty() && chosen.read.front().lower_edge) {
    notes.push_back(fmt::format(
        "{}'s numbers are lower edges: a band ends where the next one starts, the last one is as wide "
        "as the one before",
        chosen.dialect->name));
  }
  return chosen;
}

void note_left_out(const ExrInput& input, const std::vector<SpectralSet>& all,
                   std::span<const SpectralSet> chosen, std::vector<std::string>& notes) {
  // Parts with spectra are named by what they hold.
  std::vector<int> named;
  named.reserve(all.size());
  for (const SpectralSet& set : all) named.push_back(set.part);
  note_other_parts(input, named, notes);
  std::vector<SpectralSet> rest;
  for (const SpectralSet& set : all) {
    const bool taken = std::ranges::any_of(
        chosen, [&](const auto& c) { return c.names == set.names && c.part == set.part; });
    if (!taken) rest.push_back(set);
  }
  if (rest.empty()) return;
  notes.push_back(
      fmt::format("left out: {} (see --layer, --view, --part, --quantity)", list(rest, described)));
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
  note_other_parts(input, {out.part}, notes);
  out.quantity = quantity.value_or(Quantity::kIlluminant);
  if (!quantity)
    notes.emplace_back("mapped channels are taken for light; --quantity reflectance states the other");
  return out;
}

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
  SPECTILE_ASSIGN(const auto chosen, best_fit(input, all, choice, quantity, notes));
  std::vector<SpectralSet> out = {chosen};
  for (const SpectralSet& set : all) {
    const bool beside = set.part == chosen.part && set.layer == chosen.layer && set.view == chosen.view;
    if (all_quantities && !quantity && beside && set.names != chosen.names) out.push_back(set);
  }
  note_left_out(input, all, out, notes);
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

std::string part_label(const ExrInput& input, int part) {
  return input.header(part).text("name").value_or(std::to_string(part));
}

void note_other_parts(const ExrInput& input, const std::vector<int>& read, std::vector<std::string>& notes) {
  constexpr int kShown = 8;
  std::string names;
  int others = 0;
  for (int part = 0; part < input.parts(); ++part) {
    if (std::find(read.begin(), read.end(), part) != read.end()) continue;
    if (++others <= kShown) names += fmt::format("{}\"{}\"", others > 1 ? ", " : "", part_label(input, part));
  }
  if (others == 0) return;
  if (others > kShown) names += fmt::format(" and {} more", others - kShown);
  notes.push_back(others == 1 ? fmt::format("1 other part of the file is left out: {}", names)
                              : fmt::format("{} other parts of the file are left out: {}", others, names));
}

Result<std::optional<int>> chosen_part(const ExrInput& input, const std::string& part) {
  if (part.empty()) return std::optional<int>();
  std::string there;
  for (int i = 0; i < input.parts(); ++i) {
    if (input.header(i).deep()) continue;
    if (part_label(input, i) == part || std::to_string(i) == part) return std::optional(i);
    const std::string label = part_label(input, i);
    there += fmt::format("{}{}", there.empty() ? "" : ", ", i);
    if (label != std::to_string(i)) there += fmt::format(" \"{}\"", label);
  }
  return make_error(ErrorCode::kBadFile, "{}: has no part \"{}\"; it has {}", input.path(), part, there);
}

}  // namespace spectile::io
