// spectile upsample: RGB images to spectral ones.
#include <memory>

#include "src/cli/common.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  Common common;
  WriteOptions write;
  std::vector<std::string> inputs;
  std::string output;
  std::string method = "smits";
  std::string quantity = "reflectance";
  std::string bands = "400:700:5";
  std::string negative = "clip";
  std::string layer;
};

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  UpsampleImageOptions options;
  if (const int bad = apply_write_options(a.write, a.common, options)) return bad;
  const auto method = parse_method(a.method);
  if (!method) return complain(method.error());
  options.method = *method;
  const auto quantity = parse_quantity(a.quantity);
  if (!quantity) return complain(quantity.error());
  options.quantity = *quantity;
  const auto bands = Bands::parse(a.bands);
  if (!bands) return complain(bands.error());
  options.bands = *bands;
  options.negative = a.negative == "keep"   ? Negative::kKeep
                     : a.negative == "stop" ? Negative::kStop
                                            : Negative::kClip;
  options.layer = a.layer;
  std::vector<Job> jobs;
  if (const int bad = plan_jobs(a.inputs, a.output, jobs)) return bad;
  return run_jobs(jobs, a.common, options,
                  [&](const Job& job) { return upsample_image(job.input, job.output, options); });
}

}  // namespace

void add_upsample(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("upsample", "Turn RGB images into spectral ones");
  command->add_option("IN", a->inputs, "RGB OpenEXR images: half, float or uint, scanline or tiled")
      ->required();
  command->add_option("-o,--output", a->output, "File, or directory for several inputs")->required();
  command
      ->add_option("--method", a->method,
                   "smits: 32-sample basis spectra; smits1999: the ten samples of the paper")
      ->check(CLI::IsMember({"smits", "smits1999"}))
      ->capture_default_str();
  command
      ->add_option("--quantity", a->quantity,
                   "reflectance (channels T.*nm) or illuminant: emitted light (channels S0.*nm)")
      ->check(CLI::IsMember({"reflectance", "illuminant"}))
      ->capture_default_str();
  command
      ->add_option(
          "--bands", a->bands,
          "FIRST:LAST:STEP in nm, or a list of centres. The default cuts off what the eye sees beyond it: "
          "a mean error of 0.29 CIEDE2000 under D65, against 0.03 for 380:780:5")
      ->capture_default_str();
  command
      ->add_option(
          "--negative", a->negative,
          "Components below 0, as colours outside sRGB have: clip to 0, keep (samples may fall below 0 "
          "too) or stop")
      ->check(CLI::IsMember({"clip", "keep", "stop"}))
      ->capture_default_str();
  command->add_option("--layer", a->layer, "Layer, view or part to take R, G, B from");
  add_write_options(*command, a->write, "half");
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
