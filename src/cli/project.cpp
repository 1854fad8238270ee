// spectile project: spectral images to colour.
#include <fmt/format.h>

#include "src/cli/commands.hpp"
#include "src/cli/jobs.hpp"
#include "src/cli/options/spectrum_options.hpp"

namespace spectile::cli {
namespace {

/// Content of the output: a colour, or how light is polarised.
struct Target {
  ColorTarget color = ColorTarget::kSrgb;
  std::optional<Polarisation> polarisation = std::nullopt;
  friend bool operator==(const Target&, const Target&) = default;
};

enum class Quantities { kReflectance, kIlluminant, kBoth };

constexpr Choice<Quantities> kQuantities[] = {{"reflectance", Quantities::kReflectance},
                                              {"illuminant", Quantities::kIlluminant},
                                              {"emission", Quantities::kIlluminant},
                                              {"both", Quantities::kBoth}};
constexpr Choice<Target> kProjectTargets[] = {{"srgb", {ColorTarget::kSrgb}},
                                              {"xyz", {ColorTarget::kXyz}},
                                              {"luminance", {ColorTarget::kLuminance}},
                                              {"dop", {ColorTarget::kLuminance, Polarisation::kDegree}},
                                              {"aolp", {ColorTarget::kLuminance, Polarisation::kAngle}}};

struct ProjectArguments {
  ImageCommand image;
  Target to;
  std::string illuminant;
  Observer observer = Observer::kCie1931;
  std::optional<Quantities> quantity;
  std::optional<double> emission_scale;
  bool photometric = false;
  ChannelArguments channels;
  SpectrumArguments spectra;
  Adaptation adapt = Adaptation::kNone;
};

/// Throws: Stop.
void refuse_with_polarisation(const ProjectArguments& a) {
  const auto refuse = [](const char* option) {
    throw Stop(complain_usage(
        fmt::format("{} does not go with --to dop and aolp, which are of emission alone", option)));
  };
  if (!a.illuminant.empty()) refuse("--illuminant");
  if (a.adapt != Adaptation::kNone) refuse("--adapt");
  if (a.photometric) refuse("--photometric");
  if (a.quantity && *a.quantity != Quantities::kIlluminant) refuse("--quantity reflectance and both");
}

int project_polarisation(const ProjectArguments& a) {
  refuse_with_polarisation(a);
  PolarisationImageOptions options;
  options.pixel = SampleType::kFloat;
  a.image.apply(options);
  options.polarisation = *a.to.polarisation;
  options.observer = a.observer;
  options.channels = channel_choice(a.channels);
  return run_jobs(a.image, {settings_text(options), {}}, options.progress,
                  [&](const Job& job) { return polarisation_image(job.input, job.output, options); });
}

int run_project(const ProjectArguments& a) {
  if (a.emission_scale && a.quantity != Quantities::kBoth) {
    return complain_usage("--emission-scale is for --quantity both");
  }
  if (a.to.polarisation) return project_polarisation(a);
  ProjectImageOptions options;
  options.pixel = SampleType::kFloat;
  a.image.apply(options);
  options.target = a.to.color;
  options.observer = a.observer;
  std::optional<NamedLight> light;
  if (!a.illuminant.empty()) {
    light = take(find_light(a.illuminant, file_options(a.spectra)));
    options.light = light->spectrum;
  }
  options.adaptation = a.adapt;
  if (a.quantity == Quantities::kReflectance) options.quantity = Quantity::kReflectance;
  if (a.quantity == Quantities::kIlluminant) options.quantity = Quantity::kIlluminant;
  if (a.quantity == Quantities::kBoth) options.emission = a.emission_scale.value_or(1);
  options.photometric = a.photometric;
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
  command.choice("--to", a->to, kProjectTargets, kColorGroup,
                 "srgb (linear), xyz, luminance; of polarised light dop (degree), aolp (angle)");
  add_adapt_option(command, a->adapt);
  add_spectrum_options(command, a->spectra);
  command.choice("--quantity", a->quantity, kQuantities, kColorGroup,
                 "reflectance or illuminant, where a file holds both or does not say; both: their sum");
  command.option("--emission-scale", a->emission_scale, "FACTOR", kColorGroup,
                 "Factor on emission in --quantity both; 1 by default");
  command.flag("--photometric", a->photometric, kColorGroup, "Emission to Y in cd/m2, not relative");
  add_channel_options(command, a->channels);
  add_channel_map_option(command, a->channels);
  a->image.add_options(
      command, "float",
      "spectile project wood-s.exr -o wood-a.exr --illuminant A --observer 1964\n" + kSpectrumHelp);
}

}  // namespace spectile::cli
