// The marks of charts: a colour and a shape for each style, so that neither alone tells series apart.
#include "bench/report/chart/chart_marks.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace spectile::report {
namespace {

// Without its yellow, too pale on white; black is style 0's.
constexpr std::array<const char*, 6> kColors = {"#0072b2", "#d55e00", "#009e73",
                                                "#cc79a7", "#e69f00", "#56b4e9"};
constexpr const char* kBlack = "#000000";
// One shape more than there are colours: styles repeat after 42.
constexpr int kShapes = 7;

std::string polygon(int corners, double radius, double turn, double inner = 1) {
  std::string points;
  const int count = inner < 1 ? 2 * corners : corners;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * (static_cast<double>(i) / count + turn);
    const double r = inner < 1 && i % 2 == 1 ? inner * radius : radius;
    points += fmt::format("{}{:.2f},{:.2f}", i > 0 ? " " : "", r * std::sin(angle), -r * std::cos(angle));
  }
  return fmt::format("<polygon points=\"{}\"/>", points);
}

}  // namespace

std::string style_color(int style) {
  if (style <= 0) return kBlack;
  return kColors[static_cast<std::size_t>(style - 1) % kColors.size()];
}

std::string style_shape(int style, double radius) {
  if (style <= 0) {
    const double r = radius;
    return fmt::format(
        "<path class=\"cross\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2f}\" "
        "d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}M{:.2f} {:.2f}L{:.2f} {:.2f}\"/>",
        kBlack, 0.5 * radius, -r, -r, r, r, -r, r, r, -r);
  }
  switch ((style - 1) % kShapes) {
    case 0:
      return fmt::format("<circle r=\"{:.2f}\"/>", radius);
    case 1:
      return polygon(4, 1.25 * radius, 0.125);  // square
    case 2:
      return polygon(3, 1.45 * radius, 0);
    case 3:
      return polygon(4, 1.35 * radius, 0);  // diamond
    case 4:
      return polygon(3, 1.45 * radius, 0.5);
    case 5:
      return polygon(5, 1.6 * radius, 0, 0.45);  // star
    default:
      return polygon(6, 1.15 * radius, 0);
  }
}

}  // namespace spectile::report
