// Timing of several things in turn, and what else the machine was doing meanwhile.
#include "bench/limits/clock.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

namespace spectile::measure {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double run_for(const Timed& work, std::size_t repeats) {
  const double start = now();
  for (std::size_t i = 0; i < repeats; ++i) work.run();
  return now() - start;
}

/// Quantile of sorted numbers, between them linearly.
double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  if (i + 1 >= sorted.size()) return sorted.back();
  return sorted[i] + (at - static_cast<double>(i)) * (sorted[i + 1] - sorted[i]);
}

void summarize(Timed& work) {
  if (work.rounds.empty()) return;
  std::vector<double> sorted = work.rounds;
  std::sort(sorted.begin(), sorted.end());
  work.seconds = quantile(sorted, 0.5);
  work.spread = 0.5 * (quantile(sorted, 0.75) - quantile(sorted, 0.25)) / work.seconds;
}

double to_seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

double own_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return to_seconds(usage.ru_utime) + to_seconds(usage.ru_stime);
}

/// Seconds that all cores together have been busy or taken away by the host since the system started; -1
/// where Linux's /proc/stat is missing. Source: proc(5).
double busy_seconds() {
  std::ifstream file("/proc/stat");
  std::string cpu;
  if (!(file >> cpu) || cpu != "cpu") return -1;
  // User, nice, system, idle, waiting, interrupts, soft interrupts, stolen.
  double ticks = 0;
  for (int i = 0; i < 8; ++i) {
    double more = 0;
    if (!(file >> more)) return -1;
    if (i != 3 && i != 4) ticks += more;
  }
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace

void time_in_turn(std::span<Timed* const> work, const TimingBudget& timing) {
  const auto stopped = [&] { return timing.stop && timing.stop(); };
  for (Timed* w : work) {
    if (stopped()) return;
    // The first run touches memory; then as many at a time as take long enough for the clock.
    static_cast<void>(run_for(*w, 1));
    std::size_t repeats = 1;
    double took = run_for(*w, repeats);
    while (took < 0.5 * timing.min_seconds) {
      const double more = took > 0 ? timing.min_seconds / took : 16.0;
      repeats =
          static_cast<std::size_t>(std::ceil(static_cast<double>(repeats) * std::clamp(more, 1.5, 16.0)));
      took = run_for(*w, repeats);
    }
    w->repeats = repeats;
    w->rounds.clear();
  }
  for (int round = 0; round < timing.rounds; ++round) {
    if (stopped()) break;
    for (Timed* w : work) {
      w->rounds.push_back(run_for(*w, w->repeats) / static_cast<double>(w->repeats));
    }
  }
  for (Timed* w : work) summarize(*w);
}

double median_ratio(const Timed& a, const Timed& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(a.rounds.size(), b.rounds.size()); ++i) {
    ratios.push_back(a.rounds[i] / b.rounds[i]);
  }
  if (ratios.empty()) return 0;
  std::sort(ratios.begin(), ratios.end());
  return quantile(ratios, 0.5);
}

LoadMonitor::LoadMonitor() : start_seconds_(now()), start_busy_(busy_seconds()), start_own_(own_seconds()) {}

double LoadMonitor::other_cores() const {
  const double busy = busy_seconds();
  const double wall = now() - start_seconds_;
  if (busy < 0 || start_busy_ < 0 || wall <= 0) return -1;
  return std::max(0.0, (busy - start_busy_) - (own_seconds() - start_own_)) / wall;
}

}  // namespace spectile::measure
