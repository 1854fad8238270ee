// A run of benchmarks, interleaved at random, as a table of speeds with an error and a ratio beside each.
#include "bench/micro/report.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>

namespace report {
namespace {

/// Collects the real time of every repetition by benchmark.
class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      seconds_[run.run_name.function_name].push_back(run.real_accumulated_time /
                                                     static_cast<double>(run.iterations));
    }
  }
  /// Median and half the distance between the quartiles, seconds a call.
  std::pair<double, double> median(const std::string& name) {
    std::vector<double>& s = seconds_[name];
    std::sort(s.begin(), s.end());
    if (s.empty()) return {0, 0};
    return {s[s.size() / 2], 0.5 * (s[s.size() * 3 / 4] - s[s.size() / 4])};
  }

 private:
  std::map<std::string, std::vector<double>> seconds_;
};

std::string verdict(bool met, int& missed) {
  missed += met ? 0 : 1;
  return met ? "met" : "MISSED";
}

int print(Collector& collector, const std::vector<Line>& all, const std::string& heading) {
  fmt::print("{}; medians of interleaved repetitions\n\n", heading);
  fmt::print("{:<28} {:>9} {:>8} {:>8} {:>7} {:>9}  {:<36} {:>7} {:>6}\n", "", "Mitem/s", "ns/item", "GB/s",
             "spread", "error", "compared with", "ratio", "target");
  int missed = 0;
  for (const Line& line : all) {
    const auto [seconds, spread] = collector.median(line.name);
    if (seconds == 0) continue;
    std::string error = "-";
    if (line.error != nullptr) {
      line.run();
      error = fmt::format("{:.1e}", line.error());
    }
    const double ns = seconds / line.items * 1e9;
    fmt::print("{:<28} {:>9.1f} {:>8.2f} {:>8.2f} {:>6.1f}% {:>9}", line.name, line.items / seconds * 1e-6,
               ns, line.bytes / seconds * 1e-9, 100 * spread / seconds, error);
    if (!line.baseline.empty()) {
      const auto other =
          std::find_if(all.begin(), all.end(), [&](const Line& l) { return l.name == line.baseline; });
      const double base = collector.median(line.baseline).first;
      const double ours = (line.by_bytes ? line.bytes : line.items) / seconds;
      const double theirs = (line.by_bytes ? other->bytes : other->items) / base;
      fmt::print("  {:<36} {:>7.2f}", line.baseline + (line.by_bytes ? ", bytes/s" : ", items/s"),
                 ours / theirs);
      if (line.target > 0)
        fmt::print(" {:>6.2f} {}", line.target, verdict(ours / theirs >= line.target, missed));
    }
    if (line.most_ns > 0)
      fmt::print("  at most {:.1f} ns {}", line.most_ns, verdict(ns <= line.most_ns, missed));
    fmt::print("\n");
  }
  return missed == 0 ? 0 : 1;
}

}  // namespace

int run(int argc, char** argv, const std::vector<Line>& lines, const std::string& heading) {
  std::vector<std::string> arguments(argv, argv + argc);
  // Interleaved by default, so that other load on the machine meets all alike.
  arguments.insert(arguments.begin() + 1, {"--benchmark_repetitions=15", "--benchmark_min_time=0.05",
                                           "--benchmark_enable_random_interleaving=true"});
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  if (benchmark::ReportUnrecognizedArguments(count, pointers.data())) return 2;
  for (const Line& line : lines) {
    benchmark::RegisterBenchmark(line.name.c_str(), [run = line.run](benchmark::State& state) {
      for (auto _ : state) {
        run();
        benchmark::ClobberMemory();
      }
    })->UseRealTime();
  }
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  return print(collector, lines, heading);
}

}  // namespace report
