// The parts of a chart: its title and legend, the marks of its styles, a logarithmic axis.
#include "bench/report/chart/chart_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bench/report/chart/chart_labels.hpp"
#include "bench/report/text.hpp"

namespace spectile::report {
namespace {

constexpr double kLeft = 12;
constexpr double kKeyWidth = 24;
constexpr double kBetween = 14;

// Without its yellow, too pale on white; black is style 0's.
constexpr std::array<const char*, 6> kColors = {"#0072b2", "#d55e00", "#009e73",
                                                "#cc79a7", "#e69f00", "#56b4e9"};
constexpr const char* kBlack = "#000000";
/// A polygon, or a star where its inner corners are nearer; turned by a part of a full turn.
struct Polygon {
  int corners;
  double radius;  ///< over that of a circle of the same area
  double turn;
  double inner = 1;
};
// Square, triangle, diamond, triangle, star, hexagon. With the circle one shape more than there are colours:
// styles repeat after 42.
constexpr std::array<Polygon, 6> kPolygons = {
    {{4, 1.25, 0.125}, {3, 1.45, 0}, {4, 1.35, 0}, {3, 1.45, 0.5}, {5, 1.6, 0, 0.45}, {6, 1.15, 0}}};

std::string polygon(const Polygon& p, double radius) {
  std::string points;
  const int count = p.inner < 1 ? 2 * p.corners : p.corners;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * (static_cast<double>(i) / count + p.turn);
    const double r = p.inner < 1 && i % 2 == 1 ? p.inner * radius : radius;
    points += fmt::format("{}{:.2f},{:.2f}", i > 0 ? " " : "", r * std::sin(angle), -r * std::cos(angle));
  }
  return fmt::format("<polygon points=\"{}\"/>", points);
}

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

Block title_block(const std::string& text, double width, double font_size) {
  Block block;
  std::string line;
  const auto flush = [&] {
    block.height += 1.35 * font_size;
    block.code +=
        fmt::format("<text x=\"{}\" y=\"{:.1f}\" font-size=\"{:.1f}\" font-weight=\"600\">{}</text>\n", kLeft,
                    block.height, font_size, escaped(line));
    line.clear();
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    std::string longer = line;
    if (!line.empty()) longer += ' ';
    longer += word;
    if (!line.empty() && text_width(longer, font_size) > width - 2 * kLeft) {
      flush();
      longer = word;
    }
    line = longer;
    at = end + 1;
  }
  if (!line.empty()) flush();
  block.height += 0.4 * font_size;
  return block;
}

Block legend_block(const std::vector<LegendEntry>& entries, double width, double font_size) {
  Block block;
  if (entries.empty()) return block;
  const double row = 1.45 * font_size;
  double x = kLeft;
  double y = 0.75 * row;
  for (const LegendEntry& entry : entries) {
    const double wide = kKeyWidth + text_width(entry.name, font_size) + kBetween;
    if (x > kLeft && x + wide - kBetween > width) {
      x = kLeft;
      y += row;
    }
    block.code += fmt::format(
        "<g transform=\"translate({:.1f} {:.1f})\">{}</g>\n<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        x + 8, y - 0.34 * font_size, entry.key, x + kKeyWidth, y, escaped(entry.name));
    x += wide;
  }
  block.height = y + 0.6 * row;
  return block;
}

std::string style_color(int style) {
  if (style <= 0) return kBlack;
  return kColors[static_cast<std::size_t>(style - 1) % kColors.size()];
}

std::string style_shape(int style, double radius) {
  if (style <= 0) {
    const double r = radius;
    return fmt::format(
        "<path class=\"cross\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\" d=\"M{:.2f} {:.2f}L{:.2f} "
        "{:.2f}M{:.2f} {:.2f}L{:.2f} {:.2f}\"/>",
        kBlack, 0.5 * radius, -r, -r, r, r, -r, r, r, -r);
  }
  const std::size_t shape = static_cast<std::size_t>(style - 1) % (kPolygons.size() + 1);
  if (shape == 0) return fmt::format("<circle r=\"{:.2f}\"/>", radius);
  const Polygon& p = kPolygons[shape - 1];
  return polygon(p, p.radius * radius);
}

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
