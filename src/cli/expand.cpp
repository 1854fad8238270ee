// spectile expand: images of coefficients to spectral ones.
#include <memory>

#include "src/cli/batch.hpp"
#include "src/cli/common.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  Common common;
  WriteOptions write;
  BatchOptions batch;
  std::vector<std::string> inputs;
  std::string output;
  std::string bands;
};

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  ExpandImageOptions options;
  if (const int bad = apply_write_options(a.write, a.common, options)) return bad;
  if (const int bad = apply_region(a.batch, options)) return bad;
  if (!a.bands.empty()) {
    const auto bands = find_bands(a.bands);
    if (!bands) return complain(bands.error());
    options.bands = *bands;
  }
  Batch batch;
  if (const int bad = plan_batch(a.batch, a.inputs, a.output, batch)) return bad;
  batch.settings = settings_text(options);
  batch.made_from = files_among({file_of_bands(a.bands)});
  return run_jobs(batch, a.common, options,
                  [&](const Job& job) { return expand_image(job.input, job.output, options); });
}

}  // namespace

void add_expand(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "expand", "Turn images of coefficients (upsample --store coefficients) into spectral ones");
  command->add_option("IN", a->inputs, "OpenEXR images with channels spectile.c0, c1, c2")->required();
  command->add_option("-o,--output", a->output, "File, or directory for several inputs")->required();
  command->add_option(
      "--bands", a->bands,
      "FIRST:LAST:STEP in nm, a list of centres, or a plan (plan.json); by default those the image was made "
      "for, which "
      "give the bits that upsample writes. For others, basis spectra are made anew, and a sigmoid "
      "is evaluated at their centres, as far as the bands it was made for reach");
  add_write_options(*command, a->write, "half");
  add_batch_options(*command, a->batch);
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
