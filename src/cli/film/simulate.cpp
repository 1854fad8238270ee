// spectile film simulate: samples of a scene whose exact values are known, into a partial film.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>

#include "src/cli/commands.hpp"
#include "src/cli/options/common_options.hpp"
#include "src/cli/options/parse.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

constexpr Choice<WavelengthSampling> kSamplings[] = {{"visible", WavelengthSampling::kVisible},
                                                     {"uniform", WavelengthSampling::kUniform}};
constexpr Choice<FilmInput> kInputs[] = {{"wavelengths", FilmInput::kWavelengths},
                                         {"bands", FilmInput::kBands}};
constexpr Choice<PixelStatistics> kStatistics[] = {{"none", PixelStatistics::kNone},
                                                   {"counts", PixelStatistics::kCounts},
                                                   {"variance", PixelStatistics::kVariance}};

struct SimulateArguments {
  Common common;
  std::string output;
  std::string scene = "mixed";
  std::vector<int> size = {256, 256};
  std::uint64_t samples = 16;
  std::uint64_t seed = 1;
  std::string shard = "0/1";
  std::size_t wavelengths = 4;
  WavelengthSampling sampling = WavelengthSampling::kVisible;
  FilmInput input = FilmInput::kWavelengths;
  std::optional<std::string> bands;
  bool spectral = false;
  Observer observer = Observer::kCie1931;
  std::vector<std::string> sensors;
  std::string filter = "box";
  bool splat = false;
  std::string crop;
  PixelStatistics statistics = PixelStatistics::kNone;
  std::optional<float> maximum;
  int range = FilmOptions().range;
  std::string compression = "zip:1";
  std::string reference;
  std::string checkpoint;
  double every = 60;
};

/// Throws: Stop.
FilmOptions film_options(const SimulateArguments& a) {
  FilmOptions o;
  o.width = a.size[0];
  o.height = a.size[1];
  if (!a.crop.empty()) {
    const auto c = parse_integers<int>(a.crop, ',', 4);
    if (!c) throw Stop(complain_usage(fmt::format("--crop \"{}\" is not X0,Y0,X1,Y1", a.crop)));
    o.crop = PixelWindow{(*c)[0], (*c)[1], (*c)[2], (*c)[3]};
  }
  o.filter = take_usage(PixelFilter::parse(a.filter));
  o.placement = a.splat ? SamplePlacement::kSplat : SamplePlacement::kOnePixel;
  // Importance-sampling a filter with lobes below 0 makes weights below 0.
  o.negative_weights = !a.splat && o.filter.has_negative_lobes();
  o.input = a.input;
  if (a.bands) o.bands = take_usage(bands_of(*a.bands));
  o.spectral = a.spectral;
  o.xyz = a.observer;
  for (const std::string& name : a.sensors) o.sensors.push_back({name, take_usage(Sensor::named(name))});
  o.statistics = a.statistics;
  if (a.maximum) o.maximum_component = *a.maximum;
  o.range = a.range;
  return o;
}

/// Text in a checkpoint that identifies its run, without its progress.
std::string run_text(const SimulateArguments& a, const SceneSampling& s) {
  return fmt::format("scene {} seed {} samples {} shard {}/{} wavelengths {} {}", a.scene, s.seed,
                     s.samples_per_pixel, s.shard, s.shards, s.wavelengths, name_of(kSamplings, a.sampling));
}

/// Steps that a checkpoint has done; nothing for one of another run.
std::optional<std::uint64_t> steps_done(const std::string& progress, const std::string& run) {
  const std::string start = run + " steps ";
  if (progress.rfind(start, 0) != 0) return {};
  const auto steps = parse_integers<std::uint64_t>(progress.substr(start.size()), ' ', 1);
  if (!steps) return {};
  return (*steps)[0];
}

/// A film and the steps that are in it.
struct Run {
  Film film;
  std::uint64_t done = 0;
};

Result<Run> start_or_continue(const SimulateArguments& a, const FilmOptions& o, const std::string& run) {
  auto film = Film::create(o);
  if (!film) return film.error();
  std::error_code error;
  if (a.checkpoint.empty() || !std::filesystem::exists(a.checkpoint, error)) return Run{*std::move(film), 0};
  auto saved = load_film(a.checkpoint, a.common.threads, [](const Progress&) { return !interrupted(); });
  if (!saved) return saved.error();
  const auto done = steps_done(saved->progress, run);
  if (!done) {
    return Error{ErrorCode::kBadFile, fmt::format("{}: is of another run ({}), not of this one ({})",
                                                  a.checkpoint, saved->progress, run)};
  }
  // Merging says in what the checkpoint's film differs.
  if (const auto merged = film->merge(saved->film); !merged) {
    return Error{ErrorCode::kBadFile, fmt::format("{}: {}", a.checkpoint, merged.error().message)};
  }
  return Run{*std::move(film), *done};
}

/// Draws what is left, saving now and then. Throws: Stop.
void draw(const SimulateArguments& a, const ProceduralScene& scene, const SceneSampling& s,
          const std::string& text, const ImageOptions& options, Run& run) {
  using Clock = std::chrono::steady_clock;
  const std::uint64_t steps = simulation_steps(run.film.options(), s);
  const auto bar = progress_bar(std::filesystem::path(a.output).filename().string(), !a.common.quiet);
  auto last_saved = Clock::now();
  const bool saves = !a.checkpoint.empty();
  // Between looks at the clock and at signals: a tenth to a fifth of a second, whatever a step takes here.
  constexpr auto kLeast = std::chrono::milliseconds(100);
  std::uint64_t steps_at_once = 1;
  while (run.done < steps) {
    const std::uint64_t count = std::min(steps_at_once, steps - run.done);
    const auto begin = Clock::now();
    take(simulate(scene, s, run.film, run.done, count, {a.common.threads}));
    run.done += count;
    const auto took = Clock::now() - begin;
    if (took < kLeast / 2) steps_at_once *= 2;
    if (took > 2 * kLeast) steps_at_once = std::max<std::uint64_t>(1, steps_at_once / 2);
    const bool stop = !bar({run.done, steps}) || interrupted();
    const std::chrono::duration<double> since = Clock::now() - last_saved;
    if (saves && run.done < steps && (stop || since.count() >= a.every)) {
      take(save_film(run.film, a.checkpoint, fmt::format("{} steps {}", text, run.done), options));
      last_saved = Clock::now();
    }
    if (stop && run.done < steps) {
      throw Stop(complain({ErrorCode::kCancelled,
                           "interrupted; " + (saves ? "the checkpoint " + a.checkpoint + " has what was drawn"
                                                    : std::string("nothing was written"))}));
    }
  }
}

void report(const SimulateArguments& a, const Run& run, const SceneError& error, const FilmFileReport& saved,
            double seconds, std::uint64_t continued) {
  const FilmStats stats = run.film.stats();
  if (a.common.json) {
    return print_json({{"output", a.output},
                       {"scene", a.scene},
                       {"samples", stats.accepted},
                       {"rejected", stats.rejected.total()},
                       {"continued_from_step", continued},
                       {"touched_tiles", stats.touched_tiles},
                       {"tiles", stats.tiles},
                       {"bytes_per_pixel", stats.bytes_per_pixel},
                       {"mean_luminance", error.mean_luminance},
                       {"rms_luminance_error", error.rms_luminance},
                       {"rms_xyz_error", error.rms_xyz},
                       {"mean_radiance", error.mean_radiance},
                       {"rms_spectrum_error", error.rms_spectrum},
                       {"bytes_written", saved.bytes_written},
                       {"seconds", seconds}});
  }
  print("{} -> {}: {} samples{}, {}, {:.1f} s\n", a.scene, a.output, stats.accepted,
        continued > 0 ? fmt::format(" (continued from step {})", continued) : "",
        size_text(saved.bytes_written), seconds);
  print("  error of luminance against the exact values: {:.3g} root mean square, of a mean of {:.3g}\n",
        error.rms_luminance, error.mean_luminance);
  print("  {} of {} tiles touched, {} bytes a pixel\n", stats.touched_tiles, stats.tiles,
        stats.bytes_per_pixel);
  if (stats.rejected.total() > 0) print("  {} samples rejected\n", stats.rejected.total());
}

int run_simulate(const SimulateArguments& a) {
  apply_common(a.common);
  check_image_name(a.output);
  check_image_name(a.reference);
  check_image_name(a.checkpoint);
  check_outputs({{a.output, kOutputRole},
                 {a.checkpoint, "the checkpoint (--checkpoint)"},
                 {a.reference, "the reference (--reference)"}},
                {{file_of_bands(a.bands.value_or("")), kBandsRole}});
  const auto start = std::chrono::steady_clock::now();
  const FilmOptions o = film_options(a);
  const ProceduralScene scene = take_usage(ProceduralScene::named(a.scene));
  const auto shard = parse_integers<std::uint64_t>(a.shard, '/', 2);
  if (!shard || (*shard)[0] >= (*shard)[1]) {
    return complain_usage(fmt::format("--shard \"{}\" is not I/N with I from 0 to N - 1", a.shard));
  }
  ImageOptions options;
  options.threads = a.common.threads;
  options.pixel = SampleType::kFloat;
  options.compression = take_usage(Compression::parse(a.compression));
  const SceneSampling s = {.seed = a.seed,
                           .samples_per_pixel = a.samples,
                           .shard = (*shard)[0],
                           .shards = (*shard)[1],
                           .wavelengths = a.wavelengths,
                           .density = a.sampling};
  catch_signals();
  const std::string text = run_text(a, s);
  auto started = start_or_continue(a, o, text);
  if (!started) started = with_light(started.error(), file_of_bands(a.bands.value_or("")), "");
  const bool usage = !started && started.error().code == ErrorCode::kBadArgument;
  Run state = usage ? take_usage(std::move(started)) : take(std::move(started));
  const std::uint64_t continued = state.done;
  draw(a, scene, s, text, options, state);
  // A checkpoint is saved to its end whatever happens; these are not.
  options.progress = [](const Progress&) { return !interrupted(); };
  const FilmFileReport saved = take(save_film(state.film, a.output, {}, options));
  if (!a.reference.empty()) take(write_scene(scene, o, a.reference, options));
  if (!a.checkpoint.empty()) {
    std::error_code error;  // a checkpoint that stays is of a run that is done: it does no harm
    std::filesystem::remove(a.checkpoint, error);
  }
  if (a.common.quiet && !a.common.json) return kOk;
  const auto error = simulation_error(scene, state.film, {a.common.threads}, [] { return !interrupted(); });
  if (!error && error.error().code == ErrorCode::kCancelled) {
    return complain(
        {ErrorCode::kCancelled, "interrupted; " + a.output + " is written, its error not reported"});
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  report(a, state, take(error), saved, seconds.count(), continued);
  return kOk;
}

}  // namespace

void add_film_simulate(const Command& film, int& exit) {
  const auto [command, a] =
      add_subcommand(film, "simulate", "Sample a scene whose exact values are known, into a partial film",
                     run_simulate, exit);
  command.output_file("-o,--output", a->output, kFilesGroup, "Partial film to write").required();
  command.output_file("--reference,--truth", a->reference, kFilesGroup,
                      "Write the exact XYZ too, as an image");
  command.output_file("--checkpoint", a->checkpoint, kFilesGroup,
                      "Save the film here regularly, and continue from it if it exists");
  command.option("--every", a->every, "SECONDS", kFilesGroup, "Interval of checkpoints")
      .not_negative()
      .show_default();
  add_film_compression_option(command, a->compression);

  constexpr const char* kScene = "Scene and samples";
  command.option("--scene", a->scene, "NAME", kScene, "gradients, edges, spikes, decades or mixed (all four)")
      .one_of(ProceduralScene::names())
      .show_default();
  command.option("--size", a->size, "W H", kScene, "Width and height in pixels; 256 x 256 by default")
      .pair("W H");
  command.option("--samples", a->samples, "N", kScene, "Samples per pixel").show_default();
  command.option("--seed", a->seed, "N", kScene, "Random seed").show_default();
  command
      .option("--shard", a->shard, "I/N", kScene, "The I-th of N parts, from 0, which merge into the whole")
      .show_default();
  command.option("--wavelengths", a->wavelengths, "N", kScene, "Wavelengths per sample, 1 to 64")
      .range(1, 64)
      .show_default();
  command.choice("--sampling", a->sampling, kSamplings, kScene, "Density of wavelengths: visible or uniform");
  command.choice("--input", a->input, kInputs, kScene, "Samples at wavelengths, or on bands");

  constexpr const char* kFilm = "Film";
  command.option("--bands", a->bands, "BANDS", kFilm,
                 "FIRST:LAST:STEP, centres in nm, or a plan; 400:700:5 by default");
  command.flag("--spectral", a->spectral, kFilm, "Keep spectra on the bands too");
  add_observer_option(command, a->observer).group(kFilm);
  command.option("--sensor", a->sensors, "NAME", kFilm,
                 fmt::format("Keep a sensor: {}", fmt::join(Sensor::names(), ", ")));
  command
      .option("--filter", a->filter, "NAME[:RADIUS]", kFilm, "box, triangle, gaussian, mitchell or lanczos")
      .show_default();
  command.flag("--splat", a->splat, kFilm, "Splat samples by the filter; importance-sampled by default");
  command.option("--crop", a->crop, "X0,Y0,X1,Y1", kFilm, "Only these pixels");
  command.choice("--statistics", a->statistics, kStatistics, kFilm, "Per pixel: none, counts or variance");
  command.option("--max-component", a->maximum, "X", kFilm, "Scale samples down to this largest component");
  command.option("--range", a->range, "EXPONENT", kFilm, "Largest contribution, as a power of 2")
      .show_default();
  add_common(command, a->common,
             "spectile film simulate --scene mixed --samples 64 --shard 0/2 -o part0.exr");
}

}  // namespace spectile::cli
