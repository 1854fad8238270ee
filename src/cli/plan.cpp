// spectile plan: the few wavelengths that a scene needs.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "src/cli/common.hpp"
#include "src/cli/method_options.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  Common common;
  std::vector<std::string> lights;
  std::vector<std::string> reflectances;
  std::vector<std::string> textures;
  std::size_t colors = 128;
  std::string method = std::string(to_string(kDefaultMethod));
  std::string input_space;
  std::string layer;
  std::string nonfinite = "stop";
  int bounces = 1;
  std::string sample = "points";
  std::optional<std::size_t> bands;
  std::optional<double> max_error;
  std::string observer = "1931";
  int folds = PlannerOptions().folds;
  std::string output;
};

int usage(const std::string& what) {
  fmt::print(stderr, "spectile: {} (see spectile plan --help)\n", what);
  return kBadUsage;
}

/// What the planner is told, and how it is described.
struct Wanted {
  PlannerOptions options;
  std::string from;  ///< "24 reflectances and 128 colours of 1 texture"
};

int add_lights(const Arguments& a, PlannerOptions& out) {
  for (const std::string& text : a.lights) {
    auto named = load_light(text);
    if (!named) return complain(named.error());
    for (const PlannedLight& other : out.lights) {
      if (other.name == named->name) return usage(fmt::format("two lights are called {}", other.name));
    }
    out.lights.push_back({named->name, PiecewiseLinearSpectrum(std::move(named->spectrum))});
  }
  return kOk;
}

/// Every spectrum of a file, or one by its name.
Result<std::vector<Spectrum>> reflectances_of(const std::string& text) {
  auto named = find_spectrum(text);
  if (named && named_spectrum(text)) return std::vector<Spectrum>{*std::move(named)};
  if (!named && named.error().code == ErrorCode::kUnknownName) return named.error();
  return load_spectra(text);
}

/// The 24 patches of the ColorChecker, and colours all over sRGB, for scenes of which nothing is known.
Result<std::vector<Spectrum>> usual_reflectances() {
  std::vector<Spectrum> out;
  for (const NamedSpectrumInfo& info : named_spectra()) {
    if (info.kind != "reflectance") continue;
    auto patch = named_spectrum(info.name);
    if (!patch) return patch.error();
    out.push_back(*std::move(patch));
  }
  const auto bands = Bands::uniform(360, 830, 5);
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
  options.nonfinite = a.nonfinite == "zero" ? NonFinite::kZero : NonFinite::kStop;
  const auto method = parse_method(a.method);
  if (!method) return complain(method.error());
  options.method = *method;
  if (!a.input_space.empty()) {
    auto space = rgb_space(a.input_space);
    if (!space) return complain(space.error());
    options.input_space = *std::move(space);
  }
  for (const std::string& texture : a.textures) {
    options.progress =
        progress_bar(std::filesystem::path(texture).filename().string(), !a.common.quiet && !a.common.json);
    auto colors = texture_reflectances(texture, a.colors, options);
    options.progress = nullptr;
    if (!colors) return complain(colors.error());
    out.insert(out.end(), colors->begin(), colors->end());
  }
  return kOk;
}

int add_reflectances(const Arguments& a, Wanted& out) {
  auto& all = out.options.reflectances;
  for (const std::string& text : a.reflectances) {
    auto some = reflectances_of(text);
    if (!some) return complain(some.error());
    all.insert(all.end(), some->begin(), some->end());
  }
  const std::size_t measured = all.size();
  if (const int bad = add_textures(a, all)) return bad;
  if (a.reflectances.empty() && a.textures.empty()) {
    auto usual = usual_reflectances();
    if (!usual) return complain(usual.error());
    all = *std::move(usual);
    out.from = "the ColorChecker and colours all over sRGB";
  } else if (a.textures.empty()) {
    out.from = fmt::format("{} reflectances", measured);
  } else if (measured == 0) {
    out.from = fmt::format("{} colours of textures", all.size());
  } else {
    out.from = fmt::format("{} reflectances and {} colours of textures", measured, all.size() - measured);
  }
  return kOk;
}

void print_errors(const PlanError& e) {
  fmt::print(" {:>7.3f} {:>7.3f} {:>7.3f}", e.mean, e.percentile95, e.maximum);
}

void print_report(const Plan& plan, const Wanted& wanted, double seconds, const std::string& output) {
  fmt::print("{}: {} wavelengths, {:.1f} s, made for {}\n", output, plan.count(), seconds, wanted.from);
  std::string list;
  for (const double nm : plan.wavelengths_nm) list += fmt::format(" {:.1f}", nm);
  fmt::print(" {} nm\n", list);
  if (plan.promises.empty()) {
    fmt::print("  no promise, as there was no cross-validation\n");
    return;
  }
  fmt::print("  {:<40} {:>7} {:>7} {:>7}\n", "CIEDE2000 over colours that took no part", "mean", "95 %",
             "maximum");
  for (const PlanPromise& p : plan.promises) {
    const std::string bounces = fmt::format("{} bounce{}", p.bounces, p.bounces == 1 ? "" : "s");
    fmt::print("  {:<40}", fmt::format("under {}, {}", p.light, bounces));
    print_errors(p.error);
    fmt::print("\n");
    for (const EvenBandsPromise& even : plan.even) {
      if (even.promise.light != p.light || even.promise.bounces != p.bounces) continue;
      fmt::print("  {:<40}", "  even bands " + even.bands);
      print_errors(even.promise.error);
      fmt::print("\n");
    }
  }
}

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  if (a.bands.has_value() == a.max_error.has_value()) return usage("give either --bands or --max-error");
  for (const auto* const files : {&a.lights, &a.reflectances, &a.textures}) {
    if (const auto good = check_output(a.output, *files); !good) return complain(good.error());
  }
  catch_signals();
  Wanted wanted;
  PlannerOptions& o = wanted.options;
  o.bounces = a.bounces;
  o.sampling = a.sample == "bands" ? PlanSampling::kBands : PlanSampling::kPoints;
  o.bands = a.bands;
  o.max_error = a.max_error;
  o.observer = a.observer == "1964" ? Observer::kCie1964 : Observer::kCie1931;
  o.folds = a.folds;
  if (const int bad = add_lights(a, o)) return bad;
  if (const int bad = add_reflectances(a, wanted)) return bad;
  const auto start = std::chrono::steady_clock::now();
  const auto plan = make_plan(o);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (!plan) {
    // An error that cannot be met is no wrong usage: the scene does not allow it.
    if (plan.error().code != ErrorCode::kUnavailable) return complain(plan.error());
    complain(plan.error());
    return kBadInput;
  }
  if (interrupted()) return complain({ErrorCode::kCancelled, "stopped on request"});
  if (const auto saved = save_plan(*plan, a.output); !saved) return complain(saved.error());
  if (a.common.json) {
    fmt::print("{}\n", nlohmann::ordered_json::parse(plan_to_json(*plan)).dump());
  } else if (!a.common.quiet) {
    print_report(*plan, wanted, seconds.count(), a.output);
  }
  return kOk;
}

}  // namespace

void add_plan(CLI::App& app, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "plan", "Choose the few wavelengths that show a scene in the right colours under its lights");
  command
      ->add_option("--illuminant", a->lights,
                   "A light of the scene; repeat it for several, which then share wavelengths and sensor: " +
                       light_help())
      ->required();
  command->add_option("--reflectances", a->reflectances,
                      "What the scene holds: text files of measured reflectances, all of each, or names of "
                      "spectra. Without these and textures: the ColorChecker's patches and colours all over "
                      "sRGB");
  command->add_option("--texture", a->textures, "Or RGB OpenEXR images whose colours the scene holds");
  command->add_option("--colors", a->colors, "How many colours at most stand for those of one texture")
      ->check(CLI::Range(std::size_t{1}, std::size_t{4096}))
      ->capture_default_str();
  command->add_option("--method", a->method, "How the colours of textures become reflectances; see upsample")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  command->add_option("--input-space", a->input_space, "Space of the textures' RGB; see upsample")
      ->check(CLI::IsMember(rgb_space_names(), CLI::ignore_case));
  command->add_option("--layer", a->layer, "Layer, view or part of the textures to take R, G, B from");
  command
      ->add_option("--nonfinite", a->nonfinite,
                   "Pixels of textures with NaN or infinity: stop, or zero (they are left out)")
      ->check(CLI::IsMember({"stop", "zero"}))
      ->capture_default_str();
  command
      ->add_option("--bounces", a->bounces,
                   "Light that was reflected up to so many times, 1 to 4, keeps its colour too")
      ->check(CLI::Range(1, 4))
      ->capture_default_str();
  command
      ->add_option("--sample", a->sample,
                   "What a sample is: points, a reflectance's value at a wavelength, as renderers that trace "
                   "wavelengths take it; or bands, its average over a band, as upsample's files hold it, "
                   "which has half to a quarter of the error for light that is reflected once")
      ->check(CLI::IsMember({"points", "bands"}))
      ->capture_default_str();
  command->add_option("--bands", a->bands, "Choose so many wavelengths, 3 to 64")
      ->check(CLI::Range(std::size_t{3}, std::size_t{64}));
  command->add_option("--max-error", a->max_error,
                      "Or as few as keep the largest colour difference under every light, in CIEDE2000, "
                      "below this; 1 is just visible");
  command->add_option("--observer", a->observer, "Who sees it: 1931 (2 degree) or 1964 (10 degree)")
      ->check(CLI::IsMember({"1931", "1964"}))
      ->capture_default_str();
  command
      ->add_option("--folds", a->folds,
                   "Parts that the reflectances are divided into to promise an error: each part is judged by "
                   "a plan made from the others. 0 promises nothing and is quicker")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("-o,--output", a->output, "The plan, a JSON file")->required();
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
