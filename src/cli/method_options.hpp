// Options by which colours become spectra, common to upsample, relight and verify.
#pragma once

#include <string>

#include "src/cli/common.hpp"

namespace spectile::cli {

/// As given on the command line.
struct MethodArguments {
  std::string method = std::string(to_string(kDefaultMethod));
  std::string quantity = "reflectance";
  std::string bands = "400:700:5";
  std::string light;
  std::string observer = "1931";
  std::string input_space;
  std::string negative = "gamut";
  std::string out_of_gamut;
  std::string layer;
};

void add_method_options(CLI::App& command, MethodArguments& a);

/// Fills `out`; the exit code of what is wrong, after saying it.
int apply_method_options(const MethodArguments& a, MethodOptions& out);

/// A light by name, or from a file of wavelength,value lines where the text has a slash or a point in it or
/// names a file.
Result<NamedLight> load_light(const std::string& text);

/// "a file of wavelength,value lines, or one of A, C, ...".
std::string light_help();

/// none, bradford or cat16.
Adaptation adaptation_of(const std::string& text);
void add_adaptation_option(CLI::App& command, std::string& text);

}  // namespace spectile::cli
