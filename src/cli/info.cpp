// spectile info: what a file holds.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "src/cli/common.hpp"
#include "src/cli/option_texts.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  Common common;
  std::string input;
  std::string pixel;
};

nlohmann::json to_json(const std::string& path, const ImageInfo& info) {
  nlohmann::json out = {{"file", path},
                        {"width", info.width},
                        {"height", info.height},
                        {"data_window", info.data_window},
                        {"display_window", info.display_window},
                        {"parts", info.parts},
                        {"tiled", info.tiled},
                        {"compression", info.compression},
                        {"nonfinite_samples", info.nonfinite},
                        {"negative_samples", info.negative},
                        {"channels", nlohmann::json::array()}};
  for (const ChannelInfo& c : info.channels) {
    out["channels"].push_back({{"name", c.name},
                               {"type", c.type},
                               {"minimum", c.minimum},
                               {"maximum", c.maximum},
                               {"nonfinite", c.nonfinite},
                               {"negative", c.negative}});
  }
  for (const auto& [name, text] : info.attributes) out["attributes"][name] = text;
  if (info.quantity) out["quantity"] = to_string(*info.quantity);
  if (info.bands) {
    out["bands"] = info.bands->count();
    for (const Band& band : info.bands->list()) out["centres_nm"].push_back(band.centre_nm);
  }
  if (!info.pixel.empty()) out["pixel"] = info.pixel;
  return out;
}

void print_channel(const ChannelInfo& c) {
  fmt::print("  {:<22} {:<5}  {:>11.5g} to {:<11.5g}", c.name, c.type, c.minimum, c.maximum);
  if (c.nonfinite > 0) fmt::print("  {} non-finite", c.nonfinite);
  if (c.negative > 0) fmt::print("  {} negative", c.negative);
  fmt::print("\n");
}

void print_info(const std::string& path, const ImageInfo& info) {
  fmt::print("{}: {} x {}, {}{}{}\n", path, info.width, info.height, info.tiled ? "tiled, " : "",
             info.compression, info.parts > 1 ? fmt::format(", first of {} parts", info.parts) : "");
  const auto& d = info.data_window;
  const auto& w = info.display_window;
  if (d != w) {
    fmt::print("data window ({},{}) to ({},{}), display window ({},{}) to ({},{})\n", d[0], d[1], d[2], d[3],
               w[0], w[1], w[2], w[3]);
  }
  std::size_t plain = info.channels.size();
  if (info.bands) {
    plain -= info.bands->count();
    float least = info.channels[plain].minimum;
    float most = info.channels[plain].maximum;
    for (std::size_t i = plain; i < info.channels.size(); ++i) {
      least = info.channels[i].minimum < least ? info.channels[i].minimum : least;
      most = info.channels[i].maximum > most ? info.channels[i].maximum : most;
    }
    fmt::print("{} bands of {}, {} ({}), {:.5g} to {:.5g}\n", info.bands->count(), to_string(*info.quantity),
               info.bands->description(), info.channels[plain].type, least, most);
  }
  std::size_t limbs = 0;
  for (std::size_t i = 0; i < plain; ++i) {
    const bool limb = info.channels[i].name.rfind("film.", 0) == 0;
    limbs += limb ? 1 : 0;
    if (!limb) print_channel(info.channels[i]);
  }
  if (limbs > 0) {
    fmt::print("  a partial film: {} channels of exact sums, which spectile film develop makes images of\n",
               limbs);
  }
  fmt::print("{} non-finite and {} negative samples\n", info.nonfinite, info.negative);
  for (const auto& [name, text] : info.attributes) {
    // Long ones, as the bands of a coefficient image, are whole in --json.
    constexpr std::size_t kMost = 160;
    fmt::print("{}: {}{}\n", name, text.substr(0, kMost), text.size() > kMost ? " ..." : "");
  }
}

void print_pixel(const ImageInfo& info, const std::string& where) {
  fmt::print("pixel {}\n", where);
  if (info.bands) {
    for (const std::string& line : plot(info.pixel, *info.bands)) fmt::print("{}\n", line);
    return;
  }
  for (std::size_t i = 0; i < info.pixel.size(); ++i) {
    fmt::print("  {:<22} {:.7g}\n", info.channels[i].name, info.pixel[i]);
  }
}

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  std::optional<std::array<int, 2>> pixel;
  if (!a.pixel.empty()) {
    pixel = parse_pixel(a.pixel);
    if (!pixel) {
      fmt::print(stderr, "spectile: --pixel {} is not X,Y\n", a.pixel);
      return kBadUsage;
    }
  }
  const auto info = inspect_image(a.input, pixel, a.common.threads);
  if (!info) return complain(info.error());
  if (a.common.json) {
    fmt::print("{}\n",
               to_json(a.input, *info).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (!a.common.quiet) {
    print_info(a.input, *info);
    if (pixel) print_pixel(*info, a.pixel);
  }
  return kOk;
}

}  // namespace

void add_info(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("info", "Say what an image holds");
  command->add_option("FILE", a->input, "Any flat OpenEXR image")->required();
  command->add_option("--pixel", a->pixel,
                      "X,Y from the upper left corner of the data window: show that pixel, a spectrum drawn");
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
