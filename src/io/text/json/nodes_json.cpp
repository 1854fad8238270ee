// Learned nodes as JSON text, and as files.
#include <cmath>
#include <spectile/image/nodes_file.hpp>
#include <spectile/output_file.hpp>

#include "src/io/text/json/checked_json.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile {
namespace {

using io::Json;
using io::Refused;

constexpr std::size_t kMaxWavelengths = 4096;
constexpr const char* kNodesAre = "the nodes";

std::string node_word(std::size_t node) {
  return fmt::format("\"offsets\" of node {}", node);
}

LearnedNodes nodes_from(const Json& json) {
  if (io::member(json, "method", kNodesAre) != "tetrahedral")
    throw Refused("\"method\" is not \"tetrahedral\", whose nodes alone can be learned");
  LearnedNodes out = {io::light_from(io::member(json, "light", kNodesAre)), Observer::kCie1931, 0, {}, {}};
  const Json& observer = io::member(json, "observer", kNodesAre);
  if (observer != "1931" && observer != "1964")
    throw Refused("\"observer\" is neither \"1931\" nor \"1964\"");
  if (observer == "1964") out.observer = Observer::kCie1964;
  const Json& count = io::member(json, "reflectances", kNodesAre);
  if (!count.is_number_unsigned()) throw Refused("\"reflectances\" is no number of them");
  out.reflectances = count.get<std::size_t>();
  const std::vector<double> levels = io::numbers(json, "levels", kNodesAre, kNodes);
  const auto own = node_levels();
  const bool same = std::ranges::equal(
      levels, own, [](double a, float b) { return std::abs(a - static_cast<double>(b)) <= 1e-6; });
  if (!same) throw Refused(fmt::format("\"levels\" are not {}", fmt::join(own, ", ")));
  out.wavelengths_nm = io::numbers(json, "wavelengths_nm", kNodesAre, kMaxWavelengths);
  const Json& offsets = io::member(json, "offsets", kNodesAre);
  if (!offsets.is_array() || offsets.size() != kNodes)
    throw Refused(fmt::format("\"offsets\" is no list of {} nodes", kNodes));
  for (std::size_t node = 0; node < kNodes; ++node) {
    const auto values = io::numbers(offsets[node], node_word(node), kMaxWavelengths);
    if (values.size() != out.wavelengths_nm.size()) {
      throw Refused(fmt::format("{} has {} entries for {} wavelengths", node_word(node), values.size(),
                                out.wavelengths_nm.size()));
    }
    for (const double v : values) out.offsets.push_back(static_cast<float>(v));
  }
  if (const std::string what = nodes_flaw(out); !what.empty()) throw Refused(what);
  return out;
}

}  // namespace

std::string nodes_to_json(const LearnedNodes& nodes, bool one_line) {
  Json light = {{"name", nodes.light.name}};
  io::add_spectrum(light, nodes.light);
  Json out = {{"method", "tetrahedral"},
              {"light", std::move(light)},
              {"observer", to_string(nodes.observer)},
              {"reflectances", nodes.reflectances},
              {"levels", node_levels()},
              {"wavelengths_nm", nodes.wavelengths_nm},
              {"offsets", Json::array()}};
  const std::size_t count = nodes.wavelengths_nm.size();
  for (std::size_t node = 0; node < kNodes && nodes_flaw(nodes).empty(); ++node)
    out["offsets"].push_back(std::span(nodes.offsets).subspan(node * count, count));
  return io::json_text(out, one_line);
}

Result<LearnedNodes> parse_nodes(std::string_view json, const std::string& source) {
  return io::read_json(json, source, "list of nodes", nodes_from);
}

Result<LearnedNodes> load_nodes(const std::string& path) {
  SPECTILE_ASSIGN(const auto file, io::read_text_file(path));
  return parse_nodes(*file.text, path);
}

Result<void> save_nodes(const LearnedNodes& nodes, const std::string& path) {
  if (const std::string what = nodes_flaw(nodes); !what.empty())
    return make_error(ErrorCode::kBadArgument, "{}: not written: {}", path, what);
  return write_text_file(path, nodes_to_json(nodes));
}

}  // namespace spectile
