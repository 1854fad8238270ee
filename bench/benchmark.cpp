// The benchmark: machine limits, operations, methods, representations, and the numbers under
// stress.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <spectile/bench/benchmark.hpp>
#include <spectile/isa.hpp>

#include "bench/baseline/film_orders.hpp"
#include "bench/limits/limits.hpp"
#include "bench/methods/methods.hpp"
#include "bench/operations/operation_speeds.hpp"
#include "bench/stress/stress.hpp"
#include "src/base/errors.hpp"
#include "src/dispatch/dispatch.hpp"

namespace spectile {
namespace {

using namespace measure;

/// Half a core of other work in a part is said.
constexpr double kDisturbing = 0.25;

/// Those asked for, each once, the slowest first.
std::vector<std::string> chosen_isas(const BenchmarkOptions& options, const BenchmarkMachine& machine) {
  if (options.isas.empty()) return machine.isas;
  std::vector<std::string> out;
  for (const std::string& isa : machine.isas) {
    if (std::find(options.isas.begin(), options.isas.end(), isa) != options.isas.end()) out.push_back(isa);
  }
  return out;
}

std::vector<int> thread_counts(const BenchmarkOptions& options, int cores) {
  if (!options.threads.empty()) {
    const std::set<int> asked(options.threads.begin(), options.threads.end());
    return {asked.begin(), asked.end()};
  }
  std::vector<int> out;
  for (int n = 1; n < cores; n *= 2) out.push_back(n);
  out.push_back(cores);
  return out;
}

/// Bytes worked on for the caches: a part of the second level that leaves room for tables and the stack.
std::size_t cache_bytes(const BenchmarkMachine& machine) {
  constexpr std::size_t kUnknown = std::size_t{512} << 10;
  const std::size_t size = machine.second_level_cache == 0 ? kUnknown : machine.second_level_cache;
  return std::clamp<std::size_t>(size / 4, std::size_t{128} << 10, std::size_t{1} << 20) / 4096 * 4096;
}

/// Bytes worked on for memory: far more than the caches, and not more than an eighth of what there is.
std::size_t memory_bytes(const BenchmarkMachine& machine, bool quick) {
  const auto there = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES))) *
                     static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
  std::uint64_t bytes = std::clamp<std::uint64_t>(2 * machine.last_level_cache, std::uint64_t{256} << 20,
                                                  std::uint64_t{512} << 20);
  if (quick) bytes = std::uint64_t{256} << 20;
  if (there > 0) bytes = std::min(bytes, there / 8);
  return bytes / 4096 * 4096;
}

/// A run, part by part.
class Run {
 public:
  Run(const BenchmarkOptions& options, BenchmarkReport& report) : options_(options), report_(report) {}

  /// Calls work() as a part that the caller may stop, watching for others.
  template <class Work>
  Result<void> part(const std::string& name, Work work) {
    if (options_.progress && !options_.progress(name, done_)) {
      return make_error(ErrorCode::kCancelled, "the benchmark was stopped before {}", name);
    }
    const LoadMonitor monitor;
    stop_ = [this, name] { return options_.progress && !options_.progress(name, done_); };
    const Result<void> worked = work();
    // A part that was cut short is void.
    if (stop_()) return make_error(ErrorCode::kCancelled, "the benchmark was stopped in {}", name);
    if (!worked) return worked.error();
    const double other_cores = monitor.other_cores();
    if (other_cores > kDisturbing) {
      report_.disturbed.push_back(
          fmt::format("{}: other work took {:.1f} of {} cores", name, other_cores, report_.machine.cores));
    }
    return {};
  }
  void set_done(double done) { done_ = done; }
  /// True if the caller wants an end, for long loops within a part.
  std::function<bool()> stop() const {
    return [this] { return stop_ && stop_(); };
  }

 private:
  const BenchmarkOptions& options_;
  BenchmarkReport& report_;
  std::function<bool()> stop_;
  double done_ = 0;
};

Result<void> check(const BenchmarkOptions& options, const BenchmarkMachine& machine) {
  for (const int threads : options.threads) {
    if (threads < 1 || threads > 1024) {
      return make_error(ErrorCode::kBadArgument, "a benchmark runs on 1 to 1024 threads, not {}", threads);
    }
  }
  for (const std::string& isa : options.isas) {
    SPECTILE_TRY(dispatch::find(isa));
    if (isa == "scalar") {
      return make_error(ErrorCode::kBadArgument,
                        "the scalar reference is not made for speed: it has no limits to be held to");
    }
  }
  for (const std::string& light : options.lights) {
    SPECTILE_TRY(reference_light(light));
  }
  if (machine.isas.empty() && options.isas.empty()) {
    return make_error(ErrorCode::kUnavailable, "none of the instruction sets with kernels runs here");
  }
  return {};
}

Error no_operation(const BenchmarkOptions& options) {
  return make_error(ErrorCode::kBadArgument, "no operation's name contains \"{}\"", options.only.front());
}

/// Forces an instruction set while it exists, for operations that choose theirs themselves.
class ScopedIsa {
 public:
  explicit ScopedIsa(std::string_view isa) { static_cast<void>(dispatch::force(isa)); }
  ~ScopedIsa() { static_cast<void>(dispatch::force("")); }
  ScopedIsa(const ScopedIsa&) = delete;
  ScopedIsa& operator=(const ScopedIsa&) = delete;
};

Result<void> measure_films(Run& run, const BenchmarkOptions& options, BenchmarkReport& report) {
  if (!options.memory) return {};
  SPECTILE_ASSIGN(const auto table, dispatch::find(chosen_isas(options, report.machine).back()));
  const ScopedIsa forced(table->name);
  FilmOrderSettings settings;
  settings.table = table;
  settings.quick = options.quick;
  settings.seed = options.seed;
  settings.only = options.only;
  settings.timing.rounds = options.quick ? 2 : 3;
  settings.timing.stop = run.stop();
  for (const MachineLimit& l : report.limits) {
    if (l.isa == table->name && l.threads == 1 && l.level == MemoryLevel::kMemory) settings.copy = l.copy;
  }
  return run.part("films", [&]() -> Result<void> {
    SPECTILE_ASSIGN(const auto found, measure_film_orders(settings));
    report.baseline.insert(report.baseline.end(), found.begin(), found.end());
    return {};
  });
}

Result<void> measure_operations(Run& run, const BenchmarkOptions& options, BenchmarkReport& report) {
  const Bands bands;
  SPECTILE_ASSIGN(auto operations, lane_operations(bands));
  std::erase_if(operations, [&](const Operation& op) { return !is_chosen(op.name, options.only); });
  if (operations.empty()) return no_operation(options);
  const std::vector<std::string> isas = chosen_isas(options, report.machine);
  const std::vector<int> threads = thread_counts(options, report.machine.cores);
  std::vector<SpeedPlace> places;
  for (const std::string& isa : isas) {
    const bool fastest = isa == isas.back();
    for (const MemoryLevel level : {MemoryLevel::kCache, MemoryLevel::kMemory}) {
      if (level == MemoryLevel::kMemory && !options.memory) continue;
      for (const int count : threads) {
        // Threads and, in a hurry, memory are the fastest's alone; so is memory's bandwidth but for avx2's.
        const bool main = count == threads.front();
        if (!fastest && (!main || (options.quick && level == MemoryLevel::kMemory))) continue;
        if (!fastest && level == MemoryLevel::kMemory && isa != "avx2") continue;
        SpeedPlace place;
        place.table = *dispatch::find(isa);
        place.threads = count;
        place.level = level;
        const bool cache = level == MemoryLevel::kCache;
        place.bytes = cache ? report.machine.cache_bytes : report.machine.memory_bytes;
        place.timing.rounds = options.quick ? (cache ? 5 : 3) : (cache ? 15 : 5);
        place.timing.min_seconds = options.quick ? 1e-3 : 2e-3;
        place.timing.stop = run.stop();
        place.seed = options.seed;
        place.baseline = fastest && cache && count == 1;
        place.bands = bands;
        places.push_back(place);
      }
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const SpeedPlace& place = places[i];
    run.set_done(0.4 * static_cast<double>(i) / static_cast<double>(places.size()));
    const std::string name =
        fmt::format("operations, {}, {} thread{}, {}", place.table->name, place.threads,
                    place.threads == 1 ? "" : "s", place.level == MemoryLevel::kCache ? "cache" : "memory");
    SPECTILE_TRY(run.part(name, [&]() -> Result<void> {
      SPECTILE_ASSIGN(auto found, measure_speeds(operations, place));
      report.limits.push_back(found.limit);
      report.operations.insert(report.operations.end(), found.operations.begin(), found.operations.end());
      report.baseline.insert(report.baseline.end(), found.baseline.begin(), found.baseline.end());
      return {};
    }));
  }
  return {};
}

/// Speeds of several threads over those of one.
void add_scaling(BenchmarkReport& report) {
  for (const OperationSpeed& many : report.operations) {
    if (many.threads == 1) continue;
    const auto one =
        std::find_if(report.operations.begin(), report.operations.end(), [&](const OperationSpeed& o) {
          return o.threads == 1 && o.name == many.name && o.isa == many.isa && o.level == many.level;
        });
    if (one == report.operations.end()) continue;
    const auto scaling_limit = [&](int threads) {
      const auto found = std::find_if(report.limits.begin(), report.limits.end(), [&](const MachineLimit& l) {
        return l.threads == threads && l.isa == many.isa && l.level == many.level;
      });
      return many.limit == "multiply-add" ? found->multiply_add
             : many.limit == "divide"     ? found->divide
                                          : found->copy;
    };
    report.scaling.push_back({many.name, many.level, many.threads,
                              many.items_per_second / one->items_per_second,
                              scaling_limit(many.threads) / scaling_limit(1)});
  }
}

Result<void> measure_jobs(Run& run, const BenchmarkOptions& options, BenchmarkReport& report) {
  SPECTILE_ASSIGN(const auto table, dispatch::find(chosen_isas(options, report.machine).back()));
  const ScopedIsa forced(table->name);
  std::vector<Spectrum> spectra = options.reflectances;
  if (spectra.empty()) {
    SPECTILE_ASSIGN(spectra, chart_reflectances());
  }
  SPECTILE_ASSIGN(const auto reflectances, reference_reflectances(spectra));
  // Two smooth, two with lines.
  const std::vector<std::string> lights =
      options.lights.empty() ? std::vector<std::string>{"D65", "A", "FL11", "HP1"} : options.lights;
  TimingBudget timing;
  timing.rounds = options.quick ? 5 : 11;
  timing.min_seconds = options.quick ? 1e-3 : 3e-3;
  timing.stop = run.stop();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    run.set_done(0.4 + 0.4 * static_cast<double>(i) / static_cast<double>(lights.size()));
    SPECTILE_TRY(run.part(fmt::format("methods under {}", lights[i]), [&]() -> Result<void> {
      SPECTILE_ASSIGN(auto light, reference_light(lights[i]));
      MethodScene scene{&reflectances, &light, table, {}, {}, options.seed};
      const auto counts = options.quick ? std::vector<std::size_t>{8} : std::vector<std::size_t>{8, 12};
      SPECTILE_ASSIGN(scene.planned, planned_bands_for(lights[i], counts));
      if (!options.quick) {
        SPECTILE_ASSIGN(scene.planned_for_paths, planned_bands_for(lights[i], {8, 12, 16}, 2));
      }
      for (const bool film : {false, true}) {
        SPECTILE_ASSIGN(auto methods,
                        film ? film_methods(scene, options.quick) : rgb_methods(scene, options.quick));
        auto found = measure_methods(film ? kFilmJob : kRgbJob, scene, methods, timing, report.methods);
        for (MethodSpeed& method : found) {
          if (!options.differences) method.differences.clear();
        }
        report.methods.insert(report.methods.end(), found.begin(), found.end());
      }
      SPECTILE_ASSIGN(auto side, measure_representations(scene, timing));
      report.representations.insert(report.representations.end(), side.begin(), side.end());
      return {};
    }));
  }
  mark_frontier(report.methods);
  report.advice = advice_on(report.methods);
  return {};
}

Result<void> stress(Run& run, const BenchmarkOptions& options, BenchmarkReport& report) {
  SPECTILE_ASSIGN(const auto table, dispatch::find(chosen_isas(options, report.machine).back()));
  const ScopedIsa forced(table->name);
  StressSettings settings;
  settings.table = table;
  settings.seed = options.seed;
  settings.samples = std::size_t{1} << (options.quick ? 15 : options.stress ? 21 : 17);
  settings.few_bands = options.quick;
  settings.only = options.only;
  settings.stop = run.stop();
  run.set_done(0.8);
  SPECTILE_TRY(run.part("numbers, operations", [&]() -> Result<void> {
    SPECTILE_ASSIGN(report.stress, stress_operations(settings));
    return {};
  }));
  run.set_done(0.9);
  SPECTILE_TRY(run.part("numbers, the rest", [&]() -> Result<void> {
    SPECTILE_ASSIGN(auto found, stress_others(settings));
    report.stress.insert(report.stress.end(), found.begin(), found.end());
    return {};
  }));
  if (report.stress.empty()) return no_operation(options);
  return {};
}

}  // namespace

Result<BenchmarkReport> run_benchmark(const BenchmarkOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  BenchmarkReport report;
  report.machine = describe_machine();
  report.machine.cache_bytes = cache_bytes(report.machine);
  report.machine.memory_bytes = memory_bytes(report.machine, options.quick);
  SPECTILE_TRY(check(options, report.machine));
  Run run(options, report);
  if (options.speed) {
    SPECTILE_TRY(measure_operations(run, options, report));
    add_scaling(report);
    SPECTILE_TRY(measure_films(run, options, report));
    // A choice of operations leaves out the methods.
    if (options.only.empty()) SPECTILE_TRY(measure_jobs(run, options, report));
  }
  if (options.only.empty() || options.stress) SPECTILE_TRY(stress(run, options, report));
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace spectile
