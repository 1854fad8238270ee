// Simulation: a scene drawn into a film step by step, and its error against the reference values.
#include <algorithm>
#include <cmath>
#include <mutex>
#include <spectile/scene/procedural_scene.hpp>

#include "src/base/out_of_memory.hpp"
#include "src/lanes/tiles.hpp"

namespace spectile {
namespace {

/// Samples a step, about: enough to keep a thread busy, few enough for its caches.
constexpr std::uint64_t kSamplesAStep = 16384;

/// How a run is cut into steps: passes over the pixels with a part of their samples each.
struct StepPlan {
  std::uint64_t samples = 0;  ///< a pixel, of this shard
  std::uint64_t passes = 1;
  std::uint64_t pixels = 0;
  std::uint64_t pixels_a_step = 1;
  std::uint64_t a_pass() const { return (pixels + pixels_a_step - 1) / pixels_a_step; }
  std::uint64_t all() const { return samples == 0 ? 0 : passes * a_pass(); }
};

StepPlan divide_steps(const FilmOptions& film, const SceneSampling& s) {
  StepPlan out;
  if (s.shards == 0 || s.shard >= s.shards) return out;
  out.samples = s.samples_per_pixel > s.shard ? (s.samples_per_pixel - s.shard - 1) / s.shards + 1 : 0;
  const PixelWindow w = film.crop.value_or(PixelWindow{0, 0, film.width, film.height});
  out.pixels = static_cast<std::uint64_t>(w.width()) * static_cast<std::uint64_t>(w.height());
  out.passes = std::max<std::uint64_t>(1, (out.samples + kSamplesAStep - 1) / kSamplesAStep);
  const std::uint64_t a_pixel = std::max<std::uint64_t>(1, (out.samples + out.passes - 1) / out.passes);
  out.pixels_a_step = std::max<std::uint64_t>(1, kSamplesAStep / a_pixel);
  return out;
}

Result<void> run_step(const ProceduralScene& scene, const SceneSampling& sampling, Film& film,
                      const StepPlan& steps, std::uint64_t step) {
  const FilmOptions& o = film.options();
  const bool wavelengths = o.input == FilmInput::kWavelengths;
  // A pass is a shard of the shard.
  SceneSampling part = sampling;
  part.shards = sampling.shards * steps.passes;
  part.shard = sampling.shard + step / steps.a_pass() * sampling.shards;
  const std::uint64_t first = step % steps.a_pass() * steps.pixels_a_step;
  const std::uint64_t count = std::min(steps.pixels_a_step, steps.pixels - first);
  const std::uint64_t a_pixel = (steps.samples + steps.passes - 1) / steps.passes;
  SPECTILE_ASSIGN(
      auto batch,
      SceneBatch::create(count * a_pixel, wavelengths ? sampling.wavelengths : o.bands.count(), wavelengths));
  if (auto drawn = scene.draw(o, part, first, count, batch); !drawn) return drawn;
  return wavelengths ? film.add(batch.wavelength_samples()) : film.add(batch.band_samples());
}

}  // namespace

std::uint64_t simulation_steps(const FilmOptions& film, const SceneSampling& sampling) {
  return divide_steps(film, sampling).all();
}

Result<void> simulate(const ProceduralScene& scene, const SceneSampling& sampling, Film& film,
                      std::uint64_t first, std::uint64_t count, const Execution& execution) {
  const StepPlan steps = divide_steps(film.options(), sampling);
  if (sampling.shards == 0 || sampling.shard >= sampling.shards) {
    return make_error(ErrorCode::kBadArgument, "there is no shard {} of {}", sampling.shard, sampling.shards);
  }
  if (first > steps.all() || count > steps.all() - first) {
    return make_error(ErrorCode::kBadArgument, "the simulation has {} steps, not {} from the {}th on",
                      steps.all(), count, first);
  }
  std::mutex mutex;
  Result<void> result;
  tiles::for_blocks(count, {execution.threads, 1}, [&](std::size_t begin, std::size_t n) {
    for (std::size_t i = begin; i < begin + n; ++i) {
      const auto step = [&] { return run_step(scene, sampling, film, steps, first + i); };
      const Result<void> done = guard_memory(step, "no memory to draw samples");
      if (done) continue;
      const std::scoped_lock lock(mutex);
      if (result) result = done;
      return;
    }
  });
  return result;
}

namespace {

Error stopped() {
  return make_error(ErrorCode::kCancelled, "stopped on request");
}

/// The errors of a film's spectra on its bands.
Result<void> add_spectrum_error(const ProceduralScene& scene, const Film& film, const Execution& execution,
                                const std::function<bool()>& go_on, SceneError& to) {
  SPECTILE_ASSIGN(auto spectrum, FilmDevelopment::create(film, FilmLayer::kSpectrum));
  SPECTILE_TRY(spectrum.update(execution));
  const PixelWindow w = film.window();
  double squares = 0;
  for (int y = w.y0; y < w.y1; ++y) {
    if (go_on && !go_on()) return stopped();
    for (int x = w.x0; x < w.x1; ++x) {
      const std::vector<double> exact = scene.spectrum(film.options(), x, y);
      for (std::size_t b = 0; b < exact.size(); ++b) {
        const double error = static_cast<double>(spectrum.at(b, x, y)) - exact[b];
        to.mean_radiance += exact[b];
        squares += error * error;
      }
    }
  }
  const double values =
      static_cast<double>(w.width()) * w.height() * static_cast<double>(film.options().bands.count());
  to.mean_radiance /= values;
  to.rms_spectrum = std::sqrt(squares / values);
  return {};
}

}  // namespace

Result<SceneError> simulation_error(const ProceduralScene& scene, const Film& film,
                                    const Execution& execution, const std::function<bool()>& go_on) {
  SPECTILE_ASSIGN(auto xyz, FilmDevelopment::create(film, FilmLayer::kXyz));
  if (const auto updated = xyz.update(execution); !updated) return updated.error();
  const PixelWindow w = film.window();
  SceneError out;
  double squares_y = 0;
  double squares = 0;
  std::mutex mutex;
  bool ends = false;  // guarded by the mutex
  tiles::for_blocks(
      static_cast<std::size_t>(w.height()), {execution.threads, 1}, [&](std::size_t first, std::size_t n) {
        for (std::size_t row = first; row < first + n; ++row) {
          {
            const std::scoped_lock lock(mutex);
            ends = ends || (go_on && !go_on());
            if (ends) return;
          }
          SceneError line;
          double line_y = 0;
          double line_all = 0;
          const int y = w.y0 + static_cast<int>(row);
          for (int x = w.x0; x < w.x1; ++x) {
            const auto reference = scene.xyz(film.options(), x, y);
            line.mean_luminance += reference[1];
            for (std::size_t c = 0; c < 3; ++c) {
              const double error = static_cast<double>(xyz.at(c, x, y)) - reference[c];
              line_all += error * error;
              if (c == 1) line_y += error * error;
            }
            const auto got = static_cast<double>(xyz.at(1, x, y));
            if (reference[1] != 0) {
              line.largest_relative = std::max(line.largest_relative, std::abs(got / reference[1] - 1));
            }
            line.black_pixels += reference[1] == 0 && got == 0 ? 1 : 0;
            line.wrong_black += (reference[1] == 0) != (got == 0) ? 1 : 0;
          }
          const std::scoped_lock lock(mutex);
          out.mean_luminance += line.mean_luminance;
          out.largest_relative = std::max(out.largest_relative, line.largest_relative);
          out.black_pixels += line.black_pixels;
          out.wrong_black += line.wrong_black;
          squares_y += line_y;
          squares += line_all;
        }
      });
  if (ends) return stopped();
  const double pixels = static_cast<double>(w.width()) * w.height();
  out.mean_luminance /= pixels;
  out.rms_luminance = std::sqrt(squares_y / pixels);
  out.rms_xyz = std::sqrt(squares / (3 * pixels));
  if (film.options().spectral) SPECTILE_TRY(add_spectrum_error(scene, film, execution, go_on, out));
  return out;
}

}  // namespace spectile
