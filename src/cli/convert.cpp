// spectile convert: spectral images of any dialect to the layout, to other bands and units.
#include <fmt/format.h>

#include <algorithm>

#include "src/cli/commands.hpp"
#include "src/cli/jobs.hpp"
#include "src/cli/options/nearest.hpp"

namespace spectile::cli {
namespace {

constexpr Choice<Quantity> kTakenQuantities[] = {{"reflectance", Quantity::kReflectance},
                                                 {"illuminant", Quantity::kIlluminant}};

struct ConvertArguments {
  ImageCommand image;
  std::optional<Quantity> quantity;
  ChannelArguments channels;
  std::string dialect = "layout";
  std::string bands;
  double scale = 1;
  std::string units;
};

/// Throws: Stop.
void check_dialect_name(const std::string& name) {
  const std::vector<std::string> names = spectral_dialects();
  if (std::ranges::find(names, name) != names.end()) return;
  throw Stop(complain_usage(
      fmt::format("--dialect {} is none of {}{}", name, fmt::join(names, ", "), suggestion(name, names))));
}

int run_convert(const ConvertArguments& a) {
  check_dialect_name(a.dialect);
  ConvertImageOptions options;
  a.image.apply(options);
  options.keep_depth = !a.image.write.pixel;
  options.quantity = a.quantity;
  options.channels = channel_choice(a.channels);
  options.dialect = a.dialect;
  if (!a.bands.empty()) options.bands = take(bands_of(a.bands));
  options.scale = a.scale;
  options.units = a.units;
  return run_jobs(
      a.image,
      {settings_text(options),
       files_among({{file_of_bands(a.bands), kBandsRole}, {a.channels.map, "the channel map (--channels)"}})},
      options.progress, [&](const Job& job) { return convert_image(job.input, job.output, options); });
}

}  // namespace

void add_convert(const Command& app, int& exit) {
  const auto [command, a] =
      add_subcommand(app, "convert", "Write spectral images in the spectral layout, in other bands or units",
                     run_convert, exit);
  a->image.add_files(command, "Spectral OpenEXR images of any dialect");
  command.choice("--quantity", a->quantity, kTakenQuantities, kFilesGroup,
                 "reflectance or illuminant, where a file does not say; both by default");
  add_channel_options(command, a->channels);
  add_channel_map_option(command, a->channels);
  command.option("--bands", a->bands, "BANDS", kBandsGroup,
                 "FIRST:LAST:STEP (outer edges, width) or centres in nm: averages of the image's bands");
  command.option("--scale", a->scale, "FACTOR", kBandsGroup,
                 "Multiply every spectral sample; 0.01 for percent");
  command.option("--units", a->units, "TEXT", kBandsGroup,
                 "Units of emission in the output; those of the input by default");
  command
      .option("--dialect", a->dialect, "NAME", kFormatGroup,
              fmt::format("Channel names: {}", fmt::join(spectral_dialects(), ", ")))
      .show_default();
  a->image.add_options(command, "that of the input",
                       "spectile convert render.exr -o render-s.exr --bands 400:700:10");
}

}  // namespace spectile::cli
