// spectile plan: chooses the few wavelengths or bands that a scene needs.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include "src/cli/commands.hpp"
#include "src/cli/options/method_options.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

enum class Samples { kBands, kApart, kPoints };

constexpr Choice<Samples> kSamples[] = {
    {"bands", Samples::kBands}, {"apart", Samples::kApart}, {"points", Samples::kPoints}};

struct PlanArguments {
  Common common;
  std::vector<std::string> lights;
  std::vector<std::string> reflectances;
  std::vector<std::string> textures;
  std::size_t colors = 128;
  std::string method = std::string(to_string(kDefaultMethod));
  std::string input_space;
  ChannelArguments channels;
  NonFinite nonfinite = NonFinite::kStop;
  std::optional<int> bounces;
  Samples sample = Samples::kBands;
  std::optional<std::size_t> count;
  std::optional<double> max_error;
  Observer observer = Observer::kCie1931;
  int folds = PlannerOptions().folds;
  std::string output;
  SpectrumArguments spectra;
  std::optional<Ends> reflectance_ends;
};

/// Input of the planner, and its description.
struct Scene {
  PlannerOptions options;
  std::string from;                  ///< "24 reflectances and 128 colours of 1 texture"
  std::vector<std::string> notes;    ///< on files of spectra
  std::vector<std::string> assumed;  ///< notes on textures and bounces
};

/// Throws: Stop.
void add_lights(const PlanArguments& a, Scene& scene) {
  PlannerOptions& out = scene.options;
  SpectrumFileOptions options = file_options(a.spectra);
  options.one.reset();  // of reflectances
  for (const std::string& text : a.lights) {
    NamedLight named = take(find_light(text, options));
    scene.notes.insert(scene.notes.end(), named.notes.begin(), named.notes.end());
    for (const NamedLight& other : out.lights) {
      if (other.name == named.name)
        throw Stop(complain_usage(fmt::format("two illuminants are called {}", other.name)));
    }
    out.lights.push_back(std::move(named));
  }
}

/// Reflectances for scenes of which nothing is known: the 24 patches of the ColorChecker and a grid of sRGB.
/// Throws: Stop.
std::vector<Spectrum> default_reflectances() {
  std::vector<Spectrum> out;
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind != "reflectance") continue;
    out.push_back(take(named_spectrum(info.name)));
  }
  const Bands bands = take(Bands::uniform(kFirstVisibleNm, kLastVisibleNm, 5));
  const Upsampler upsampler = take(Upsampler::create(Method::kSigmoid, Quantity::kReflectance, bands));
  constexpr int kSide = 4;
  for (int i = 1; i < kSide * kSide * kSide; ++i) {  // 0 is black
    const auto step = [](int n) { return static_cast<double>(n % kSide) / (kSide - 1); };
    out.emplace_back(
        take(rgb_albedo_spectrum(upsampler, {step(i), step(i / kSide), step(i / kSide / kSide)})));
  }
  return out;
}

/// Throws: Stop.
void add_textures(const PlanArguments& a, Scene& scene) {
  std::vector<Spectrum>& out = scene.options.reflectances;
  MethodOptions options;
  options.threads = a.common.threads;
  options.channels = channel_choice(a.channels);
  options.nonfinite = a.nonfinite;
  options.method = take(parse_method(a.method));
  options.input_space = space_of(a.input_space);
  for (const std::string& texture : a.textures) {
    options.progress =
        progress_bar(std::filesystem::path(texture).filename().string(), a.common.shows_text());
    std::vector<std::string> notes;
    auto result = texture_reflectances(texture, a.colors, options, &notes);
    options.progress = nullptr;  // clears the bar
    const std::vector<Spectrum> colors = take(std::move(result));
    out.insert(out.end(), colors.begin(), colors.end());
    scene.assumed.insert(scene.assumed.end(), notes.begin(), notes.end());
  }
}

/// Throws: Stop.
void add_reflectances(const PlanArguments& a, Scene& out) {
  auto& all = out.options.reflectances;
  SpectrumFileOptions options = file_options(a.spectra);
  options.ends = a.reflectance_ends;
  for (const std::string& text : a.reflectances) {
    const SpectrumTable some = take(find_reflectances(text, options));
    all.insert(all.end(), some.spectra.begin(), some.spectra.end());
    out.notes.insert(out.notes.end(), some.notes.begin(), some.notes.end());
  }
  const std::size_t measured = all.size();
  add_textures(a, out);
  if (a.reflectances.empty() && a.textures.empty()) {
    all = default_reflectances();
    out.from = "the ColorChecker and a grid of sRGB";
  } else if (a.textures.empty()) {
    out.from = fmt::format("{} reflectances", measured);
  } else if (measured == 0) {
    out.from = fmt::format("{} colours of textures", all.size());
  } else {
    out.from = fmt::format("{} reflectances and {} colours of textures", measured, all.size() - measured);
  }
}

void print_errors(const ColorError& e) {
  print(" {:>7.3f} {:>7.3f} {:>7.3f}", e.mean, e.percentile95, e.maximum);
}

void print_report(const Plan& plan, const Scene& scene, double seconds, const std::string& output) {
  print("{}: {} wavelengths, {:.1f} s, planned for {}\n", output, plan.count(), seconds, scene.from);
  std::string list;
  for (const double nm : plan.wavelengths_nm) list += fmt::format(" {:.1f}", nm);
  print(" {} nm\n", list);
  Notes().print(scene.assumed);
  if (plan.report.errors.empty()) {
    print("  no cross-validated error, as there was no cross-validation\n");
    return;
  }
  print("  {:<54} {:>7} {:>7} {:>7}\n", "CIEDE2000, cross-validated", "mean", "95 %", "maximum");
  for (const CrossValidatedError& e : plan.report.errors) {
    const std::string bounces = plural(static_cast<std::uint64_t>(e.bounces), "bounce");
    print("  {:<54}", fmt::format("under {}, {}", e.light, bounces));
    print_errors(e.error);
    print("\n");
    for (const EvenBandsError& even : plan.report.even_bands) {
      if (even.light != e.light || even.bounces != e.bounces) continue;
      const bool projected = even.sums == EvenBandsSums::kAsProjected;
      print("  {:<54}", projected ? "  even bands " + even.bands + ", as projected"
                                  : "    " + even.bands + ", averages multiplied");
      print_errors(even.error);
      print("\n");
    }
  }
}

int run_plan(const PlanArguments& a) {
  apply_common(a.common);
  if (a.count.has_value() == a.max_error.has_value())
    return complain_usage("give either --count or --max-error");
  std::vector<NamedFile> read = named_files(a.lights, kIlluminantRole);
  for (NamedFile& file : named_files(a.reflectances, kReflectancesRole)) read.push_back(std::move(file));
  read = files_among(read);
  for (NamedFile& file : named_files(a.textures, "a texture (--texture)")) read.push_back(std::move(file));
  check_outputs({{a.output, kOutputRole}}, read);
  catch_signals();
  Scene scene;
  PlannerOptions& o = scene.options;
  o.bounces = a.bounces.value_or(1);
  o.sampling = a.sample == Samples::kPoints ? BandSampling::kPoints : BandSampling::kAverages;
  o.apart = a.sample == Samples::kApart;
  o.bands = a.count;
  o.max_error = a.max_error;
  o.observer = a.observer;
  o.folds = a.folds;
  o.go_on = [] { return !interrupted(); };
  add_lights(a, scene);
  add_reflectances(a, scene);
  if (!a.bounces) {
    scene.assumed.emplace_back(
        "assumed that light meets one material; errors are larger where it meets more (--bounces 2)");
  }
  print_notes(a.common, scene.notes);
  const auto start = std::chrono::steady_clock::now();
  const auto plan = make_plan(o);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (!plan) {
    // A maximum error that the scene does not allow is not wrong usage.
    if (plan.error().code != ErrorCode::kUnavailable) return complain(plan.error());
    complain(plan.error());
    return kBadInput;
  }
  if (interrupted()) return complain({ErrorCode::kCancelled, "stopped on request"});
  take(save_plan(*plan, a.output));
  if (a.common.json) {
    auto json = nlohmann::ordered_json::parse(plan_to_json(*plan));
    std::vector<std::string> notes = scene.notes;
    notes.insert(notes.end(), scene.assumed.begin(), scene.assumed.end());
    if (!notes.empty()) json["notes"] = notes;
    print_verbatim(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  } else if (!a.common.quiet) {
    print_report(*plan, scene, seconds.count(), a.output);
  }
  return kOk;
}

}  // namespace

void add_plan(const Command& app, int& exit) {
  const auto [command, a] = add_subcommand(
      app, "plan", "Choose the few wavelengths or bands that a scene's colours need", run_plan, exit);
  command.output_file("-o,--output", a->output, kFilesGroup, "Plan to write, as JSON").required();
  command.option("--reflectances", a->reflectances, "FILE", kFilesGroup,
                 "Reflectances of the scene: files, or names of spectra; a general set by default");
  command.option("--texture", a->textures, "FILE", kFilesGroup,
                 "RGB OpenEXR images whose colours the scene holds");
  command.option("--colors", a->colors, "N", kFilesGroup, "Largest number of colours taken from a texture")
      .range(1, 4096)
      .show_default();
  add_nonfinite_option(command, a->nonfinite, "the pixel is left out");
  command
      .option("--illuminant", a->lights, "SPECTRUM", kColorGroup,
              "Illuminant of the scene; repeat it for several, which share the wavelengths")
      .required();
  add_spectrum_options(command, a->spectra);
  add_ends_option(command, a->reflectance_ends, "--reflectance-ends",
                  "Reflectances beyond their data: zero, or held; held by default");
  add_values_option(command, a->spectra);
  add_observer_option(command, a->observer);
  add_method_option(command, a->method);
  add_rgb_input_options(command, a->input_space, a->channels);
  command
      .option("--bounces", a->bounces, "N", kColorGroup,
              "Reflections that must keep their colour, 1 to 4; 1 by default")
      .range(1, 4);
  command.option("--count", a->count, "N", kBandsGroup, "Number of bands, 3 to 64").range(3, 64);
  // Its name until 0.1; elsewhere --bands is a list or a plan.
  command.option("--bands", a->count, "N", kBandsGroup, "").range(3, 64).hidden();
  command.option("--max-error", a->max_error, "CIEDE2000", kBandsGroup,
                 "Instead: the smallest number that meets this maximum error");
  command.choice("--sample", a->sample, kSamples, kBandsGroup,
                 "bands (averages that may overlap), apart, or points (values at wavelengths)");
  command
      .option("--folds", a->folds, "N", kBandsGroup,
              "Folds of the cross-validation; 0: none, which is quicker")
      .range(0, 1000)
      .show_default();
  add_common(command, a->common,
             "spectile plan --illuminant D65 --texture wood.exr --count 7 -o plan.json\n" + kSpectrumHelp);
}

}  // namespace spectile::cli
