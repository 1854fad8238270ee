// spectile upsample: RGB images to spectral ones.

#include "src/cli/commands.hpp"
#include "src/cli/jobs.hpp"
#include "src/cli/options/method_options.hpp"

namespace spectile::cli {
namespace {

constexpr Choice<Store> kStores[] = {{"spectra", Store::kSpectra}, {"coefficients", Store::kCoefficients}};

struct UpsampleArguments {
  ImageCommand image;
  MethodArguments method;
  Store store = Store::kSpectra;
  std::string mask;
  bool no_skip = false;
};

int run_upsample(const UpsampleArguments& a) {
  UpsampleImageOptions options;
  a.image.apply(options);
  apply_method_options(a.method, options);
  options.store = a.store;
  options.skip = !a.no_skip;
  if (a.mask == "alpha") {
    options.masking = Masking::kAlpha;
  } else if (!a.mask.empty() && a.mask != "none") {
    options.masking = Masking::kFile;
  }
  if (options.masking == Masking::kFile) options.mask = a.mask;
  std::vector<NamedFile> dependencies = method_files(a.method);
  if (!options.mask.empty()) dependencies.push_back({options.mask, "the mask (--mask)"});
  return run_jobs(a.image,
                  {settings_text(options), std::move(dependencies), color_handling(options), a.method.white,
                   file_of_bands(a.method.bands), light_notes({options.light ? &*options.light : nullptr})},
                  options.progress,
                  [&](const Job& job) { return upsample_image(job.input, job.output, options); });
}

}  // namespace

void add_upsample(const Command& app, int& exit) {
  const auto [command, a] =
      add_subcommand(app, "upsample", "Turn RGB images into spectral ones", run_upsample, exit);
  a->image.add_files(command, "RGB OpenEXR images: half, float or uint, scanline or tiled");
  add_method_options(command, a->method);
  add_alpha_option(command, a->method);
  command.option("--mask", a->mask, "FILE", kFilesGroup,
                 "Image that is 0 where pixels become black; alpha: the image's own; none by default");
  command.choice("--store", a->store, kStores, kFormatGroup,
                 "spectra: a channel per band; coefficients: for spectile expand");
  a->image.add_options(
      command, "half",
      "spectile upsample wood.exr -o wood-s.exr --method sigmoid --bands 380:780:5\n" + kSpectrumHelp);
  command.flag("--no-skip", a->no_skip, kRunGroup,
               "Compute black, constant and repeated parts too; same bytes");
  command.flag("--stats", a->image.common.stats, kRunGroup, "Print what was skipped");
}

}  // namespace spectile::cli
