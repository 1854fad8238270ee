// Run time against error: timing and evaluating methods, the frontier, and what follows from it in words.
#include "bench/methods/methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <spectile/plan/plan.hpp>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/upsampling/rgb_spectrum.hpp>

#include "src/base/errors.hpp"

namespace spectile::measure {

Result<std::vector<Bands>> planned_bands_for(const std::string& light, const std::vector<std::size_t>& counts,
                                             int bounces) {
  SPECTILE_ASSIGN(const auto wide, Bands::uniform(kFirstVisibleNm, kLastVisibleNm, 5));
  SPECTILE_ASSIGN(auto upsampler, Upsampler::create(Method::kSigmoid, Quantity::kReflectance, wide));
  PlannerOptions options;
  constexpr int kSide = 5;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const auto step = [](int n) { return static_cast<double>(n % kSide) / (kSide - 1); };
    const std::array<double, 3> rgb = {step(i), step(i / kSide), step(i / (kSide * kSide))};
    SPECTILE_ASSIGN(auto spectrum, rgb_albedo_spectrum(upsampler, rgb));
    options.reflectances.emplace_back(std::move(spectrum));
  }
  SPECTILE_ASSIGN(auto under, find_light(light));
  options.lights.push_back(std::move(under));
  options.sampling = BandSampling::kAverages;
  options.folds = 0;
  options.bounces = bounces;
  std::vector<Bands> out;
  for (const std::size_t count : counts) {
    options.bands = count;
    SPECTILE_ASSIGN(auto plan, make_plan(options));
    SPECTILE_ASSIGN(auto bands, planned_bands(plan));
    out.push_back(std::move(bands));
  }
  return out;
}

std::vector<MethodSpeed> measure_methods(const std::string& job, const MethodScene& scene,
                                         std::vector<MethodRun>& methods, const TimingBudget& timing,
                                         const std::vector<MethodSpeed>& earlier) {
  const auto known = [&](const MethodRun& method) {
    return std::find_if(earlier.begin(), earlier.end(),
                        [&](const MethodSpeed& e) { return e.job == job && e.name == method.name; });
  };
  std::vector<Timed> timed(methods.size());
  std::vector<Timed*> work;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    timed[i].run = methods[i].run;
    if (known(methods[i]) == earlier.end()) {
      work.push_back(&timed[i]);
    } else {
      methods[i].run();  // the time is known, the colours are not
    }
  }
  time_in_turn(work, timing);
  std::vector<MethodSpeed> out;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const MethodRun& method = methods[i];
    MethodSpeed w;
    w.job = job;
    w.light = scene.light->name;
    w.line_spectrum = scene.light->line_spectrum;
    w.family = method.family;
    w.name = method.name;
    w.bands = method.bands;
    w.bytes = method.bytes;
    const auto before = known(method);
    if (before == earlier.end()) {
      w.nanoseconds = 1e9 * timed[i].seconds / static_cast<double>(kMethodLanes) * method.per_lane;
      w.spread = timed[i].spread;
    } else {
      w.nanoseconds = before->nanoseconds;
      w.spread = before->spread;
    }
    ErrorList errors(scene.light->white);
    for (std::size_t r = 0; r < std::min(kMethodLanes, scene.reflectances->size()); ++r) {
      errors.add(reference_xyz(*scene.light, {&(*scene.reflectances)[r]}), method.result(r));
    }
    w.error = errors.summary();
    w.differences = errors.differences();
    out.push_back(std::move(w));
  }
  return out;
}

void mark_frontier(std::vector<MethodSpeed>& methods) {
  for (MethodSpeed& w : methods) {
    w.frontier = std::none_of(methods.begin(), methods.end(), [&](const MethodSpeed& other) {
      if (other.job != w.job || other.light != w.light || &other == &w) return false;
      const bool as_good = other.nanoseconds <= w.nanoseconds && other.error.mean <= w.error.mean;
      return as_good && (other.nanoseconds < w.nanoseconds || other.error.mean < w.error.mean);
    });
  }
}

std::vector<BenchmarkAdvice> advice_on(const std::vector<MethodSpeed>& methods) {
  // Visible at all; visible side by side to a careful observer; seen by instruments.
  constexpr double kErrors[] = {2, 1, 0.5, 0.2, 0.1, 0.05};
  std::map<std::pair<std::string, std::string>, std::vector<const MethodSpeed*>> groups;
  for (const MethodSpeed& w : methods) groups[{w.job, w.light}].push_back(&w);
  std::vector<BenchmarkAdvice> out;
  for (const auto& [key, group] : groups) {
    const BenchmarkAdvice about{key.first, key.second, {}};
    const auto say = [&out, &about](std::string sentence) {
      out.push_back({about.job, about.light, std::move(sentence)});
    };
    const MethodSpeed* last = nullptr;
    double asked = 0;
    const auto flush = [&] {
      if (last == nullptr) return;
      say(fmt::format("For a mean error below {}: {}, {:.3g} ns (mean {:.3f}, 95 % {:.3f}, maximum {:.2f}).",
                      asked, last->name, last->nanoseconds, last->error.mean, last->error.percentile95,
                      last->error.maximum));
    };
    for (const double error : kErrors) {
      const MethodSpeed* best = nullptr;
      for (const MethodSpeed* w : group) {
        if (w->error.mean <= error && (best == nullptr || w->nanoseconds < best->nanoseconds)) best = w;
      }
      // One sentence for all the errors that one method is the answer to: that of the least.
      if (last != nullptr && best != last) flush();
      if (best == nullptr) {
        const MethodSpeed* least = *std::min_element(
            group.begin(), group.end(),
            [](const MethodSpeed* a, const MethodSpeed* b) { return a->error.mean < b->error.mean; });
        say(fmt::format("None has a mean error below {}: the least is {:.3f}, of {}, {:.3g} ns.", error,
                        least->error.mean, least->name, least->nanoseconds));
        last = nullptr;
        break;
      }
      last = best;
      asked = error;
    }
    flush();
  }
  return out;
}

}  // namespace spectile::measure
