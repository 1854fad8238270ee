// spectile film simulate: samples of a scene whose exact values are known, into a partial film.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "src/cli/common.hpp"
#include "src/cli/option_texts.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
  Common common;
  std::string output;
  std::string scene = "mixed";
  std::vector<int> size = {256, 256};
  std::uint64_t samples = 16;
  std::uint64_t seed = 1;
  std::string shard = "0/1";
  std::size_t wavelengths = 4;
  std::string sampling = "visible";
  std::string input = "wavelengths";
  std::optional<std::string> bands;
  bool spectral = false;
  std::string observer = "1931";
  std::vector<std::string> sensors;
  std::string filter = "box";
  bool splat = false;
  std::string crop;
  std::string statistics = "none";
  std::optional<float> maximum;
  int range = FilmOptions().range;
  std::string compression = "zip:1";
  std::string truth;
  std::string checkpoint;
  double every = 60;
};

int usage(const std::string& what) {
  fmt::print(stderr, "spectile: {} (see spectile film simulate --help)\n", what);
  return kBadUsage;
}

int film_options(const Arguments& a, FilmOptions& o) {
  o.width = a.size[0];
  o.height = a.size[1];
  if (!a.crop.empty()) {
    const auto c = whole_numbers<int>(a.crop, ',', 4);
    if (!c) return usage(fmt::format("--crop \"{}\" is not X0,Y0,X1,Y1", a.crop));
    o.crop = PixelWindow{(*c)[0], (*c)[1], (*c)[2], (*c)[3]};
  }
  const auto filter = PixelFilter::parse(a.filter);
  if (!filter) return usage(filter.error().message);
  o.filter = *filter;
  o.placement = a.splat ? SamplePlacement::kSplat : SamplePlacement::kOnePixel;
  // Importance-sampling a filter with lobes below 0 makes weights below 0.
  o.negative_weights = !a.splat && filter->has_negative_lobes();
  o.input = a.input == "bands" ? FilmInput::kBands : FilmInput::kWavelengths;
  if (a.bands) {
    const auto bands = find_bands(*a.bands);
    if (!bands) return usage(bands.error().message);
    o.bands = *bands;
  }
  o.spectral = a.spectral;
  o.xyz = a.observer == "1964" ? Observer::kCie1964 : Observer::kCie1931;
  for (const std::string& name : a.sensors) {
    auto sensor = Sensor::named(name);
    if (!sensor) return usage(sensor.error().message);
    o.sensors.push_back({name, *std::move(sensor)});
  }
  o.statistics = a.statistics == "counts"     ? PixelStatistics::kCounts
                 : a.statistics == "variance" ? PixelStatistics::kVariance
                                              : PixelStatistics::kNone;
  if (a.maximum) o.maximum_component = *a.maximum;
  o.range = a.range;
  return kOk;
}

/// What a checkpoint says of the run that it belongs to, but for how far it is.
std::string run_text(const Arguments& a, const SceneSampling& s) {
  return fmt::format("scene {} seed {} samples {} shard {}/{} wavelengths {} {}", a.scene, s.seed,
                     s.samples_per_pixel, s.shard, s.shards, s.wavelengths, a.sampling);
}

/// Steps that a checkpoint has done; nothing for one of another run.
std::optional<std::uint64_t> steps_done(const std::string& progress, const std::string& run) {
  const std::string start = run + " steps ";
  if (progress.rfind(start, 0) != 0) return {};
  const auto steps = whole_numbers<std::uint64_t>(progress.substr(start.size()), ' ', 1);
  if (!steps) return {};
  return (*steps)[0];
}

/// A film and the steps that are in it.
struct Run {
  Film film;
  std::uint64_t done = 0;
};

Result<Run> start_or_continue(const Arguments& a, const FilmOptions& o, const std::string& run) {
  auto film = Film::create(o);
  if (!film) return film.error();
  std::error_code error;
  if (a.checkpoint.empty() || !std::filesystem::exists(a.checkpoint, error)) return Run{*std::move(film), 0};
  auto saved = load_film(a.checkpoint, a.common.threads);
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

/// Draws what is left, saving now and then. Returns an exit code, after saying what is wrong.
int draw(const Arguments& a, const ProceduralScene& scene, const SceneSampling& s, const std::string& text,
         const ImageOptions& options, Run& run) {
  using Clock = std::chrono::steady_clock;
  const std::uint64_t steps = simulation_steps(run.film.options(), s);
  const auto bar = progress_bar(std::filesystem::path(a.output).filename().string(), !a.common.quiet);
  const auto save = [&]() -> Result<void> {
    const auto saved = save_film(run.film, a.checkpoint, fmt::format("{} steps {}", text, run.done), options);
    if (!saved) return saved.error();
    return {};
  };
  auto last_saved = Clock::now();
  const bool saves = !a.checkpoint.empty();
  // Between looks at the clock: some tenths of a second.
  constexpr std::uint64_t kStepsAtOnce = 64;
  while (run.done < steps) {
    const std::uint64_t count = std::min(kStepsAtOnce, steps - run.done);
    const auto drawn = simulate(scene, s, run.film, run.done, count, {a.common.threads});
    if (!drawn) return complain(drawn.error());
    run.done += count;
    const bool stop = !bar({run.done, steps}) || interrupted();
    const std::chrono::duration<double> since = Clock::now() - last_saved;
    if (saves && run.done < steps && (stop || since.count() >= a.every)) {
      if (const auto saved = save(); !saved) return complain(saved.error());
      last_saved = Clock::now();
    }
    if (stop && run.done < steps) {
      fmt::print(stderr, "spectile: interrupted; {}\n",
                 saves ? "the checkpoint " + a.checkpoint + " has what was drawn" : "nothing was written");
      return kInterrupted;
    }
  }
  return kOk;
}

void report(const Arguments& a, const Run& run, const SceneError& error, const FilmFileReport& saved,
            double seconds, std::uint64_t continued) {
  const FilmStats stats = run.film.stats();
  if (a.common.json) {
    const nlohmann::json out = {{"output", a.output},
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
                                {"seconds", seconds}};
    fmt::print("{}\n", out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  if (a.common.quiet) return;
  fmt::print("{} -> {}: {} samples{}, {}, {:.1f} s\n", a.scene, a.output, stats.accepted,
             continued > 0 ? fmt::format(" (continued from step {})", continued) : "",
             size_text(saved.bytes_written), seconds);
  fmt::print("  error of luminance against the exact values: {:.3g} root mean square, of a mean of {:.3g}\n",
             error.rms_luminance, error.mean_luminance);
  fmt::print("  {} of {} tiles touched, {} bytes a pixel\n", stats.touched_tiles, stats.tiles,
             stats.bytes_per_pixel);
  if (stats.rejected.total() > 0) fmt::print("  {} samples refused\n", stats.rejected.total());
}

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  const auto start = std::chrono::steady_clock::now();
  FilmOptions o;
  if (const int bad = film_options(a, o)) return bad;
  const auto scene = ProceduralScene::named(a.scene);
  if (!scene) return usage(scene.error().message);
  const auto shard = whole_numbers<std::uint64_t>(a.shard, '/', 2);
  if (!shard || (*shard)[0] >= (*shard)[1]) {
    return usage(fmt::format("--shard \"{}\" is not I/N with I from 0 to N - 1", a.shard));
  }
  ImageOptions options;
  options.threads = a.common.threads;
  options.pixel = PixelType::kFloat;
  const auto compression = Compression::parse(a.compression);
  if (!compression) return usage(compression.error().message);
  options.compression = *compression;
  const SceneSampling s = {
      .seed = a.seed,
      .samples_per_pixel = a.samples,
      .shard = (*shard)[0],
      .shards = (*shard)[1],
      .wavelengths = a.wavelengths,
      .density = a.sampling == "uniform" ? WavelengthSampling::kUniform : WavelengthSampling::kVisible};
  catch_signals();
  const std::string text = run_text(a, s);
  auto state = start_or_continue(a, o, text);
  if (!state) {
    if (state.error().code == ErrorCode::kBadArgument) return usage(state.error().message);
    return complain(state.error());
  }
  const std::uint64_t continued = state->done;
  if (const int bad = draw(a, *scene, s, text, options, *state)) return bad;
  const auto saved = save_film(state->film, a.output, {}, options);
  if (!saved) return complain(saved.error());
  if (!a.truth.empty()) {
    const auto written = write_scene(*scene, o, a.truth, options);
    if (!written) return complain(written.error());
  }
  if (!a.checkpoint.empty()) {
    std::error_code error;  // a checkpoint that stays is of a run that is done: it does no harm
    std::filesystem::remove(a.checkpoint, error);
  }
  const auto error = simulation_error(*scene, state->film, {a.common.threads});
  if (!error) return complain(error.error());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  report(a, *state, *error, *saved, seconds.count(), continued);
  return kOk;
}

}  // namespace

void add_film_simulate(CLI::App& film, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = film.add_subcommand(
      "simulate", "Draw samples of a scene whose exact values are known, into a partial film");
  command->add_option("-o,--output", a->output, "The partial film to write")->required();
  command->add_option("--scene", a->scene, "gradients, edges, spikes, decades, or mixed: all four")
      ->check(CLI::IsMember(ProceduralScene::names()))
      ->capture_default_str();
  command->add_option("--size", a->size, "Width and height in pixels")->expected(2)->capture_default_str();
  command->add_option("--samples", a->samples, "Samples a pixel")->capture_default_str();
  command->add_option("--seed", a->seed, "Another seed, other samples")->capture_default_str();
  command->add_option("--shard", a->shard, "I/N: the I-th of N parts, from 0; merged they are the whole")
      ->capture_default_str();
  command->add_option("--wavelengths", a->wavelengths, "Wavelengths a sample, 1 to 64")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command
      ->add_option("--sampling", a->sampling,
                   "How wavelengths are drawn: visible (as the eye sees) or uniform")
      ->check(CLI::IsMember({"visible", "uniform"}))
      ->capture_default_str();
  command->add_option("--input", a->input, "What the film is fed with: wavelengths, or bands")
      ->check(CLI::IsMember({"wavelengths", "bands"}))
      ->capture_default_str();
  command->add_option("--bands", a->bands,
                      "FIRST:LAST:STEP in nm, centres, or a plan (plan.json); 400:700:5 by default");
  command->add_flag("--spectral", a->spectral, "Keep spectra on the bands too");
  command->add_option("--observer", a->observer, "1931 (2 degree) or 1964 (10 degree)")
      ->check(CLI::IsMember({"1931", "1964"}))
      ->capture_default_str();
  command->add_option("--sensor", a->sensors,
                      "Keep a sensor's colour too: " + fmt::format("{}", fmt::join(Sensor::names(), ", ")));
  command
      ->add_option("--filter", a->filter,
                   "box, triangle, gaussian, mitchell or lanczos, then :RADIUS and its parameters")
      ->capture_default_str();
  command->add_flag("--splat", a->splat,
                    "Weigh each sample into the pixels around it; else the filter is importance-sampled");
  command->add_option("--crop", a->crop, "X0,Y0,X1,Y1: only these pixels");
  command->add_option("--statistics", a->statistics, "Of a pixel's samples: none, counts or variance")
      ->check(CLI::IsMember({"none", "counts", "variance"}))
      ->capture_default_str();
  command->add_option("--max-component", a->maximum, "Scale samples with a larger component down to it");
  command->add_option("--range", a->range, "Contributions reach to 2^RANGE")->capture_default_str();
  command->add_option("--compression", a->compression, "none, rle, zips, zip or piz, zip with :LEVEL")
      ->capture_default_str();
  command->add_option("--truth", a->truth, "Write the exact XYZ too, as an image");
  command->add_option("--checkpoint", a->checkpoint,
                      "Save the film here now and then, and go on from there when the file exists; removed "
                      "at the end");
  command->add_option("--every", a->every, "Seconds between checkpoints")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
