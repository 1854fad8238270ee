// Options that several subcommands share: execution, files written, observer, adaptation, colour target.
#include "src/cli/options/common_options.hpp"

#include <filesystem>

namespace spectile::cli {

void add_common(CLI::App& command, Common& common, const std::string& example) {
  command.add_option("--threads", common.threads, "Threads; 0: one per core")
      ->type_name("N")
      ->check(CLI::Range(0, 1024).description(""))
      ->capture_default_str()
      ->group(kRunGroup);
  command.add_option("--isa", common.isa, "scalar, sse4.2, avx2, avx512 or neon; the fastest by default")
      ->type_name("NAME")
      ->group(kRunGroup);
  command.add_flag("--json", common.json, "Print JSON, one object per line")->group(kRunGroup);
  command.add_flag("--quiet", common.quiet, "Print errors only")->group(kRunGroup);
  // Made anew, so that its group is the last.
  command.set_help_flag("-h,--help", "Print this help message and exit")->group(kRunGroup);
  command.footer("Example:\n  " + example);
}

int apply_common(const Common& common) {
  if (!common.isa.empty()) {
    if (auto forced = force_isa(common.isa); !forced) return complain(forced.error());
  }
  if (auto isa = active_isa(); !isa) return complain(isa.error());
  return kOk;
}

void add_format_options(CLI::App& command, WriteOptions& options, const std::string& pixel_default) {
  add_choice(command, "--pixel", options.pixel, kSampleTypes,
             "Sample type: half or float; " + pixel_default + " by default")
      ->type_name("TYPE")
      ->group(kFormatGroup);
  command
      .add_option("--compression", options.compression,
                  "none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab; " +
                      Compression{}.description() + " by default")
      ->type_name("NAME[:LEVEL]")
      ->group(kFormatGroup);
}

void add_nonfinite_option(CLI::App& command, NonFinite& nonfinite, const std::string& zero) {
  add_choice(command, "--nonfinite", nonfinite, kNonFinites,
             "NaN and infinity: error, or zero (" + zero + ")")
      ->group(kFilesGroup);
}

void add_layout_options(CLI::App& command, WriteOptions& options) {
  command.add_option("--tile", options.tile, "Tile width and height, 1 to 4096; scanlines by default")
      ->expected(2)
      ->check(CLI::Range(1, 4096).description(""))
      ->option_text("W H")
      ->group(kFormatGroup);
  command.add_flag("--mipmap", options.mipmap, "Write mip levels too, in tiles (64 x 64 by default)")
      ->group(kFormatGroup);
  command
      .add_option("--lanes", options.lanes, "Largest number of pixels per kernel call; affects speed only")
      ->type_name("N")
      ->check(CLI::Range(std::size_t{64}, std::size_t{1} << 30).description(""))
      ->capture_default_str()
      ->group(kRunGroup);
}

void add_film_compression_option(CLI::App& command, std::string& compression) {
  command.add_option("--compression", compression, "none, rle, zips, zip or piz")
      ->type_name("NAME[:LEVEL]")
      ->capture_default_str()
      ->group(kFormatGroup);
}

int apply_write_options(const WriteOptions& options, const Common& common, ImageOptions& out) {
  out.threads = common.threads;
  out.tile_lanes = options.lanes;
  if (!options.tile.empty()) out.tile = {options.tile[0], options.tile[1]};
  out.mipmap = options.mipmap;
  if (options.pixel) out.pixel = *options.pixel;
  out.nonfinite = options.nonfinite;
  return options.compression.empty() ? kOk : take(Compression::parse(options.compression), out.compression);
}

CLI::Option* add_observer_option(CLI::App& command, Observer& observer, const char* flag) {
  return add_choice(command, flag, observer, kObservers,
                    "Standard observer: 1931 (2 degree) or 1964 (10 degree)")
      ->group(kColorGroup);
}

void add_target_options(CLI::App& command, ColorTarget& target, Adaptation& adaptation) {
  add_choice(command, "--to", target, kTargets, "srgb (linear, white D65), xyz or luminance (channel Y)")
      ->group(kColorGroup);
  add_choice(command, "--adapt", adaptation, kAdaptations,
             "Chromatic adaptation from the illuminant to D65: none, bradford or cat16")
      ->group(kColorGroup);
}

}  // namespace spectile::cli
