// spectile plan: chooses the few wavelengths or bands that a scene needs.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "src/cli/commands.hpp"
#include "src/cli/jobs.hpp"
#include "src/cli/options/method_options.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

constexpr const char* kName = "plan";
constexpr Choice<BandSampling> kSamplings[] = {{"points", BandSampling::kPoints},
                                               {"bands", BandSampling::kAverages}};

struct Arguments {
  Common common;
  std::vector<std::string> lights;
  std::vector<std::string> reflectances;
  std::vector<std::string> textures;
  std::size_t colors = 128;
  std::string method = std::string(to_string(kDefaultMethod));
  std::string input_space;
  std::string layer;
  NonFinite nonfinite = NonFinite::kStop;
  int bounces = 1;
  BandSampling sample = BandSampling::kPoints;
  std::optional<std::size_t> bands;
  std::optional<double> max_error;
  Observer observer = Observer::kCie1931;
  int folds = PlannerOptions().folds;
  std::string output;
};

/// Input of the planner, and its description.
struct Scene {
  PlannerOptions options;
  std::string from;  ///< "24 reflectances and 128 colours of 1 texture"
};

int add_lights(const Arguments& a, PlannerOptions& out) {
  for (const std::string& text : a.lights) {
    auto named = find_light(text);
    if (!named) return complain(named.error());
    for (const NamedLight& other : out.lights) {
      if (other.name == named->name)
        return complain_usage(fmt::format("two illuminants are called {}", other.name), kName);
    }
    out.lights.push_back(*std::move(named));
  }
  return kOk;
}

/// All spectra of a file, or one by its name.
Result<std::vector<Spectrum>> reflectances_of(const std::string& text) {
  auto named = find_spectrum(text);
  if (named && named_spectrum(text)) return std::vector<Spectrum>{*std::move(named)};
  if (!named && named.error().code == ErrorCode::kUnknownName) return named.error();
  return load_spectra(text);
}

/// Reflectances for scenes of which nothing is known: the 24 patches of the ColorChecker and a grid of sRGB.
Result<std::vector<Spectrum>> default_reflectances() {
  std::vector<Spectrum> out;
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind != "reflectance") continue;
    auto patch = named_spectrum(info.name);
    if (!patch) return patch.error();
    out.push_back(*std::move(patch));
  }
  const auto bands = Bands::uniform(kFirstVisibleNm, kLastVisibleNm, 5);
  if (!bands) return bands.error();
  const auto upsampler = Upsampler::create(Method::kSigmoid, Quantity::kReflectance, *bands);
  if (!upsampler) return upsampler.error();
  constexpr int kSide = 4;
  for (int i = 1; i < kSide * kSide * kSide; ++i) {  // 0 is black
    const auto step = [](int n) { return static_cast<double>(n % kSide) / (kSide - 1); };
    auto color = rgb_albedo_spectrum(*upsampler, {step(i), step(i / kSide), step(i / kSide / kSide)});
    if (!color) return color.error();
    out.emplace_back(*std::move(color));
  }
  return out;
}

int add_textures(const Arguments& a, std::vector<Spectrum>& out) {
  MethodOptions options;
  options.threads = a.common.threads;
  options.layer = a.layer;
  options.nonfinite = a.nonfinite;
  if (const int bad = take(parse_method(a.method), options.method)) return bad;
  if (const int bad = take_space(a.input_space, options.input_space)) return bad;
  for (const std::string& texture : a.textures) {
    options.progress =
        progress_bar(std::filesystem::path(texture).filename().string(), a.common.shows_text());
    auto colors = texture_reflectances(texture, a.colors, options);
    options.progress = nullptr;
    if (!colors) return complain(colors.error());
    out.insert(out.end(), colors->begin(), colors->end());
  }
  return kOk;
}

int add_reflectances(const Arguments& a, Scene& out) {
  auto& all = out.options.reflectances;
  for (const std::string& text : a.reflectances) {
    auto some = reflectances_of(text);
    if (!some) return complain(some.error());
    all.insert(all.end(), some->begin(), some->end());
  }
  const std::size_t measured = all.size();
  if (const int bad = add_textures(a, all)) return bad;
  if (a.reflectances.empty() && a.textures.empty()) {
    auto defaults = default_reflectances();
    if (!defaults) return complain(defaults.error());
    all = *std::move(defaults);
    out.from = "the ColorChecker and a grid of sRGB";
  } else if (a.textures.empty()) {
    out.from = fmt::format("{} reflectances", measured);
  } else if (measured == 0) {
    out.from = fmt::format("{} colours of textures", all.size());
  } else {
    out.from = fmt::format("{} reflectances and {} colours of textures", measured, all.size() - measured);
  }
  return kOk;
}

void print_errors(const ColorError& e) {
  fmt::print(" {:>7.3f} {:>7.3f} {:>7.3f}", e.mean, e.percentile95, e.maximum);
}

void print_report(const Plan& plan, const Scene& scene, double seconds, const std::string& output) {
  fmt::print("{}: {} wavelengths, {:.1f} s, planned for {}\n", output, plan.count(), seconds, scene.from);
  std::string list;
  for (const double nm : plan.wavelengths_nm) list += fmt::format(" {:.1f}", nm);
  fmt::print(" {} nm\n", list);
  if (plan.report.errors.empty()) {
    fmt::print("  no cross-validated error, as there was no cross-validation\n");
    return;
  }
  fmt::print("  {:<40} {:>7} {:>7} {:>7}\n", "CIEDE2000, cross-validated", "mean", "95 %", "maximum");
  for (const CrossValidatedError& e : plan.report.errors) {
    const std::string bounces = plural(static_cast<std::uint64_t>(e.bounces), "bounce");
    fmt::print("  {:<40}", fmt::format("under {}, {}", e.light, bounces));
    print_errors(e.error);
    fmt::print("\n");
    for (const EvenBandsError& even : plan.report.even_bands) {
      if (even.light != e.light || even.bounces != e.bounces) continue;
      fmt::print("  {:<40}", "  even bands " + even.bands);
      print_errors(even.error);
      fmt::print("\n");
    }
  }
}

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  if (a.bands.has_value() == a.max_error.has_value())
    return complain_usage("give either --bands or --max-error", kName);
  for (const auto* const files : {&a.lights, &a.reflectances, &a.textures}) {
    if (const auto good = check_output(a.output, *files); !good) return complain(good.error());
  }
  catch_signals();
  Scene scene;
  PlannerOptions& o = scene.options;
  o.bounces = a.bounces;
  o.sampling = a.sample;
  o.bands = a.bands;
  o.max_error = a.max_error;
  o.observer = a.observer;
  o.folds = a.folds;
  if (const int bad = add_lights(a, o)) return bad;
  if (const int bad = add_reflectances(a, scene)) return bad;
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
  if (const auto saved = save_plan(*plan, a.output); !saved) return complain(saved.error());
  if (a.common.json) {
    fmt::print("{}\n", nlohmann::ordered_json::parse(plan_to_json(*plan)).dump());
  } else if (!a.common.quiet) {
    print_report(*plan, scene, seconds.count(), a.output);
  }
  return kOk;
}

}  // namespace

void add_plan(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("plan", "Choose the few wavelengths or bands that a scene's colours need");
  const auto option = [command](const char* flag, auto& value, const char* type, const char* group,
                                const char* text) {
    return command->add_option(flag, value, text)->type_name(type)->group(group);
  };
  option("-o,--output", a->output, "FILE", kFilesGroup, "Plan to write, as JSON")->required();
  option("--reflectances", a->reflectances, "FILE", kFilesGroup,
         "Reflectances of the scene: files, or names of spectra; a general set by default");
  option("--texture", a->textures, "FILE", kFilesGroup, "RGB OpenEXR images whose colours the scene holds");
  option("--colors", a->colors, "N", kFilesGroup, "Largest number of colours taken from a texture")
      ->check(CLI::Range(std::size_t{1}, std::size_t{4096}).description(""))
      ->capture_default_str();
  add_nonfinite_option(*command, a->nonfinite, "the pixel is left out");
  option("--illuminant", a->lights, "SPECTRUM", kColorGroup,
         "Illuminant of the scene; repeat it for several, which share the wavelengths")
      ->required();
  add_observer_option(*command, a->observer);
  add_method_option(*command, a->method);
  add_rgb_input_options(*command, a->input_space, a->layer);
  option("--bounces", a->bounces, "N", kColorGroup, "Reflections that must keep their colour, 1 to 4")
      ->check(CLI::Range(1, 4).description(""))
      ->capture_default_str();
  option("--bands", a->bands, "N", kBandsGroup, "Number of wavelengths, 3 to 64")
      ->check(CLI::Range(std::size_t{3}, std::size_t{64}).description(""));
  option("--max-error", a->max_error, "CIEDE2000", kBandsGroup,
         "Instead: the smallest number that meets this maximum error");
  add_choice(*command, "--sample", a->sample, kSamplings,
             "points (values at wavelengths), or bands (averages, as upsample writes)")
      ->group(kBandsGroup);
  option("--folds", a->folds, "N", kBandsGroup, "Folds of the cross-validation; 0: none, which is quicker")
      ->check(CLI::Range(0, 1000).description(""))
      ->capture_default_str();
  add_common(
      *command, a->common,
      std::string(
          "spectile plan --illuminant D65 --texture wood.exr --bands 7 --sample bands -o plan.json\n") +
          kSpectrumHelp);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
