// spectile film develop: a partial film becomes an image.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "src/cli/common.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  Common common;
  WriteOptions write;
  std::string input;
  std::string output;
  std::string to = "srgb";
  std::optional<std::string> sensor;
};

const std::map<std::string, FilmLayer>& layers() {
  static const std::map<std::string, FilmLayer> all = {
      {"srgb", FilmLayer::kSrgb},           {"xyz", FilmLayer::kXyz},
      {"luminance", FilmLayer::kLuminance}, {"sensor", FilmLayer::kSensor},
      {"spectral", FilmLayer::kSpectrum},   {"weight", FilmLayer::kWeight},
      {"count", FilmLayer::kCount},         {"variance", FilmLayer::kVariance}};
  return all;
}

/// Which of the film's sensors: the one named, or the only one.
Result<std::size_t> sensor_of(const Film& film, const std::optional<std::string>& name) {
  const auto& sensors = film.options().sensors;
  std::vector<std::string> names;
  names.reserve(sensors.size());
  for (const NamedSensor& s : sensors) names.push_back(s.name);
  if (sensors.empty()) return Error{ErrorCode::kBadFile, "the film keeps no sensor"};
  if (!name && sensors.size() == 1) return std::size_t{0};
  const auto it = std::find(names.begin(), names.end(), name.value_or(""));
  if (name && it != names.end()) return static_cast<std::size_t>(it - names.begin());
  return Error{ErrorCode::kUnknownName,
               name ? fmt::format("the film keeps no sensor \"{}\" but {}", *name, fmt::join(names, ", "))
                    : fmt::format("the film keeps {}: --sensor says which", fmt::join(names, ", "))};
}

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  ImageOptions options;
  if (const int bad = apply_write_options(a.write, a.common, options)) return bad;
  if (const auto good = check_output(a.output, {a.input}); !good) return complain(good.error());
  catch_signals();
  const auto loaded = load_film(a.input, a.common.threads);
  if (!loaded) return complain(loaded.error());
  const FilmLayer layer = layers().at(a.to);
  std::size_t sensor = 0;
  if (layer == FilmLayer::kSensor) {
    const auto found = sensor_of(loaded->film, a.sensor);
    if (!found) return complain({found.error().code, fmt::format("{}: {}", a.input, found.error().message)});
    sensor = *found;
  }
  const auto report = write_developed(loaded->film, layer, sensor, a.output, options);
  if (!report) {
    const bool of_film = report.error().code == ErrorCode::kBadArgument;
    return complain(
        {of_film ? ErrorCode::kBadFile : report.error().code,
         of_film ? fmt::format("{}: {}", a.input, report.error().message) : report.error().message});
  }
  const FilmStats stats = loaded->film.stats();
  if (a.common.json) {
    const nlohmann::json out = {{"input", a.input},
                                {"output", a.output},
                                {"to", a.to},
                                {"width", report->width},
                                {"height", report->height},
                                {"samples", stats.accepted},
                                {"limited_samples", report->clamped_pixels},
                                {"bytes_written", report->bytes_written},
                                {"seconds", report->seconds}};
    fmt::print("{}\n", out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (!a.common.quiet) {
    fmt::print("{} -> {}: {} x {}, {} of {} samples, {}, {:.2f} s\n", a.input, a.output, report->width,
               report->height, a.to, stats.accepted, size_text(report->bytes_written), report->seconds);
    if (report->clamped_pixels > 0) {
      fmt::print("  {} values beyond the range of half, limited to 65504; --pixel float keeps them\n",
                 report->clamped_pixels);
    }
  }
  return kOk;
}

}  // namespace

void add_film_develop(CLI::App& film, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = film.add_subcommand("develop", "Develop a partial film into an image");
  command->add_option("IN", a->input, "Partial film")->required();
  command->add_option("-o,--output", a->output, "Image")->required();
  command
      ->add_option("--to", a->to,
                   "srgb (linear, white D65), xyz, luminance (channel Y), sensor (its own R, G, B), spectral "
                   "(radiance on the film's bands), weight, count, or variance (of a pixel's mean luminance)")
      ->check(
          CLI::IsMember({"srgb", "xyz", "luminance", "sensor", "spectral", "weight", "count", "variance"}))
      ->capture_default_str();
  command->add_option("--sensor", a->sensor, "Which sensor, where the film keeps several");
  add_write_options(*command, a->write, "half");
  command->remove_option(command->get_option("--nonfinite"));
  command->remove_option(command->get_option("--lanes"));
  command->remove_option(command->get_option("--tile"));
  command->remove_option(command->get_option("--mipmap"));
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
