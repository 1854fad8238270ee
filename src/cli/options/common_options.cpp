// Options that several subcommands share: execution, files written, observer, adaptation, colour target.
#include "src/cli/options/common_options.hpp"

#include <fmt/format.h>

#include "src/cli/options/memory_limit.hpp"
#include "src/cli/options/parse.hpp"
#include "src/cli/output/print.hpp"

namespace spectile::cli {

void add_common(const Command& command, Common& common, const std::string& example) {
  command.option("--threads", common.threads, "N", kRunGroup, "Threads; 0: one per core")
      .range(0, 1024)
      .show_default();
  command
      .option("--max-memory", common.max_memory_gb, "GB", kRunGroup,
              "Most memory to take, 0 for no limit; as much as the machine has by default")
      .not_negative();
  command.option("--max-pixels", common.max_pixels, "N", kRunGroup, "Largest image to read; 0: any")
      .show_default();
  command.option("--isa", common.isa, "NAME", kRunGroup,
                 "scalar, sse4.2, avx2, avx512 or neon; the fastest by default");
  command.flag("--json", common.json, kRunGroup, "Print JSON, one object per line");
  command.flag("--quiet", common.quiet, kRunGroup, "Print errors only");
  // Made anew, so that its group is the last.
  command.help_group(kRunGroup);
  command.footer("Example:\n  " + example);
}

void apply_common(const Common& common) {
  limit_memory(common.max_memory_gb, common.threads);
  set_max_pixels(common.max_pixels);
  if (!common.isa.empty()) take(force_isa(common.isa));
  take(active_isa());
  const int threads = available_threads(common.threads);
  if (threads_refused() && !common.quiet) {
    print_error("spectile: the system makes only {}\n",
                plural(static_cast<std::uint64_t>(threads), "thread"));
  }
}

void add_channel_options(const Command& command, ChannelArguments& channels) {
  command.option("--layer", channels.layer, "NAME", kFilesGroup,
                 "Layer to read; also the name of a view or a part");
  command.option("--view", channels.view, "NAME", kFilesGroup, "View of a stereo image to read");
  command.option("--part", channels.part, "NAME", kFilesGroup,
                 "Part to read: its name, or its number from 0");
}

void add_channel_map_option(const Command& command, ChannelArguments& channels) {
  command.option("--channels", channels.map, "FILE", kFilesGroup,
                 "Wavelengths of channels whose names say none: CSV, channel,nm or channel,lower,upper");
}

ChannelChoice channel_choice(const ChannelArguments& channels) {
  ChannelChoice out{channels.layer, channels.view, channels.part, {}};
  if (!channels.map.empty()) out.map = take(load_channel_map(channels.map));
  return out;
}

void add_format_options(const Command& command, WriteOptions& options, const std::string& pixel_default) {
  command
      .choice("--depth", options.pixel, kSampleTypes, kFormatGroup,
              "Sample type: half or float; " + pixel_default + " by default")
      .type("TYPE");
  // Its name until 0.1; elsewhere --pixel is a position.
  command.choice("--pixel", options.pixel, kSampleTypes, kFormatGroup, "").hidden();
  command.option("--compression", options.compression, "NAME[:LEVEL]", kFormatGroup,
                 "none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab; " + Compression{}.description() +
                     " by default");
  command.flag("--fsync", options.fsync, kRunGroup,
               "Wait until the device holds the output: no loss of power can take it back");
}

void add_nonfinite_option(const Command& command, NonFinite& nonfinite, const std::string& zero) {
  command.choice("--nonfinite", nonfinite, kNonFinites, kFilesGroup,
                 "NaN and infinity: error, or zero (" + zero + ")");
}

void add_layout_options(const Command& command, WriteOptions& options) {
  command
      .option("--tile", options.tile, "W H", kFormatGroup,
              "Tile width and height, 1 to 4096; scanlines by default")
      .pair("W H")
      .range(1, 4096);
  command.flag("--mipmap", options.mipmap, kFormatGroup,
               "Write mip levels too, in tiles (64 x 64 by default)");
  command
      .option("--lanes", options.lanes, "N", kRunGroup,
              "Largest number of pixels per kernel call; affects speed only")
      .range(64, 1 << 30)
      .show_default();
}

void add_film_compression_option(const Command& command, std::string& compression) {
  command.option("--compression", compression, "NAME[:LEVEL]", kFormatGroup, "none, rle, zips, zip or piz")
      .show_default();
}

void apply_write_options(const WriteOptions& options, const Common& common, ImageOptions& out) {
  out.threads = common.threads;
  out.tile_lanes = options.lanes;
  if (!options.tile.empty()) out.tile = {options.tile[0], options.tile[1]};
  out.mipmap = options.mipmap;
  out.durable = options.fsync;
  if (options.pixel) out.pixel = *options.pixel;
  out.nonfinite = options.nonfinite;
  if (!options.compression.empty()) out.compression = take(Compression::parse(options.compression));
}

Result<Bands> bands_of(const std::string& text) {
  const auto count = parse_count(text);
  if (!count) return find_bands(text);
  // As many bands over 400 to 700 nm, or a little less where the step would not be a short number.
  constexpr std::size_t kRangeNm = 300;
  std::string example = "400:700:5";
  if (*count > 0 && *count <= kRangeNm) {
    const std::size_t whole = kRangeNm / *count;
    const bool exact = kRangeNm * 100 % *count == 0;
    example = exact
                  ? fmt::format("400:700:{:.4g}", static_cast<double>(kRangeNm) / static_cast<double>(*count))
                  : fmt::format("400:{}:{}", 400 + whole * *count, whole);
  }
  constexpr std::size_t kMinPlanned = 3;
  constexpr std::size_t kMaxPlanned = 64;
  const bool planned = *count >= kMinPlanned && *count <= kMaxPlanned;
  return Error{
      ErrorCode::kBadArgument,
      fmt::format("--bands {} is a wavelength alone; for {} give FIRST:LAST:STEP in nm, such as {}{}", text,
                  plural(*count, "band"), example,
                  planned ? fmt::format(", or a plan (spectile plan --count {})", *count) : "")};
}

Option add_observer_option(const Command& command, Observer& observer, const char* flag) {
  return command.choice(flag, observer, kObservers, kColorGroup,
                        "Standard observer: 1931 (2 degree) or 1964 (10 degree)");
}

void add_adapt_option(const Command& command, Adaptation& adaptation) {
  command.choice("--adapt", adaptation, kAdaptations, kColorGroup,
                 "Chromatic adaptation from the illuminant to D65: none, bradford or cat16");
}

void add_target_options(const Command& command, ColorTarget& target, Adaptation& adaptation) {
  command.choice("--to", target, kTargets, kColorGroup,
                 "srgb (linear, white D65), xyz or luminance (channel Y)");
  add_adapt_option(command, adaptation);
}

}  // namespace spectile::cli
