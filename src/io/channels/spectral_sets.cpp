// SpectralSet: spectral channels that belong together.
#include "src/io/channels/spectral_sets.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "src/base/errors.hpp"
#include "src/io/channels/plan_attribute.hpp"

namespace spectile::io {
namespace {

constexpr double kNameNm = 1e-6;  // names have six decimals

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

}  // namespace

const char* quantity_noun(Quantity quantity) {
  return quantity == Quantity::kReflectance ? "reflectance" : "emission";
}

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
  if (names.empty()) {
    return make_error(
        ErrorCode::kBadFile,
        "{}: re-radiates, but has no channels of one wavelength (T.500,000000nm), which say the "
        "bands",
        path);
  }
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
    while (i < bands.count() && std::abs(bands[i].centre_nm - nm) > kNameNm) ++i;
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

Result<std::vector<std::string>> SpectralSet::stokes(int component, const std::string& path) const {
  std::vector<std::string> out;
  bool same = true;
  for (const auto& [name, channel] : polarised) {
    if (channel.stokes != component) continue;
    const std::size_t i = out.size();
    same = same && i < read.size() && std::abs(read[i].wavelength_nm - channel.wavelength_nm) <= kNameNm;
    out.push_back(name);
  }
  if (out.empty()) {
    return make_error(ErrorCode::kBadFile, "{}: has no channels S{} of polarised light", path, component);
  }
  if (!same || out.size() != read.size()) {
    return make_error(ErrorCode::kBadFile, "{}: channels S{} have other wavelengths than S0", path,
                      component);
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
    using Key = std::tuple<std::string, std::string, Quantity, const Dialect*>;
    std::map<Key, std::vector<std::pair<std::string, SpectralChannel>>> found;
    for (const StoredChannel& stored : header.channels()) {
      const auto channel = parse_spectral_channel(stored.name, header);
      if (!channel) continue;
      auto [layer, view] = layer_and_view(channel->prefix, views);
      if (view.empty()) view = header.text("view").value_or("");
      const bool light =
          channel->kind == SpectralKind::kEmissive || channel->kind == SpectralKind::kPolarised;
      const Quantity quantity = light ? Quantity::kIlluminant : Quantity::kReflectance;
      found[{layer, view, quantity, channel->dialect}].emplace_back(stored.name, *channel);
    }
    for (auto& [key, channels] : found) {
      std::ranges::stable_sort(channels, {}, [](const auto& c) { return c.second.wavelength_nm; });
      SpectralSet set;
      set.part = part;
      if (input.parts() > 1) set.part_name = part_label(input, part);
      std::tie(set.layer, set.view, set.quantity, set.dialect) = key;
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
        set.quantity_assumed = !channel.dialect->says_quantity;
        set.names.push_back(name);
        set.read.push_back(channel);
      }
      if (!set.names.empty() || !set.reradiating.empty()) out.push_back(std::move(set));
    }
  }
  return out;
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

}  // namespace spectile::io
