// spectile info: the metadata of an image.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "src/cli/commands.hpp"
#include "src/cli/options/common_options.hpp"
#include "src/cli/options/parse.hpp"
#include "src/cli/output/plot.hpp"
#include "src/cli/output/print.hpp"

namespace spectile::cli {
namespace {

/// The first and the last pixel, both included.
std::array<int, 4> corners(const PixelWindow& window) {
  return {window.x0, window.y0, window.x1 - 1, window.y1 - 1};
}

struct InfoArguments {
  Common common;
  std::string input;
  std::string pixel;
  ChannelArguments channels;
};

/// The method of an image of coefficients; empty for other images.
std::string method_of_coefficients(const ImageInfo& info) {
  const bool coefficients = std::any_of(info.channels.begin(), info.channels.end(),
                                        [](const ChannelInfo& c) { return c.name == "spectile.c0"; });
  if (!coefficients) return {};
  for (const auto& [name, text] : info.attributes) {
    if (name == "spectileMethod") return text;
  }
  return "an unknown method";
}

nlohmann::json to_json(const std::string& path, const ImageInfo& info) {
  nlohmann::json out = {{"file", path},
                        {"width", info.width},
                        {"height", info.height},
                        {"data_window", corners(info.data_window)},
                        {"display_window", corners(info.display_window)},
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
  out["contents"] = info.contents;
  out["notes"] = info.notes;
  if (!info.dialect.empty()) out["dialect"] = info.dialect;
  if (!info.color_space.empty()) out["color_space"] = info.color_space;
  if (!info.alpha.empty()) out["alpha"] = info.alpha;
  for (const PartInfo& part : info.part_list) {
    nlohmann::json p = {{"name", part.name},
                        {"view", part.view},
                        {"deep", part.deep},
                        {"data_window", corners(part.data_window)},
                        {"display_window", corners(part.display_window)},
                        {"tiled", part.tiled},
                        {"levels", part.levels},
                        {"compression", part.compression},
                        {"channels", part.channels},
                        {"attributes", nlohmann::json::object()}};
    for (const auto& [name, text] : part.attributes) p["attributes"][name] = text;
    out["part_list"].push_back(std::move(p));
  }
  if (info.quantity) out["quantity"] = to_string(*info.quantity);
  if (info.bands) {
    out["bands"] = info.bands->count();
    for (const Band& band : info.bands->list()) out["centres_nm"].push_back(band.centre_nm);
  }
  if (const std::string method = method_of_coefficients(info); !method.empty())
    out["coefficients_of"] = method;
  if (!info.pixel.empty()) out["pixel"] = info.pixel;
  return out;
}

void print_channel(const ChannelInfo& c) {
  print("  {:<22} {:<5}  {:>11.5g} to {:<11.5g}", c.name, c.type, c.minimum, c.maximum);
  if (c.nonfinite > 0) print("  {} non-finite", c.nonfinite);
  if (c.negative > 0) print("  {} negative", c.negative);
  print("\n");
}

void print_part(std::size_t number, const PartInfo& part) {
  print("part {}{}{}: {} x {}, {}{}, {}{}\n", number, part.name.empty() ? "" : " \"" + part.name + "\"",
        part.view.empty() ? "" : ", view \"" + part.view + "\"", part.data_window.width(),
        part.data_window.height(),
        part.deep    ? "deep, "
        : part.tiled ? "tiled, "
                     : "",
        part.compression, plural(part.channels, "channel"),
        part.levels > 1 ? fmt::format(", {} mip levels", part.levels) : "");
}

void print_contents(const ImageInfo& info) {
  if (info.parts > 1) {
    for (std::size_t i = 0; i < info.part_list.size(); ++i) print_part(i, info.part_list[i]);
  } else if (info.part_list.front().levels > 1) {
    print("{} mip levels\n", info.part_list.front().levels);
  }
  for (const std::string& text : info.contents) print("holds {}\n", text);
  if (!info.dialect.empty()) print("dialect: {}\n", info.dialect);
  if (!info.color_space.empty()) print("colour space: {}\n", info.color_space);
  if (!info.alpha.empty()) print("alpha: channel {}\n", info.alpha);
  for (const std::string& note : info.notes) print("note: {}\n", note);
}

void print_info(const std::string& path, const ImageInfo& info) {
  print("{}: {} x {}, {}{}{}\n", path, info.width, info.height, info.tiled ? "tiled, " : "", info.compression,
        info.parts > 1 ? fmt::format(", {} parts", info.parts) : "");
  print_contents(info);
  const auto d = corners(info.data_window);
  const auto w = corners(info.display_window);
  if (d != w) {
    print("data window ({},{}) to ({},{}), display window ({},{}) to ({},{})\n", d[0], d[1], d[2], d[3], w[0],
          w[1], w[2], w[3]);
  }
  std::size_t plain = info.channels.size();
  if (info.bands) {
    plain -= info.bands->count();
    float minimum = info.channels[plain].minimum;
    float maximum = info.channels[plain].maximum;
    for (std::size_t i = plain; i < info.channels.size(); ++i) {
      minimum = std::min(minimum, info.channels[i].minimum);
      maximum = std::max(maximum, info.channels[i].maximum);
    }
    print("{} bands of {}, {} ({}), {:.5g} to {:.5g}\n", info.bands->count(), to_string(*info.quantity),
          info.bands->description(), info.channels[plain].type, minimum, maximum);
  }
  if (const std::string method = method_of_coefficients(info); !method.empty()) {
    print("coefficients of {}; spectile expand turns them into spectra\n", method);
  }
  std::size_t limbs = 0;
  for (std::size_t i = 0; i < plain; ++i) {
    const bool limb = info.channels[i].name.rfind("film.", 0) == 0;
    limbs += limb ? 1 : 0;
    if (!limb) print_channel(info.channels[i]);
  }
  if (limbs > 0) {
    print("  a partial film: {} channels of exact sums; develop it with spectile film develop\n", limbs);
  }
  print("{} non-finite and {} negative samples\n", info.nonfinite, info.negative);
  for (const auto& [name, text] : info.attributes) {
    // Long ones, as the bands of a coefficient image, are whole in --json.
    constexpr std::size_t kMaxLength = 160;
    print("{}: {}{}\n", name, text.substr(0, kMaxLength), text.size() > kMaxLength ? " ..." : "");
  }
}

void print_pixel(const ImageInfo& info, const std::string& where) {
  print("pixel {}\n", where);
  if (info.bands) {
    for (const std::string& line : plot(info.pixel, *info.bands)) print("{}\n", line);
    return;
  }
  for (std::size_t i = 0; i < info.pixel.size(); ++i) {
    print("  {:<22} {:.7g}\n", info.channels[i].name, info.pixel[i]);
  }
}

int run_info(const InfoArguments& a) {
  apply_common(a.common);
  std::optional<std::array<int, 2>> pixel;
  if (!a.pixel.empty()) {
    pixel = parse_pixel(a.pixel);
    if (!pixel) return complain_usage(fmt::format("--pixel {} is not X,Y", a.pixel));
  }
  const ImageInfo info = take(inspect_image(a.input, pixel, a.common.threads, channel_choice(a.channels)));
  if (a.common.json) {
    print_json(to_json(a.input, info));
  } else if (!a.common.quiet) {
    print_info(a.input, info);
    if (pixel) print_pixel(info, a.pixel);
  }
  return kOk;
}

}  // namespace

void add_info(const Command& app, int& exit) {
  const auto [command, a] =
      add_subcommand(app, "info", "Print image metadata, and a pixel's spectrum", run_info, exit);
  command.positional("FILE", a->input, "Any flat OpenEXR image", "").required();
  command.option("--pixel", a->pixel, "X,Y", kFilesGroup,
                 "Show this pixel, counted from the data window's upper left corner");
  add_channel_options(command, a->channels);
  add_channel_map_option(command, a->channels);
  add_common(command, a->common, "spectile info wood-spectral.exr --pixel 100,200");
}

}  // namespace spectile::cli
