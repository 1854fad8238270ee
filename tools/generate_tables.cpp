// Writes the tables in src/data that this project computes itself. usage: spectile_generate_tables FOLDER
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <spectile/spectra/measured_spectrum.hpp>
#include <string>

#include "src/upsampling/exact_basis.hpp"
#include "src/upsampling/sigmoid_model.hpp"

namespace {

using namespace spectile;

// Nodes of the start table along each axis: enough that the double search from the nearest one always
// arrives.
constexpr int kStartSteps = 6;

std::string table(const std::string& name, const BasisTable& rows) {
  std::string out = fmt::format("constexpr double {}[][7] = {{\n", name);
  for (const auto& row : rows) {
    out += "    {";
    for (std::size_t k = 0; k < 7; ++k) out += fmt::format("{}{}", k == 0 ? "" : ", ", row[k]);
    out += "},\n";
  }
  return out + "};\n";
}

std::string list(const std::string& name, const std::vector<double>& values) {
  std::string out = fmt::format("constexpr double {}[] = {{\n", name);
  std::string line = "   ";
  for (const double v : values) {
    const std::string text = fmt::format(" {:.6g},", v);
    if (line.size() + text.size() > 110) {
      out += line + "\n";
      line = "   ";
    }
    line += text;
  }
  return out + line + "\n};\n";
}

std::string file(const std::string& purpose, const std::string& tables, const std::string& definitions) {
  return purpose +
         "// Computed by tools/generate_tables.cpp; do not edit.\n"
         "#include \"src/data/tables.hpp\"\n\nnamespace spectile::data {\nnamespace {\n\n// clang-format "
         "off\n" +
         tables + "// clang-format on\n\n}  // namespace\n\n" + definitions +
         "\n}  // namespace spectile::data\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: {} FOLDER\n", argv[0]);
    return 2;
  }
  const Bands bands;
  const auto space = working_space(bands, false, kRec709, *illuminant("D65"), Observer::kCie1931);
  const auto exact = smoothest_basis(bands, *space);
  const auto primaries = primary_decomposition(bands, *space);
  if (!exact || !primaries) {
    fmt::print(stderr, "no basis spectra found\n");
    return 1;
  }
  const std::string folder = argv[1];
  std::ofstream(folder + "/exact_bases.cpp") << file(
      "// Basis spectra whose colours are exactly the corners of the sRGB cube, for 400:700:5, D65, CIE "
      "1931:\n"
      "// the smoothest ones, and those of Mallett and Yuksel made exact.\n",
      table("kSmoothest", *exact) + "\n" + table("kPrimaries", *primaries),
      "const BasisRows kSmitsExact = kSmoothest;\nconst BasisRows kMallettExact = kPrimaries;\n");
  std::ofstream(folder + "/sigmoid_start.cpp") << file(
      "// Coefficients of the sigmoids of sRGB colours on a grid: where the search for others starts.\n",
      list("kNodes", sigmoid_start_nodes(bands, *space, kStartSteps)),
      fmt::format("const SigmoidStart kSigmoidStart = {{{}, kNodes}};\n", kStartSteps));
  return 0;
}
