// spectile film average: independent renders of one frame become their weighted average.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "src/cli/common.hpp"
#include "src/cli/option_texts.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  Common common;
  WriteOptions write;
  std::vector<std::string> inputs;
  std::string output;
  std::optional<std::string> weights;
};

nlohmann::json to_json(const Arguments& a, const AverageOptions& options, const ImageReport& r) {
  nlohmann::json out = {{"inputs", a.inputs},
                        {"output", a.output},
                        {"width", r.width},
                        {"height", r.height},
                        {"nonfinite_pixels", r.nonfinite_pixels},
                        {"clamped_pixels", r.clamped_pixels},
                        {"bytes_written", r.bytes_written},
                        {"seconds", r.seconds},
                        {"mpixel_per_s", static_cast<double>(r.pixels()) / r.seconds * 1e-6}};
  if (!options.weights.empty()) out["weights"] = options.weights;
  return out;
}

void print_report(const Arguments& a, const ImageReport& r) {
  fmt::print("{} image{} -> {}: {} x {}, {}, {}, {:.2f} s\n", a.inputs.size(),
             a.inputs.size() == 1 ? "" : "s", a.output, r.width, r.height, size_text(r.bytes_written),
             speed_text(r.pixels() * a.inputs.size(), r.seconds), r.seconds);
  const char* const s = r.nonfinite_pixels == 1 ? "" : "s";
  if (r.nonfinite_pixels > 0) {
    fmt::print("  {} pixel{} with non-finite samples, which were left out\n", r.nonfinite_pixels, s);
  }
  if (r.clamped_pixels > 0) {
    fmt::print("  {} pixel{} beyond the range of half, limited to 65504; --pixel float keeps them\n",
               r.clamped_pixels, r.clamped_pixels == 1 ? "" : "s");
  }
}

void print_line(const nlohmann::json& object) {
  fmt::print("{}\n", object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  AverageOptions options;
  if (const int bad = apply_write_options(a.write, a.common, options)) return bad;
  if (!a.write.pixel.empty()) options.stored = options.pixel;
  if (a.weights) {
    auto weights = parse_weights(*a.weights);
    if (!weights) return complain(weights.error());
    options.weights = *std::move(weights);
  }
  catch_signals();
  options.progress = progress_bar(std::filesystem::path(a.output).filename().string(), !a.common.quiet);
  const auto report = average_images(a.inputs, a.output, options);
  options.progress = nullptr;
  if (!report) {
    if (a.common.json) {
      print_line({{"inputs", a.inputs}, {"output", a.output}, {"error", report.error().message}});
    }
    return complain(report.error());
  }
  if (a.common.json) {
    print_line(to_json(a, options, *report));
  } else if (!a.common.quiet) {
    print_report(a, *report);
  }
  return kOk;
}

}  // namespace

void add_film_average(CLI::App& film, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = film.add_subcommand("average",
                                          "Average renders of one frame, channel by channel, whatever "
                                          "renderer made them. The sums are exact: no\n"
                                          "order of the images changes a bit");
  command->add_option("IN", a->inputs, "OpenEXR images with the same windows and channels")->required();
  command->add_option("-o,--output", a->output, "File")->required();
  command->add_option("--weights", a->weights,
                      "Weight of each image, with commas between, as in 64,64,128: samples a pixel, say; "
                      "equal by default");
  add_write_options(*command, a->write, "each channel's widest type among the images");
  command->get_option("--nonfinite")
      ->description(
          "Samples that are NaN or infinite: stop (no output is written) or zero (each is left out of the "
          "average at its pixel, which is 0 where all are)");
  command->remove_option(command->get_option("--lanes"));
  command->remove_option(command->get_option("--tile"));
  command->remove_option(command->get_option("--mipmap"));
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
