// spectile expand: images of coefficients to spectral ones.

#include "src/cli/commands.hpp"
#include "src/cli/jobs.hpp"

namespace spectile::cli {
namespace {

struct ExpandArguments {
  ImageCommand image;
  std::string bands;
};

int run_expand(const ExpandArguments& a) {
  ExpandImageOptions options;
  a.image.apply(options);
  if (!a.bands.empty()) options.bands = take(bands_of(a.bands));
  return run_jobs(a.image, {settings_text(options), files_among({{file_of_bands(a.bands), kBandsRole}})},
                  options.progress,
                  [&](const Job& job) { return expand_image(job.input, job.output, options); });
}

}  // namespace

void add_expand(const Command& app, int& exit) {
  const auto [command, a] = add_subcommand(
      app, "expand", "Turn coefficient images (upsample --store coefficients) into spectral ones", run_expand,
      exit);
  a->image.add_files(command, "OpenEXR images with channels spectile.c0, c1, c2");
  command.option("--bands", a->bands, "BANDS", kBandsGroup,
                 "FIRST:LAST:STEP, centres in nm, or a plan; the image's own by default");
  a->image.add_options(command, "half", "spectile expand wood-c.exr -o wood-s.exr --bands 380:780:5");
}

}  // namespace spectile::cli
