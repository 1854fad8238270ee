// Places for the labels of a chart's marks: beside them, over nothing.
#include "bench/report/chart/chart_labels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/report/text.hpp"

namespace spectile::report {
namespace {

constexpr double kWidthOfLetter = 0.56;  // of the font size: sans-serif fonts' average letter is 0.5
constexpr double kGap = 3;
constexpr int kDirections = 16;
constexpr double kRings[] = {0, 14};  // beyond the mark, in pixels

bool hits(const Box& box, const std::vector<Box>& other_cores) {
  return std::any_of(other_cores.begin(), other_cores.end(),
                     [&](const Box& other) { return overlap(box, other); });
}

struct Candidate {
  Label label;
  Box box;
};

/// Text whose nearest point is at (x, y), away from the mark in the direction of (dx, dy).
Candidate candidate(double x, double y, double dx, double dy, double width, double font_size) {
  Candidate c;
  double left = x;
  c.label.x = x;
  if (dx < -0.3) {
    left = x - width;
    c.label.x = left + width;
    c.label.anchor = "end";
  } else if (dx <= 0.3) {
    left = x - width / 2;
    c.label.x = left + width / 2;
    c.label.anchor = "middle";
  }
  // Capitals reach about 0.72 of the font size above the base line, tails 0.22 below.
  const double middle = y + dy * font_size / 2;
  c.box = {left, middle - 0.52 * font_size, left + width, middle + 0.52 * font_size};
  c.label.y = middle + 0.34 * font_size;
  return c;
}

}  // namespace

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

double text_width(const std::string& text, double font_size) {
  return kWidthOfLetter * font_size * static_cast<double>(display_width(text));
}

std::optional<Label> LabelPlaces::place(double x, double y, double radius, const std::string& text,
                                        LabelDistance allowed_distance) {
  const double width = text_width(text, font_size_);
  const bool clear = allowed_distance == LabelDistance::kClear;
  std::optional<Candidate> second_best;  // over a line
  for (const double ring : kRings) {
    if (ring > 0 && !clear) break;
    for (int i = 0; i < kDirections; ++i) {
      // Right, up and right, up ... : from the right, both ways round.
      const int step = i % 2 == 0 ? i / 2 : -(i + 1) / 2;
      const double angle = 2 * std::numbers::pi * step / kDirections;
      const double dx = std::cos(angle);
      const double dy = -std::sin(angle);
      const double distance = radius + kGap + ring;
      Candidate c = candidate(x + distance * dx, y + distance * dy, dx, dy, width, font_size_);
      if (c.box.left < inside_.left || c.box.right > inside_.right || c.box.top < inside_.top ||
          c.box.bottom > inside_.bottom || hits(c.box, taken_)) {
        continue;
      }
      c.label.text = text;
      c.label.leader = ring > 0;
      c.label.leader_x = x + (distance - kGap / 2) * dx;
      c.label.leader_y = y + (distance - kGap / 2) * dy;
      if (!hits(c.box, avoided_)) {
        taken_.push_back(c.box);
        return c.label;
      }
      if (!clear && !second_best) second_best = c;
    }
  }
  if (!second_best) return std::nullopt;
  taken_.push_back(second_best->box);
  return second_best->label;
}

}  // namespace spectile::report
