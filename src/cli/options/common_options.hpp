// Options that several subcommands share: execution, files written, observer, adaptation, colour target.
#pragma once

#include <cstdint>
#include <optional>
#include <spectile/spectile.hpp>
#include <string>
#include <vector>

#include "src/cli/options/command.hpp"
#include "src/cli/output/messages.hpp"

namespace spectile::cli {

// Groups of options in the help, in their order.
inline constexpr const char* kFilesGroup = "Input and output";
inline constexpr const char* kColorGroup = "Colour";
inline constexpr const char* kBandsGroup = "Bands";
inline constexpr const char* kFormatGroup = "File format";
inline constexpr const char* kManyGroup = "Many images";
inline constexpr const char* kRunGroup = "Run";

inline constexpr Choice<Observer> kObservers[] = {{"1931", Observer::kCie1931}, {"1964", Observer::kCie1964}};
inline constexpr Choice<SampleType> kSampleTypes[] = {{"half", SampleType::kHalf},
                                                      {"float", SampleType::kFloat}};
inline constexpr Choice<NonFinite> kNonFinites[] = {
    {"error", NonFinite::kStop}, {"stop", NonFinite::kStop}, {"zero", NonFinite::kZero}};
inline constexpr Choice<ColorTarget> kTargets[] = {
    {"srgb", ColorTarget::kSrgb}, {"xyz", ColorTarget::kXyz}, {"luminance", ColorTarget::kLuminance}};
inline constexpr Choice<Adaptation> kAdaptations[] = {
    {"none", Adaptation::kNone}, {"bradford", Adaptation::kBradford}, {"cat16", Adaptation::kCat16}};

/// Options of every subcommand.
struct Common {
  int threads = 0;
  std::string isa;
  bool json = false;
  bool quiet = false;
  bool stats = false;  ///< True if the report says what was skipped.
  std::optional<double> max_memory_gb;
  std::uint64_t max_pixels = kDefaultMaxPixels;
  bool shows_text() const { return !json && !quiet; }
};

/// Adds the options of every subcommand and the example that ends its help.
void add_common(const Command& command, Common& common, const std::string& example);

/// Puts the common options in force. Throws: Stop.
void apply_common(const Common& common);

/// Which of a file's channels are read, as given on the command line.
struct ChannelArguments {
  std::string layer;
  std::string view;
  std::string part;
  std::string map;
};

/// Adds --layer, --view and --part.
void add_channel_options(const Command& command, ChannelArguments& channels);
/// Adds --channels.
void add_channel_map_option(const Command& command, ChannelArguments& channels);
/// Throws: Stop.
ChannelChoice channel_choice(const ChannelArguments& channels);

/// Options of what is written.
struct WriteOptions {
  std::optional<SampleType> pixel;
  std::string compression;
  NonFinite nonfinite = NonFinite::kStop;
  std::size_t lanes = 65536;
  std::vector<int> tile;  ///< width and height, or none
  bool mipmap = false;
  bool fsync = false;
};

/// Adds --depth, with its old name --pixel, --compression and --fsync.
void add_format_options(const Command& command, WriteOptions& options, const std::string& pixel_default);
/// Adds --nonfinite.
void add_nonfinite_option(const Command& command, NonFinite& nonfinite, const std::string& zero);
/// Adds --tile, --mipmap and --lanes.
void add_layout_options(const Command& command, WriteOptions& options);
/// Adds --compression of films.
void add_film_compression_option(const Command& command, std::string& compression);

/// Fills `out`. Throws: Stop.
void apply_write_options(const WriteOptions& options, const Common& common, ImageOptions& out);

/// Bands of the option --bands: those of find_bands(). A number alone is an error that says how to ask for so
/// many.
Result<Bands> bands_of(const std::string& text);

/// Adds an option of a standard observer.
Option add_observer_option(const Command& command, Observer& observer, const char* flag = "--observer");
/// Adds --adapt.
void add_adapt_option(const Command& command, Adaptation& adaptation);
/// Adds --to and --adapt.
void add_target_options(const Command& command, ColorTarget& target, Adaptation& adaptation);

/// "SPECTRUM: name, blackbody:KELVIN, ..." for the end of a help text.
inline const std::string kSpectrumHelp =
    "SPECTRUM: a name (see spectile spectra), blackbody:KELVIN, daylight:KELVIN, or FILE[:COLUMN] of\n"
    "spectra (docs/spectra-files.md).";

}  // namespace spectile::cli
