// spectile project: spectral images to colour.
#include <memory>

#include "src/cli/batch.hpp"
#include "src/cli/common.hpp"
#include "src/cli/method_options.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  Common common;
  WriteOptions write;
  BatchOptions batch;
  std::vector<std::string> inputs;
  std::string output;
  std::string to = "srgb";
  std::string illuminant;
  std::string observer = "1931";
  std::string quantity;
  std::string adapt = "none";
};

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  ProjectImageOptions options;
  options.pixel = PixelType::kFloat;
  if (const int bad = apply_write_options(a.write, a.common, options)) return bad;
  if (const int bad = apply_region(a.batch, options)) return bad;
  options.target = a.to == "xyz"         ? ColorTarget::kXyz
                   : a.to == "luminance" ? ColorTarget::kLuminance
                                         : ColorTarget::kSrgb;
  options.observer = a.observer == "1964" ? Observer::kCie1964 : Observer::kCie1931;
  if (!a.illuminant.empty()) {
    auto light = load_light(a.illuminant);
    if (!light) return complain(light.error());
    options.light = std::move(light->spectrum);
  }
  options.adaptation = adaptation_of(a.adapt);
  if (!a.quantity.empty()) {
    const auto quantity = parse_quantity(a.quantity);
    if (!quantity) return complain(quantity.error());
    options.quantity = *quantity;
  }
  Batch batch;
  if (const int bad = plan_batch(a.batch, a.inputs, a.output, batch)) return bad;
  batch.settings = settings_text(options);
  batch.made_from = files_among({a.illuminant});
  return run_jobs(batch, a.common, options,
                  [&](const Job& job) { return project_image(job.input, job.output, options); });
}

}  // namespace

void add_project(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("project", "Turn spectral images into colour");
  command->add_option("IN", a->inputs, "Spectral OpenEXR images (channels T.*nm or S0.*nm)")->required();
  command->add_option("-o,--output", a->output, "File, or directory for several inputs")->required();
  command->add_option("--to", a->to, "srgb (linear, white D65), xyz, or luminance (channel Y)")
      ->check(CLI::IsMember({"srgb", "xyz", "luminance"}))
      ->capture_default_str();
  command->add_option("--illuminant", a->illuminant,
                      "Light on reflectances: " + light_help() + "; D65 by default");
  add_adaptation_option(*command, a->adapt);
  command->add_option("--observer", a->observer, "1931 (2 degree) or 1964 (10 degree)")
      ->check(CLI::IsMember({"1931", "1964"}))
      ->capture_default_str();
  command
      ->add_option("--quantity", a->quantity,
                   "Which to take where a file holds both: reflectance or illuminant")
      ->check(CLI::IsMember({"reflectance", "illuminant"}));
  add_write_options(*command, a->write, "float");
  add_batch_options(*command, a->batch);
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
