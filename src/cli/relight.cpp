// spectile relight: textures under another illuminant.

#include "src/cli/commands.hpp"
#include "src/cli/jobs.hpp"
#include "src/cli/options/method_options.hpp"

namespace spectile::cli {
namespace {

constexpr Choice<RelightMode> kModes[] = {{"direct", RelightMode::kDirect},
                                          {"spectra", RelightMode::kSpectra}};

struct RelightArguments {
  ImageCommand image;
  MethodArguments method;
  std::string illuminant;
  Observer observer = Observer::kCie1931;
  ColorTarget to = ColorTarget::kSrgb;
  Adaptation adapt = Adaptation::kNone;
  RelightMode mode = RelightMode::kDirect;
};

int run_relight(const RelightArguments& a) {
  RelightImageOptions options(take(find_light(a.illuminant, file_options(a.method.spectra))));
  a.image.apply(options);
  apply_method_options(a.method, options);
  options.target = a.to;
  options.seen_by = a.observer;
  options.adaptation = a.adapt;
  options.mode = a.mode;
  std::vector<NamedFile> dependencies = files_among({{a.illuminant, kIlluminantRole}});
  for (NamedFile& file : method_files(a.method)) dependencies.push_back(std::move(file));
  // Which of both lights a plan lacks.
  const bool lacks_white =
      static_cast<bool>(Projector::reflective(options.bands, options.under.spectrum, a.observer));
  return run_jobs(a.image,
                  {settings_text(options), std::move(dependencies), color_handling(options),
                   lacks_white ? a.method.white : a.illuminant, file_of_bands(a.method.bands),
                   light_notes({&options.under, options.light ? &*options.light : nullptr})},
                  options.progress,
                  [&](const Job& job) { return relight_image(job.input, job.output, options); });
}

}  // namespace

void add_relight(const Command& app, int& exit) {
  const auto [command, a] = add_subcommand(
      app, "relight", "Show textures under another illuminant, without spectral images", run_relight, exit);
  a->image.add_files(command, "RGB OpenEXR images");
  command.option("--illuminant", a->illuminant, "SPECTRUM", kColorGroup, "Illuminant to show them under")
      .required();
  add_observer_option(command, a->observer);
  add_target_options(command, a->to, a->adapt);
  command.choice("--way", a->mode, kModes, kColorGroup,
                 "direct, or spectra: spectrum by spectrum, to check the former");
  add_method_options(command, a->method);
  add_alpha_option(command, a->method);
  a->image.add_options(
      command, "half",
      "spectile relight wood.exr -o wood-fl11.exr --illuminant FL11 --adapt cat16\n" + kSpectrumHelp);
}

}  // namespace spectile::cli
