// A logarithmic axis of a chart: where a value lies, and its ticks.
#include "bench/report/chart/log_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/report/text.hpp"

namespace spectile::report {
namespace {

constexpr std::array<int, 3> kSteps = {1, 2, 5};
// Room between the outermost mark and the end of the axis, in decades: half a mark's width at least.
constexpr double kMargin = 0.04;
constexpr double kFewDecades = 2.4;   // up to which 2 and 5 have labels too
constexpr double kSomeDecades = 5.5;  // up to which 2 to 9 have lines
constexpr double kMaxLabels = 8;

double log_of_step(int index) {
  const int decade = static_cast<int>(std::floor(index / 3.0));
  return decade + std::log10(kSteps[static_cast<std::size_t>(index - 3 * decade)]);
}

int step_below(double log) {
  int index = 3 * static_cast<int>(std::floor(log)) + 3;
  while (log_of_step(index) > log) --index;
  return index;
}

/// Written from the exponent, as the value itself may be too large or too small for a double.
std::string tick_label(int mantissa, int exponent) {
  if (exponent >= -4 && exponent <= 5) return number(mantissa * std::pow(10.0, exponent), Zeros::kDrop);
  return (mantissa == 1 ? "" : std::to_string(mantissa) + "×") + power_of_ten(exponent);
}

}  // namespace

LogAxis::LogAxis(double lowest, double highest, double from, double to) : from_(from), to_(to) {
  const int first = step_below(std::log10(lowest) - kMargin);
  int last = step_below(std::log10(highest) + kMargin) + 1;
  last = std::max(last, first + 3);  // a decade, or there would be too few labels to read it by
  low_ = log_of_step(first);
  high_ = log_of_step(last);

  const double decades = high_ - low_;
  const int labelled = std::max(1, static_cast<int>(std::ceil(decades / kMaxLabels)));
  const double slack = 1e-9;
  for (int e = static_cast<int>(std::floor(low_)); e <= high_ + slack; ++e) {
    for (int m = 1; m <= 9; ++m) {
      const double log = e + std::log10(m);
      if (log < low_ - slack || log > high_ + slack) continue;
      if (m > 1 && decades > kSomeDecades) continue;
      const bool has_label = m == 1 ? e % labelled == 0 : decades <= kFewDecades && (m == 2 || m == 5);
      ticks_.push_back({position(log), has_label ? tick_label(m, e) : "", m == 1});
    }
  }
}

double LogAxis::position(double log10_of_value) const {
  return from_ + (log10_of_value - low_) / (high_ - low_) * (to_ - from_);
}

double LogAxis::at(double value) const {
  return position(std::log10(value));
}

}  // namespace spectile::report
