// Options by which colours become spectra, common to upsample, relight and verify.
#pragma once

#include <string>

#include "src/cli/options/spectrum_options.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/image_report.hpp"

namespace spectile::cli {

/// As given on the command line.
struct MethodArguments {
  std::string method = std::string(to_string(kDefaultMethod));
  Quantity quantity = Quantity::kReflectance;
  std::string bands = "400:700:5";
  std::string white;
  Observer white_observer = Observer::kCie1931;
  std::string nodes;
  std::string input_space;
  NegativeInput negative = NegativeInput::kGamut;
  std::optional<GamutPolicy> out_of_gamut;
  std::optional<AlphaMeaning> alpha;
  ChannelArguments channels;
  SpectrumArguments spectra;  ///< how --white, and a command's own illuminant, are read
};

void add_method_options(const Command& command, MethodArguments& a);

/// Adds --alpha.
void add_alpha_option(const Command& command, MethodArguments& a);

// Parts of them, for other commands that read RGB images.
void add_method_option(const Command& command, std::string& method);
void add_rgb_input_options(const Command& command, std::string& input_space, ChannelArguments& channels);
/// The RGB space of that name; none for an empty name. Throws: Stop.
std::optional<RgbSpace> space_of(const std::string& name);

/// Fills `out`. Throws: Stop.
void apply_method_options(const MethodArguments& a, MethodOptions& out);

/// The files that they name.
std::vector<NamedFile> method_files(const MethodArguments& a);
/// The handling of colours that the options lead to.
ColorHandling color_handling(const MethodOptions& options);

}  // namespace spectile::cli
