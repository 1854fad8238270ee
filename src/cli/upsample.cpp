// spectile upsample: RGB images to spectral ones.
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
  MethodArguments method;
  std::string store = "spectra";
  std::string mask;
  bool no_skip = false;
};

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  UpsampleImageOptions options;
  if (const int bad = apply_write_options(a.write, a.common, options)) return bad;
  if (const int bad = apply_region(a.batch, options)) return bad;
  if (const int bad = apply_method_options(a.method, options)) return bad;
  options.store = a.store == "coefficients" ? Store::kCoefficients : Store::kSpectra;
  options.skip = !a.no_skip;
  if (!a.mask.empty()) options.masking = a.mask == "none" ? Masking::kNone : Masking::kFile;
  if (options.masking == Masking::kFile) options.mask = a.mask;
  Batch batch;
  if (const int bad = plan_batch(a.batch, a.inputs, a.output, batch)) return bad;
  batch.settings = settings_text(options);
  batch.made_from = files_among({a.method.light, file_of_bands(a.method.bands), options.mask});
  return run_jobs(batch, a.common, options,
                  [&](const Job& job) { return upsample_image(job.input, job.output, options); });
}

}  // namespace

void add_upsample(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("upsample", "Turn RGB images into spectral ones");
  command->add_option("IN", a->inputs, "RGB OpenEXR images: half, float or uint, scanline or tiled")
      ->required();
  command->add_option("-o,--output", a->output, "File, or directory for several inputs")->required();
  add_method_options(*command, a->method);
  command
      ->add_option("--store", a->store,
                   "spectra: a channel for each band; coefficients: three or four float channels (whatever "
                   "--pixel says), which spectile expand turns into the same spectra")
      ->check(CLI::IsMember({"spectra", "coefficients"}))
      ->capture_default_str();
  command->add_option(
      "--mask", a->mask,
      "Pixels that need no spectra, which become black (alpha stays): an OpenEXR image of the same size "
      "that is 0 there, in its channel A, else Y, else R; or none, so that textures which glow where "
      "alpha is 0 keep their colours. By default, where the image's own alpha is 0");
  command->add_flag("--no-skip", a->no_skip,
                    "Compute black, constant and repeated parts like any other; the file is the same");
  command->add_flag("--stats", a->common.stats, "Say what was skipped");
  add_write_options(*command, a->write, "half");
  add_batch_options(*command, a->batch);
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
