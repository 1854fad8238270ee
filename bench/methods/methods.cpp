// Run time against error: timing and judging ways, the frontier, and what follows from it in words.
#include "bench/methods/methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <spectile/spectra/named_spectra.hpp>
#include <spectile/spectra/spectrum.hpp>

#include "src/base/errors.hpp"

namespace spectile::measure {

Result<std::vector<Bands>> planned_bands_for(const std::string& light, bool quick) {
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
  SPECTILE_ASSIGN(auto found, find_spectrum(light));
  options.lights.push_back({light, std::move(found)});
  options.sampling = PlanSampling::kBands;
  options.folds = 0;
  std::vector<Bands> out;
  for (const std::size_t count : {std::size_t{8}, std::size_t{12}}) {
    if (quick && count != 8) continue;
    options.bands = count;
    SPECTILE_ASSIGN(auto plan, make_plan(options));
    SPECTILE_ASSIGN(auto bands, Bands::of_plan(plan));
    out.push_back(std::move(bands));
  }
  return out;
}

std::vector<WaySpeed> measure_ways(const std::string& job, const WayScene& scene, std::vector<Way>& ways,
                                   const Patience& patience, const std::vector<WaySpeed>& earlier) {
  const auto known = [&](const Way& way) {
    return std::find_if(earlier.begin(), earlier.end(),
                        [&](const WaySpeed& e) { return e.job == job && e.name == way.name; });
  };
  std::vector<Timed> timed(ways.size());
  std::vector<Timed*> work;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    timed[i].run = ways[i].run;
    if (known(ways[i]) == earlier.end()) {
      work.push_back(&timed[i]);
    } else {
      ways[i].run();  // the time is known, the colours are not
    }
  }
  time_in_turn(work, patience);
  std::vector<WaySpeed> out;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const Way& way = ways[i];
    WaySpeed w;
    w.job = job;
    w.light = scene.light->name;
    w.spiky = scene.light->spiky;
    w.family = way.family;
    w.name = way.name;
    w.bands = way.bands;
    w.bytes = way.bytes;
    const auto before = known(way);
    if (before == earlier.end()) {
      w.nanoseconds = 1e9 * timed[i].seconds / static_cast<double>(kWayLanes) * way.per_lane;
      w.spread = timed[i].spread;
    } else {
      w.nanoseconds = before->nanoseconds;
      w.spread = before->spread;
    }
    ErrorList errors(scene.light->white);
    for (std::size_t r = 0; r < std::min(kWayLanes, scene.reflectances->size()); ++r) {
      errors.add(true_xyz(*scene.light, {&(*scene.reflectances)[r]}), way.result(r));
    }
    w.error = errors.summary();
    out.push_back(std::move(w));
  }
  return out;
}

void mark_frontier(std::vector<WaySpeed>& ways) {
  for (WaySpeed& w : ways) {
    w.frontier = std::none_of(ways.begin(), ways.end(), [&](const WaySpeed& other) {
      if (other.job != w.job || other.light != w.light || &other == &w) return false;
      const bool as_good = other.nanoseconds <= w.nanoseconds && other.error.mean <= w.error.mean;
      return as_good && (other.nanoseconds < w.nanoseconds || other.error.mean < w.error.mean);
    });
  }
}

std::vector<BenchmarkAdvice> advice_on(const std::vector<WaySpeed>& ways) {
  // What can be seen at all, what a careful observer sees side by side, what instruments see.
  constexpr double kErrors[] = {2, 1, 0.5, 0.2, 0.1, 0.05};
  std::map<std::pair<std::string, std::string>, std::vector<const WaySpeed*>> groups;
  for (const WaySpeed& w : ways) groups[{w.job, w.light}].push_back(&w);
  std::vector<BenchmarkAdvice> out;
  for (const auto& [key, group] : groups) {
    const BenchmarkAdvice about{key.first, key.second, {}};
    const auto say = [&out, &about](std::string sentence) {
      out.push_back({about.job, about.light, std::move(sentence)});
    };
    const WaySpeed* last = nullptr;
    double asked = 0;
    const auto flush = [&] {
      if (last == nullptr) return;
      say(fmt::format("For a mean error below {}: {}, {:.3g} ns (mean {:.3f}, 95 % {:.3f}, maximum {:.2f}).",
                      asked, last->name, last->nanoseconds, last->error.mean, last->error.percentile95,
                      last->error.maximum));
    };
    for (const double error : kErrors) {
      const WaySpeed* best = nullptr;
      for (const WaySpeed* w : group) {
        if (w->error.mean <= error && (best == nullptr || w->nanoseconds < best->nanoseconds)) best = w;
      }
      // One sentence for all the errors that one way is the answer to: that of the least.
      if (last != nullptr && best != last) flush();
      if (best == nullptr) {
        const WaySpeed* least = *std::min_element(
            group.begin(), group.end(),
            [](const WaySpeed* a, const WaySpeed* b) { return a->error.mean < b->error.mean; });
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
