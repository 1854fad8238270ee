// spectile relight: textures under another light.
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
  MethodArguments method;
  std::vector<std::string> inputs;
  std::string output;
  std::string illuminant;
  std::string observer = "1931";
  std::string to = "srgb";
  std::string adapt = "none";
  std::string way = "direct";
};

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  auto light = load_light(a.illuminant);
  if (!light) return complain(light.error());
  RelightImageOptions options(*std::move(light));
  if (const int bad = apply_write_options(a.write, a.common, options)) return bad;
  if (const int bad = apply_region(a.batch, options)) return bad;
  if (const int bad = apply_method_options(a.method, options)) return bad;
  options.target = a.to == "xyz"         ? ColorTarget::kXyz
                   : a.to == "luminance" ? ColorTarget::kLuminance
                                         : ColorTarget::kSrgb;
  options.seen_by = a.observer == "1964" ? Observer::kCie1964 : Observer::kCie1931;
  options.adaptation = adaptation_of(a.adapt);
  options.way = a.way == "spectra" ? Way::kSpectra : Way::kDirect;
  Batch batch;
  if (const int bad = plan_batch(a.batch, a.inputs, a.output, batch)) return bad;
  batch.settings = settings_text(options);
  batch.made_from = files_among({a.illuminant, a.method.light, file_of_bands(a.method.bands)});
  return run_jobs(batch, a.common, options,
                  [&](const Job& job) { return relight_image(job.input, job.output, options); });
}

}  // namespace

void add_relight(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "relight", "Show textures under another light, as upsample and project would, without their spectra");
  command->add_option("IN", a->inputs, "RGB OpenEXR images")->required();
  command->add_option("-o,--output", a->output, "File, or directory for several inputs")->required();
  command->add_option("--illuminant", a->illuminant, "The light: " + light_help())->required();
  command->add_option("--observer", a->observer, "Who sees it: 1931 (2 degree) or 1964 (10 degree)")
      ->check(CLI::IsMember({"1931", "1964"}))
      ->capture_default_str();
  command->add_option("--to", a->to, "srgb (linear, white D65), xyz, or luminance (channel Y)")
      ->check(CLI::IsMember({"srgb", "xyz", "luminance"}))
      ->capture_default_str();
  add_adaptation_option(*command, a->adapt);
  command
      ->add_option("--way", a->way,
                   "direct, or spectra: the long way, spectrum by spectrum, to check the direct one")
      ->check(CLI::IsMember({"direct", "spectra"}))
      ->capture_default_str();
  add_method_options(*command, a->method);
  add_write_options(*command, a->write, "half");
  add_batch_options(*command, a->batch);
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
