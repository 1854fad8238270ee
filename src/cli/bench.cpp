// spectile bench: what this machine can do, and what each method costs in time and in error.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <spectile/bench/benchmark.hpp>

#include "src/cli/commands.hpp"
#include "src/cli/options/common_options.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

struct BenchArguments {
  bool quick = false;
  bool differences = false;
  bool stress = false;
  bool stress_only = false;
  bool json = false;
  bool cache_only = false;
  bool quiet = false;
  std::string report;
  std::string plot;
  std::vector<int> threads;
  std::vector<std::string> isas, lights, only, reflectances;
  std::int64_t seed = 1;
};

std::string rate(double per_second) {
  if (per_second >= 1e9) return fmt::format("{:.3g} G/s", per_second * 1e-9);
  return fmt::format("{:.3g} M/s", per_second * 1e-6);
}

std::string place(const std::string& isa, int threads, MemoryLevel level) {
  return fmt::format("{}, {} thread{}, {}", isa, threads, threads == 1 ? "" : "s",
                     level == MemoryLevel::kCache ? "second-level cache" : "memory");
}

void print_machine(const BenchmarkReport& r) {
  print("{}, {} core{}, {}, {}\n", r.machine.processor, r.machine.cores, r.machine.cores == 1 ? "" : "s",
        r.machine.system, r.machine.compiler);
  for (const std::string& text : r.disturbed) print("DISTURBED: {}\n", text);
}

void print_operations(const BenchmarkReport& r) {
  for (const MachineLimit& l : r.limits) {
    print(
        "\n{}: load {:.3g}, store {:.3g}, non-temporal store {:.3g}, copy {:.3g} GB/s; multiply-add "
        "{:.3g} G/s, fused {:.3g}, divide {:.3g}\n",
        place(l.isa, l.threads, l.level), l.load * 1e-9, l.store * 1e-9, l.stream * 1e-9, l.copy * 1e-9,
        l.multiply_add * 1e-9, l.fused_multiply_add * 1e-9, l.divide * 1e-9);
    for (const OperationSpeed& o : r.operations) {
      if (o.isa != l.isa || o.threads != l.threads || o.level != l.level) continue;
      print("  {:<42} {:>10} {:>6.1f} GB/s {:>4.0f} % of {:<12} +-{:<3.0f}% error {:.2g} of {:.3g} {}\n",
            o.name, rate(o.items_per_second), o.bytes_per_second * 1e-9, 100 * o.fraction, o.limit,
            100 * o.spread, o.error, o.bound, o.error_unit);
      if (!o.note.empty()) print("  {:<42} bound by {}\n", "", o.note);
    }
  }
}

void print_baseline(const BenchmarkReport& r) {
  if (r.baseline.empty()) return;
  print(
      "\nAgainst the scalar array-of-structures baseline, one thread, {}\n  {:<50} {:>9} {:>11} {:>7} {:>10} "
      "{:>7}\n",
      r.machine.processor, "", "ns", "baseline ns", "ratio", "tuned ns", "ratio");
  for (const BaselineSpeed& b : r.baseline) {
    print("  {:<50} {:>9.3g} {:>11.3g} {:>7.3g}", b.name, b.nanoseconds, b.baseline_nanoseconds, b.ratio);
    if (b.fused_nanoseconds > 0) {
      print(" {:>10.3g} {:>7.3g}", b.fused_nanoseconds, b.fused_ratio);
    } else {
      print(" {:>10} {:>7}", "", "");
    }
    print(" error {:.2g}, baseline {:.2g} {}; {:.0f} % of {}\n", b.error, b.baseline_error, b.error_unit,
          100 * b.fraction, b.limit);
  }
}

/// A job's name, without its reference.
std::string short_name(const std::string& job) {
  return job.substr(0, job.find(';'));
}

void print_methods(const BenchmarkReport& r) {
  std::string heading;
  for (const MethodSpeed& w : r.methods) {
    const std::string now = fmt::format("{}: {}", short_name(w.job), w.light);
    if (now != heading) {
      heading = now;
      print("\n{}{}\n  {:<50} {:>9} {:>7} {:>7} {:>7}\n", now, w.line_spectrum ? " (line spectrum)" : "", "",
            "ns", "mean", "95 %", "max");
    }
    print("{} {:<50} {:>9.3g} {:>7.3f} {:>7.3f} {:>7.3f}\n", w.frontier ? "*" : " ", w.name, w.nanoseconds,
          w.error.mean, w.error.percentile95, w.error.maximum);
  }
  if (!r.methods.empty()) print("\n* no other method is as fast and as accurate\n");
  std::string last;
  for (const BenchmarkAdvice& a : r.advice) {
    const std::string now = fmt::format("{}: {}", short_name(a.job), a.light);
    if (now != last) print("\n{}\n", now);
    last = now;
    print("  {}\n", a.sentence);
  }
}

void print_representations(const BenchmarkReport& r) {
  std::string heading;
  for (const RepresentationSpeed& s : r.representations) {
    if (s.bounces != 1) continue;
    if (s.light != heading) {
      heading = s.light;
      print("\nBounces 1 to 5 under {}: ns, CIEDE2000 mean (max)\n", s.light);
    }
    print("  {:<37}", s.name);
    for (const RepresentationSpeed& t : r.representations) {
      if (t.light != s.light || t.name != s.name) continue;
      print("  {:.3g} ns {:.3f} ({:.2f})", t.nanoseconds, t.error.mean, t.error.maximum);
    }
    print("\n");
  }
}

int print_stress(const BenchmarkReport& r) {
  if (r.stress.empty()) return 0;
  print("\nNumbers under stress\n  {:<42} {:>10} {:>10} {:>12}\n", "", "worst", "bound", "cases");
  int beyond = 0;
  for (const StressResult& s : r.stress) {
    print("{} {:<42} {:>10.4g} {:>10.4g} {:>12} {}\n", s.beyond > 0 ? "!" : " ", s.operation, s.worst,
          s.bound, s.cases, s.unit);
    if (s.beyond > 0) {
      print("  {} BEYOND: {}\n", s.beyond, s.worst_case);
      ++beyond;
    }
  }
  return beyond;
}

/// Throws: Stop.
BenchmarkOptions make_options(const BenchArguments& a, std::vector<std::string>& notes) {
  BenchmarkOptions out;
  out.quick = a.quick;
  out.stress = a.stress || a.stress_only;
  out.speed = !a.stress_only;
  out.memory = !a.cache_only;
  out.threads = a.threads;
  out.isas = a.isas;
  out.lights = a.lights;
  out.differences = a.differences;
  out.only = a.only;
  out.seed = static_cast<std::uint64_t>(a.seed);
  for (const std::string& file : a.reflectances) {
    const SpectrumTable some = take(find_reflectances(file));
    out.reflectances.insert(out.reflectances.end(), some.spectra.begin(), some.spectra.end());
    notes.insert(notes.end(), some.notes.begin(), some.notes.end());
  }
  const bool show = !a.quiet && !a.json;
  out.progress = [bar = progress_bar("bench", show)](const std::string&, double done) {
    constexpr std::uint64_t kSteps = 1000;
    if (bar && !bar(Progress{static_cast<std::uint64_t>(done * kSteps), kSteps})) return false;
    return !interrupted();
  };
  return out;
}

/// The plot of the job whose reference is spectral, under the first light with lines, or else the first.
std::string make_plot(const BenchmarkReport& r) {
  const MethodSpeed* chosen = nullptr;
  for (const MethodSpeed& w : r.methods) {
    if (w.job != r.methods.back().job) continue;
    if (chosen == nullptr || (w.line_spectrum && !chosen->line_spectrum)) chosen = &w;
  }
  return chosen == nullptr ? std::string() : benchmark_plot(r, chosen->job, chosen->light);
}

int run_bench(const BenchArguments& a) {
  check_outputs({{a.report, "the report (--report)"}, {a.plot, "the plot (--plot)"}},
                named_files(a.reflectances, kReflectancesRole));
  catch_signals();
  std::vector<std::string> notes;
  BenchmarkOptions options = make_options(a, notes);
  if (!a.plot.empty() && (a.stress_only || !a.only.empty())) {
    return complain_usage("--plot draws methods, which neither --only nor --stress-only measures");
  }
  if (a.differences && !a.json) return complain_usage("--differences needs --json, which holds them");
  if (!a.quiet && !a.json) {
    for (const std::string& note : notes) print("note: {}\n", note);
  }
  auto result = run_benchmark(options);
  options.progress = nullptr;  // clears the bar
  const BenchmarkReport report = take(std::move(result));
  if (!a.report.empty()) take(write_text_file(a.report, benchmark_to_html(report)));
  if (!a.plot.empty()) take(write_text_file(a.plot, make_plot(report)));
  int beyond = 0;
  if (a.json) {
    auto json = nlohmann::ordered_json::parse(benchmark_to_json(report));
    json["notes"] = notes;
    print_verbatim(json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
    for (const StressResult& s : report.stress) beyond += s.beyond > 0 ? 1 : 0;
  } else {
    print_machine(report);
    print_operations(report);
    print_baseline(report);
    print_methods(report);
    print_representations(report);
    beyond = print_stress(report);
    print("\n{:.0f} s\n", report.seconds);
  }
  if (beyond == 0) return kOk;
  print_error("spectile: {} operation{} beyond the stated bound\n", beyond, beyond == 1 ? " is" : "s are");
  return kBadInput;
}

}  // namespace

void add_bench(const Command& app, int& exit) {
  const auto [command, a] =
      add_subcommand(app, "bench", "Measure limits, throughput and error on this machine", run_bench, exit);
  command.output_file("--report", a->report, kFilesGroup,
                      "Write the report as one page of HTML, with its plots");
  command.output_file("--plot", a->plot, kFilesGroup,
                      "Write one plot as SVG: error against time of film samples");
  command.option("--reflectances", a->reflectances, "FILE", kFilesGroup,
                 "Measured reflectances to evaluate errors on; the ColorChecker by default");
  constexpr const char* kMeasured = "Measurements";
  command.flag("--quick", a->quick, kMeasured,
               "One or two minutes: the fastest instruction set, fewer methods and rounds");
  const Option stress = command.flag("--stress", a->stress, kMeasured, "Also run the long stress test");
  command.flag("--stress-only", a->stress_only, kMeasured, "Run only the stress test").excludes(stress);
  command.flag("--cache-only", a->cache_only, kMeasured, "Measure in the second-level cache, not in memory");
  command.option("--only", a->only, "TEXT", kMeasured,
                 "Only operations whose name contains this; no methods");
  command
      .option("--illuminant", a->lights, "NAME", kMeasured,
              "Illuminants of the methods; D65,A,FL11,HP1 by default")
      .separated_by(',');
  command
      .option("--threads", a->threads, "N", kMeasured,
              "Numbers of threads; 1, 2, 4 ... up to the cores by default")
      .separated_by(',');
  command.option("--isa", a->isas, "NAME", kMeasured, "Instruction sets; all that run here by default")
      .separated_by(',');
  command.option("--seed", a->seed, "N", kMeasured, "Random seed of the inputs")
      .not_negative()
      .show_default();
  command.flag("--json", a->json, kRunGroup, "Print the whole report as JSON");
  command.flag("--differences", a->differences, kRunGroup,
               "With --json: each reflectance's colour difference by each method too");
  command.flag("-q,--quiet", a->quiet, kRunGroup, "No progress bar");
  command.help_group(kRunGroup);
  command.footer(
      "Example:\n  spectile bench --quick --report bench.html\n"
      "Takes minutes. The report says where other work disturbed it (docs/performance.md).\n"
      "Exit code 1: a result is beyond its stated bound.");
}

}  // namespace spectile::cli
