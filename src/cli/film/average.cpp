// spectile film average: independent renders of one frame become their weighted average.
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "src/cli/commands.hpp"
#include "src/cli/options/common_options.hpp"
#include "src/cli/options/parse.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

struct AverageArguments {
  Common common;
  WriteOptions write;
  std::vector<std::string> inputs;
  std::string output;
  std::optional<std::string> weights;
};

nlohmann::json to_json(const AverageArguments& a, const AverageOptions& options, const ImageReport& r) {
  nlohmann::json out = {{"inputs", a.inputs},
                        {"output", a.output},
                        {"width", r.width},
                        {"height", r.height},
                        {"nonfinite_pixels", r.nonfinite_pixels},
                        {"clamped_pixels", r.clamped_pixels},
                        {"bytes_written", r.bytes_written},
                        {"seconds", r.seconds},
                        {"notes", r.notes},
                        {"mpixel_per_s", static_cast<double>(r.pixels()) / r.seconds * 1e-6}};
  if (!options.weights.empty()) out["weights"] = options.weights;
  return out;
}

void print_report(const AverageArguments& a, const ImageReport& r) {
  print("{} -> {}: {} x {}, {}, {}, {:.2f} s\n", plural(a.inputs.size(), "image"), a.output, r.width,
        r.height, size_text(r.bytes_written), speed_text(r.pixels() * a.inputs.size(), r.seconds), r.seconds);
  if (r.nonfinite_pixels > 0) {
    print("  {} with non-finite samples, which were left out\n", plural(r.nonfinite_pixels, "pixel"));
  }
  print_clamped(r.clamped_pixels, "pixel");
  for (const std::string& note : r.notes) print("  {}\n", note);
}

int run_average(const AverageArguments& a) {
  apply_common(a.common);
  AverageOptions options;
  apply_write_options(a.write, a.common, options);
  if (a.write.pixel) options.stored = options.pixel;
  if (a.weights) options.weights = take(parse_weights(*a.weights));
  check_image_name(a.output);
  check_outputs({{a.output, kOutputRole}}, named_files(a.inputs, kInputRole));
  catch_signals();
  options.progress = progress_bar(std::filesystem::path(a.output).filename().string(), !a.common.quiet);
  const auto report = average_images(a.inputs, a.output, options);
  options.progress = nullptr;
  if (!report) {
    if (a.common.json) {
      print_json({{"inputs", a.inputs}, {"output", a.output}, {"error", report.error().message}});
    }
    return complain(report.error());
  }
  if (a.common.json) {
    print_json(to_json(a, options, *report));
  } else if (!a.common.quiet) {
    print_report(a, *report);
  }
  return kOk;
}

}  // namespace

void add_film_average(const Command& film, int& exit) {
  const auto [command, a] = add_subcommand(
      film, "average", "Average renders of one frame exactly, in any order", run_average, exit);
  command.positional("IN", a->inputs, "OpenEXR images of one frame with the same channels").required();
  command.output_file("-o,--output", a->output, kFilesGroup, "Image to write").required();
  command.option("--weights", a->weights, "W,W...", kFilesGroup,
                 "Weight of each image, such as 64,64,128; equal by default");
  add_nonfinite_option(command, a->write.nonfinite, "the sample is left out");
  add_format_options(command, a->write, "the widest type of each channel");
  add_common(command, a->common, "spectile film average a.exr b.exr --weights 64,128 -o mean.exr");
}

}  // namespace spectile::cli
