// Fuzzes channel maps: what is read is bands in order, each of a channel of its own, and reads back the same.
#include <fmt/format.h>

#include <set>
#include <spectile/image/channel_map.hpp>

#include "fuzz/support.hpp"

namespace {

using namespace spectile;

/// The map as text: edges, which every band has.
std::string text_of(const std::vector<MappedChannel>& map) {
  std::string out;
  for (const MappedChannel& c : map)
    out += fmt::format("{};{};{}\n", c.name, c.band.lower_nm, c.band.upper_nm);
  return out;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::CaseFolder folder({data, size});
  const auto map = load_channel_map(folder.input());
  folder.require_tidy(false);
  if (!fuzz::is_value(map)) {
    fuzz::require(map.error().message.starts_with(folder.input()), "an error names its file",
                  map.error().message);
    return 0;
  }
  fuzz::require(!map->empty(), "a map names a channel");
  std::set<std::string> names;
  for (std::size_t i = 0; i < map->size(); ++i) {
    const Band& band = (*map)[i].band;
    fuzz::require(names.insert((*map)[i].name).second, "a channel stands once", (*map)[i].name);
    fuzz::require(band.lower_nm < band.upper_nm, "a band has a width", (*map)[i].name);
    fuzz::require(i == 0 || (*map)[i - 1].band.upper_nm <= band.lower_nm, "bands ascend and do not overlap",
                  (*map)[i].name);
  }
  // Outer edges lie as far out as the inner ones, which may be beyond what can be written.
  if (map->front().band.lower_nm <= 0 || map->back().band.upper_nm >= 1e9) return 0;
  const std::string text = text_of(*map);
  const fuzz::CaseFolder written({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  const auto again = load_channel_map(written.input());
  // Names with separators in them, or that begin a comment or a text in Unicode, cannot be written so.
  for (const MappedChannel& c : *map) {
    if (c.name.find_first_of(",;\t#") != std::string::npos || c.name.starts_with("\xEF\xBB\xBF") ||
        c.name.starts_with("\xFF\xFE") || c.name.starts_with("\xFE\xFF")) {
      return 0;
    }
  }
  fuzz::require(static_cast<bool>(again), "a map that is written can be read", text);
  fuzz::require(text_of(*again) == text, "a map that is written comes back", text);
  return 0;
}
