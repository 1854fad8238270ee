// A logarithmic axis of a chart: where a value lies, and its ticks.
#pragma once

#include <string>
#include <vector>

namespace spectile::report {

class LogAxis {
 public:
  struct Tick {
    double at = 0;      ///< pixel
    std::string label;  ///< empty for a line without one
    bool decade = false;
  };

  /// From pixel to pixel; the ends move out to the next 1, 2 or 5 of a decade. Needs 0 < lowest <= highest,
  /// both finite.
  LogAxis(double lowest, double highest, double from, double to);

  double at(double value) const;
  const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  double position(double log10_of_value) const;

  double low_, high_;  ///< log10 of the ends
  double from_, to_;
  std::vector<Tick> ticks_;
};

}  // namespace spectile::report
