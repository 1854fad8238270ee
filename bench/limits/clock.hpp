// Timing of several things in turn, and what else the machine was doing meanwhile.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace spectile::measure {

/// A piece of work and how long it takes.
struct Timed {
  std::function<void()> run;
  double seconds = 0;          ///< median, of one run
  double spread = 0;           ///< half the range of the middle half, over the median
  std::size_t repeats = 0;     ///< runs that are timed together
  std::vector<double> rounds;  ///< seconds of one run, round by round
};

/// Rounds of a timing and their length.
struct TimingBudget {
  int rounds = 9;
  double min_seconds = 2e-3;   ///< that are timed at once
  std::function<bool()> stop;  ///< asked between runs; true leaves the rest out, and the results are void
};

/// Runs each a first time, then all of them in turn, round by round, so that a change of the machine's speed
/// meets all of them alike.
void time_in_turn(std::span<Timed* const> work, const TimingBudget& timing);

/// The median of a / b, round by round: what is left of a ratio when both drift together.
double median_ratio(const Timed& a, const Timed& b);

/// Watches for work of others while it exists.
class LoadMonitor {
 public:
  LoadMonitor();
  /// Cores that others kept busy since the start, on average; below 0 where the system does not say.
  double other_cores() const;

 private:
  double start_seconds_;
  double start_busy_;  ///< seconds of all cores, below 0 where unknown
  double start_own_;
};

}  // namespace spectile::measure
