// spectile project: spectral images to colour.

#include "src/cli/commands.hpp"
#include "src/cli/jobs.hpp"
#include "src/cli/options/spectrum_options.hpp"

namespace spectile::cli {
namespace {

constexpr Choice<Quantity> kQuantities[] = {{"reflectance", Quantity::kReflectance},
                                            {"illuminant", Quantity::kIlluminant}};

struct ProjectArguments {
  ImageCommand image;
  ColorTarget to = ColorTarget::kSrgb;
  std::string illuminant;
  Observer observer = Observer::kCie1931;
  std::optional<Quantity> quantity;
  ChannelArguments channels;
  SpectrumArguments spectra;
  Adaptation adapt = Adaptation::kNone;
};

int run_project(const ProjectArguments& a) {
  ProjectImageOptions options;
  options.pixel = SampleType::kFloat;
  a.image.apply(options);
  options.target = a.to;
  options.observer = a.observer;
  std::optional<NamedLight> light;
  if (!a.illuminant.empty()) {
    light = take(find_light(a.illuminant, file_options(a.spectra)));
    options.light = light->spectrum;
  }
  options.adaptation = a.adapt;
  options.quantity = a.quantity;
  options.channels = channel_choice(a.channels);
  return run_jobs(
      a.image,
      {settings_text(options),
       files_among({{a.illuminant, kIlluminantRole}, {a.channels.map, "the channel map (--channels)"}}),
       {},
       a.illuminant,
       {},
       light_notes({light ? &*light : nullptr})},
      options.progress, [&](const Job& job) { return project_image(job.input, job.output, options); });
}

}  // namespace

void add_project(const Command& app, int& exit) {
  const auto [command, a] =
      add_subcommand(app, "project", "Turn spectral images into colour", run_project, exit);
  a->image.add_files(command, "Spectral OpenEXR images");
  command.option("--illuminant", a->illuminant, "SPECTRUM", kColorGroup,
                 "Illuminant on reflectances; D65 by default");
  add_observer_option(command, a->observer);
  add_target_options(command, a->to, a->adapt);
  add_spectrum_options(command, a->spectra);
  command.choice("--quantity", a->quantity, kQuantities, kColorGroup,
                 "reflectance or illuminant, where a file holds both or does not say");
  add_channel_options(command, a->channels);
  add_channel_map_option(command, a->channels);
  a->image.add_options(
      command, "float",
      "spectile project wood-s.exr -o wood-a.exr --illuminant A --observer 1964\n" + kSpectrumHelp);
}

}  // namespace spectile::cli
