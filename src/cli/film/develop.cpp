// spectile film develop: a partial film becomes an image.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "src/cli/commands.hpp"
#include "src/cli/options/common_options.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

constexpr Choice<FilmLayer> kLayers[] = {
    {"srgb", FilmLayer::kSrgb},     {"xyz", FilmLayer::kXyz},           {"luminance", FilmLayer::kLuminance},
    {"sensor", FilmLayer::kSensor}, {"spectral", FilmLayer::kSpectrum}, {"weight", FilmLayer::kWeight},
    {"count", FilmLayer::kCount},   {"variance", FilmLayer::kVariance}};

struct DevelopArguments {
  Common common;
  WriteOptions write;
  std::string input;
  std::string output;
  FilmLayer to = FilmLayer::kSrgb;
  std::optional<std::string> sensor;
};

/// Index of the film's sensor: the one named, or the only one.
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

int run_develop(const DevelopArguments& a) {
  apply_common(a.common);
  ImageOptions options;
  apply_write_options(a.write, a.common, options);
  check_image_name(a.output);
  check_outputs({{a.output, kOutputRole}}, {{a.input, kInputRole}});
  catch_signals();
  std::vector<std::string> notes;
  options.progress = progress_bar(std::filesystem::path(a.output).filename().string(), !a.common.quiet);
  const LoadedFilm loaded = load_film_file(a.input, a.common.threads, notes);
  std::size_t sensor = 0;
  if (a.to == FilmLayer::kSensor) {
    const auto found = sensor_of(loaded.film, a.sensor);
    if (!found) return complain({found.error().code, fmt::format("{}: {}", a.input, found.error().message)});
    sensor = *found;
  }
  const auto report = write_developed(loaded.film, a.to, sensor, a.output, options);
  options.progress = nullptr;  // clears the bar
  if (!report) {
    const bool of_film = report.error().code == ErrorCode::kBadArgument;
    return complain(
        {of_film ? ErrorCode::kBadFile : report.error().code,
         of_film ? fmt::format("{}: {}", a.input, report.error().message) : report.error().message});
  }
  const FilmStats stats = loaded.film.stats();
  if (a.common.json) {
    print_json({{"input", a.input},
                {"output", a.output},
                {"to", name_of(kLayers, a.to)},
                {"width", report->width},
                {"height", report->height},
                {"samples", stats.accepted},
                {"limited_samples", report->clamped_pixels},
                {"bytes_written", report->bytes_written},
                {"seconds", report->seconds},
                {"notes", notes}});
  } else if (!a.common.quiet) {
    print("{} -> {}: {} x {}, {} of {} samples, {}, {:.2f} s\n", a.input, a.output, report->width,
          report->height, name_of(kLayers, a.to), stats.accepted, size_text(report->bytes_written),
          report->seconds);
    print_clamped(report->clamped_pixels, "value");
    Notes().print(notes);
  }
  return kOk;
}

}  // namespace

void add_film_develop(const Command& film, int& exit) {
  const auto [command, a] =
      add_subcommand(film, "develop", "Develop a partial film into an image", run_develop, exit);
  command.positional("IN", a->input, "Partial film").required();
  command.output_file("-o,--output", a->output, kFilesGroup, "Image to write").required();
  command.choice("--to", a->to, kLayers, kColorGroup,
                 "srgb, xyz, luminance, sensor, spectral, weight, count or variance");
  command.option("--sensor", a->sensor, "NAME", kColorGroup,
                 "Sensor to develop, where the film holds several");
  add_format_options(command, a->write, "half");
  add_common(command, a->common, "spectile film develop all.exr --to xyz --depth float -o image.exr");
}

}  // namespace spectile::cli
