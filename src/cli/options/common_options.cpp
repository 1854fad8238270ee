// Options that several subcommands share: execution, files written, observer, adaptation, colour target.
#include "src/cli/options/common_options.hpp"

#include <filesystem>

namespace spectile::cli {

void add_common(CLI::App& command, Common& common, const std::string& example) {
  const OptionAdder option{command};
  option("--threads", common.threads, "N", kRunGroup, "Threads; 0: one per core")
      ->check(CLI::Range(0, 1024).description(""))
      ->capture_default_str();
  option("--isa", common.isa, "NAME", kRunGroup,
         "scalar, sse4.2, avx2, avx512 or neon; the fastest by default");
  option.flag("--json", common.json, kRunGroup, "Print JSON, one object per line");
  option.flag("--quiet", common.quiet, kRunGroup, "Print errors only");
  // Made anew, so that its group is the last.
  command.set_help_flag("-h,--help", "Print this help message and exit")->group(kRunGroup);
  command.footer("Example:\n  " + example);
}

void apply_common(const Common& common) {
  if (!common.isa.empty()) take(force_isa(common.isa));
  take(active_isa());
}

void add_format_options(CLI::App& command, WriteOptions& options, const std::string& pixel_default) {
  const OptionAdder option{command};
  option
      .choice("--pixel", options.pixel, kSampleTypes, kFormatGroup,
              "Sample type: half or float; " + pixel_default + " by default")
      ->type_name("TYPE");
  option("--compression", options.compression, "NAME[:LEVEL]", kFormatGroup,
         "none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab; " + Compression{}.description() +
             " by default");
}

void add_nonfinite_option(CLI::App& command, NonFinite& nonfinite, const std::string& zero) {
  OptionAdder{command}.choice("--nonfinite", nonfinite, kNonFinites, kFilesGroup,
                              "NaN and infinity: error, or zero (" + zero + ")");
}

void add_layout_options(CLI::App& command, WriteOptions& options) {
  const OptionAdder option{command};
  command.add_option("--tile", options.tile, "Tile width and height, 1 to 4096; scanlines by default")
      ->expected(2)
      ->check(CLI::Range(1, 4096).description(""))
      ->option_text("W H")
      ->group(kFormatGroup);
  option.flag("--mipmap", options.mipmap, kFormatGroup,
              "Write mip levels too, in tiles (64 x 64 by default)");
  option("--lanes", options.lanes, "N", kRunGroup,
         "Largest number of pixels per kernel call; affects speed only")
      ->check(CLI::Range(std::size_t{64}, std::size_t{1} << 30).description(""))
      ->capture_default_str();
}

void add_film_compression_option(CLI::App& command, std::string& compression) {
  OptionAdder{command}("--compression", compression, "NAME[:LEVEL]", kFormatGroup,
                       "none, rle, zips, zip or piz")
      ->capture_default_str();
}

void apply_write_options(const WriteOptions& options, const Common& common, ImageOptions& out) {
  out.threads = common.threads;
  out.tile_lanes = options.lanes;
  if (!options.tile.empty()) out.tile = {options.tile[0], options.tile[1]};
  out.mipmap = options.mipmap;
  if (options.pixel) out.pixel = *options.pixel;
  out.nonfinite = options.nonfinite;
  if (!options.compression.empty()) out.compression = take(Compression::parse(options.compression));
}

CLI::Option* add_observer_option(CLI::App& command, Observer& observer, const char* flag) {
  return OptionAdder{command}.choice(flag, observer, kObservers, kColorGroup,
                                     "Standard observer: 1931 (2 degree) or 1964 (10 degree)");
}

void add_target_options(CLI::App& command, ColorTarget& target, Adaptation& adaptation) {
  const OptionAdder option{command};
  option.choice("--to", target, kTargets, kColorGroup,
                "srgb (linear, white D65), xyz or luminance (channel Y)");
  option.choice("--adapt", adaptation, kAdaptations, kColorGroup,
                "Chromatic adaptation from the illuminant to D65: none, bradford or cat16");
}

}  // namespace spectile::cli
