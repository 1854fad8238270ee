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
};

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  UpsampleImageOptions options;
  if (const int bad = apply_write_options(a.write, a.common, options)) return bad;
  if (const int bad = apply_region(a.batch, options)) return bad;
  if (const int bad = apply_method_options(a.method, options)) return bad;
  options.store = a.store == "coefficients" ? Store::kCoefficients : Store::kSpectra;
  Batch batch;
  if (const int bad = plan_batch(a.batch, a.inputs, a.output, batch)) return bad;
  batch.settings = settings_text(options);
  batch.made_from = files_among({a.method.light});
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
  add_write_options(*command, a->write, "half");
  add_batch_options(*command, a->batch);
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
