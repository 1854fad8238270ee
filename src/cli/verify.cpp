// spectile verify: kernels against reference and oracle on a file.
#include <fmt/format.h>

#include <algorithm>

#include "src/cli/commands.hpp"
#include "src/cli/options/method_options.hpp"
#include "src/cli/output/print.hpp"

namespace spectile::cli {
namespace {

struct VerifyArguments {
  Common common;
  std::vector<std::string> inputs;
  MethodArguments method;
};

int run_verify(const VerifyArguments& a) {
  apply_common(a.common);
  MethodOptions options;
  options.threads = a.common.threads;
  apply_method_options(a.method, options);
  const std::vector<std::string> light_notes =
      options.light ? options.light->notes : std::vector<std::string>();
  print_notes(a.common, light_notes);
  int exit = kOk;
  Notes notes;
  for (const std::string& input : a.inputs) {
    const auto report = verify_image(input, options);
    if (!report) {
      exit = std::max(exit, complain(with_light(report.error(), a.method.bands, a.method.white)));
      continue;
    }
    if (!report->ok()) exit = std::max<int>(exit, kBadInput);
    if (a.common.json) {
      std::vector<std::string> all = light_notes;
      all.insert(all.end(), report->notes.begin(), report->notes.end());
      print_json({{"input", input},
                  {"isa", report->isa},
                  {"what", report->what},
                  {"pixels", report->pixels},
                  {"samples", report->samples},
                  {"different_samples", report->different_samples},
                  {"max_kernel_difference", report->max_kernel_difference},
                  {"max_oracle_difference", report->max_oracle_difference},
                  {"oracle_bound", report->oracle_bound},
                  {"notes", all},
                  {"ok", report->ok()}});
    } else if (!a.common.quiet) {
      print("{}: {}, {} pixels: {}\n", input, report->what, report->pixels,
            report->ok() ? "ok" : "DIFFERENT");
      print("  {} kernels against reference: {} of {} samples differ, by {:.3g} at most\n", report->isa,
            report->different_samples, report->samples, report->max_kernel_difference);
      print("  reference against double: relative difference {:.3g} at most, bound {:.3g}\n",
            report->max_oracle_difference, report->oracle_bound);
      notes.print(report->notes);
    }
  }
  return exit;
}

}  // namespace

void add_verify(const Command& app, int& exit) {
  const auto [command, a] = add_subcommand(
      app, "verify", "Compare kernels, scalar reference and double oracle on every pixel", run_verify, exit);
  command.positional("IN", a->inputs, "RGB or spectral OpenEXR images").required();
  add_method_options(command, a->method);
  add_alpha_option(command, a->method);
  add_common(command, a->common, "spectile verify wood.exr --method sigmoid\n" + kSpectrumHelp);
}

}  // namespace spectile::cli
