// spectile expand: images of coefficients to spectral ones.
#include <memory>

#include "src/cli/commands.hpp"
#include "src/cli/jobs.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  ImageCommand image;
  std::string bands;
};

int run(const Arguments& a) {
  ExpandImageOptions options;
  if (const int bad = a.image.apply(options)) return bad;
  if (!a.bands.empty()) {
    if (const int bad = take(find_bands(a.bands), options.bands)) return bad;
  }
  return run_jobs(a.image, settings_text(options), files_among({file_of_bands(a.bands)}), options.progress,
                  [&](const Job& job) { return expand_image(job.input, job.output, options); });
}

}  // namespace

void add_expand(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "expand", "Turn coefficient images (upsample --store coefficients) into spectral ones");
  a->image.add_files(*command, "OpenEXR images with channels spectile.c0, c1, c2");
  command
      ->add_option("--bands", a->bands,
                   "FIRST:LAST:STEP, centres in nm, or a plan; the image's own by default")
      ->type_name("BANDS")
      ->group(kBandsGroup);
  a->image.add_options(*command, "half", "spectile expand wood-c.exr -o wood-s.exr --bands 380:780:5");
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
