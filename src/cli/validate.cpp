// spectile validate: files against the rules of the spectral layout.
#include <algorithm>

#include "src/cli/commands.hpp"
#include "src/cli/options/common_options.hpp"
#include "src/cli/output/print.hpp"

namespace spectile::cli {
namespace {

struct ValidateArguments {
  Common common;
  std::vector<std::string> inputs;
};

bool breaks_rules(const std::vector<LayoutFinding>& findings) {
  return !std::ranges::all_of(findings, &LayoutFinding::remark);
}

nlohmann::json findings_json(const std::string& input, const std::vector<LayoutFinding>& findings) {
  nlohmann::json out = {{"file", input},
                        {"follows_layout", !breaks_rules(findings)},
                        {"violations", nlohmann::json::array()},
                        {"remarks", nlohmann::json::array()}};
  for (const LayoutFinding& finding : findings) {
    out[finding.remark ? "remarks" : "violations"].push_back(
        {{"rule", finding.rule}, {"detail", finding.detail}});
  }
  return out;
}

void print_findings(const std::string& input, const std::vector<LayoutFinding>& findings) {
  for (const LayoutFinding& finding : findings) {
    print("{}: {}{}: {}\n", input, finding.remark ? "remark: " : "", finding.rule, finding.detail);
  }
  if (!breaks_rules(findings)) print("{}: follows the layout\n", input);
}

int run_validate(const ValidateArguments& a) {
  apply_common(a.common);
  int exit = kOk;
  for (const std::string& input : a.inputs) {
    const auto findings = validate_image(input, a.common.threads);
    if (!findings) {
      exit = std::max(exit, complain(findings.error()));
      if (a.common.json) print_json({{"file", input}, {"error", findings.error().message}});
      continue;
    }
    if (breaks_rules(*findings)) exit = std::max<int>(exit, kBadInput);
    if (a.common.json) {
      print_json(findings_json(input, *findings));
    } else if (!a.common.quiet) {
      print_findings(input, *findings);
    }
  }
  return exit;
}

}  // namespace

void add_validate(const Command& app, int& exit) {
  const auto [command, a] = add_subcommand(
      app, "validate", "Check images against the spectral layout; exit code 1 where one breaks it",
      run_validate, exit);
  command.positional("FILES", a->inputs, "OpenEXR images").required();
  add_common(command, a->common, "spectile validate render-s.exr");
}

}  // namespace spectile::cli
