// spectile verify: kernels against reference and oracle on a file.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "src/cli/common.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  Common common;
  std::vector<std::string> inputs;
  std::string method = "smits";
  std::string quantity = "reflectance";
  std::string bands = "400:700:5";
  std::string layer;
};

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  UpsampleImageOptions options;
  options.threads = a.common.threads;
  options.layer = a.layer;
  const auto method = parse_method(a.method);
  if (!method) return complain(method.error());
  options.method = *method;
  const auto quantity = parse_quantity(a.quantity);
  if (!quantity) return complain(quantity.error());
  options.quantity = *quantity;
  const auto bands = Bands::parse(a.bands);
  if (!bands) return complain(bands.error());
  options.bands = *bands;
  int exit = kOk;
  for (const std::string& input : a.inputs) {
    const auto report = verify_image(input, options);
    if (!report) {
      exit = std::max(exit, complain(report.error()));
      continue;
    }
    if (!report->ok()) exit = std::max<int>(exit, kBadInput);
    if (a.common.json) {
      const nlohmann::json out = {{"input", input},
                                  {"isa", report->isa},
                                  {"what", report->what},
                                  {"pixels", report->pixels},
                                  {"samples", report->samples},
                                  {"different_samples", report->different_samples},
                                  {"max_kernel_difference", report->max_kernel_difference},
                                  {"max_oracle_difference", report->max_oracle_difference},
                                  {"oracle_bound", report->oracle_bound},
                                  {"ok", report->ok()}};
      fmt::print("{}\n", out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    } else if (!a.common.quiet) {
      fmt::print("{}: {}, {} pixels: {}\n", input, report->what, report->pixels,
                 report->ok() ? "ok" : "DIFFERENT");
      fmt::print("  {} kernels against reference: {} of {} samples differ, by {:.3g} at most\n", report->isa,
                 report->different_samples, report->samples, report->max_kernel_difference);
      fmt::print("  reference against double: relative difference {:.3g} at most, bound {:.3g}\n",
                 report->max_oracle_difference, report->oracle_bound);
    }
  }
  return exit;
}

}  // namespace

void add_verify(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "verify", "Run kernels, scalar reference and double oracle on every pixel of an image and compare");
  command->add_option("IN", a->inputs, "RGB or spectral OpenEXR images")->required();
  command->add_option("--method", a->method, "smits or smits1999")
      ->check(CLI::IsMember({"smits", "smits1999"}))
      ->capture_default_str();
  command->add_option("--quantity", a->quantity, "reflectance or illuminant")
      ->check(CLI::IsMember({"reflectance", "illuminant"}))
      ->capture_default_str();
  command->add_option("--bands", a->bands, "FIRST:LAST:STEP in nm, or a list of centres")
      ->capture_default_str();
  command->add_option("--layer", a->layer, "Layer, view or part to take R, G, B from");
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
