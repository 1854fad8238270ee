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

/// A light: whatever find_spectrum() takes. Beyond a table's samples it has the value of the nearest one;
/// formulas are tabulated at tabulated_nm(), beyond which the same holds.
Result<NamedLight> load_light(const std::string& text);

/// Where formulas become tables: every nanometre from 300 to 830.
std::vector<double> tabulated_nm();

/// "a spectrum as spectile spectra takes it: ...".
std::string light_help();

/// none, bradford or cat16.
Adaptation adaptation_of(const std::string& text);
void add_adaptation_option(CLI::App& command, std::string& text);

}  // namespace spectile::cli
