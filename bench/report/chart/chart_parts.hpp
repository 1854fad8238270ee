// The parts of a chart: its title and legend, the marks of its styles, a logarithmic axis.
#pragma once

#include <string>
#include <vector>

namespace spectile::report {

/// SVG of a given height, drawn from y = 0 down.
struct Block {
  std::string code;
  double height = 0;
};

struct LegendEntry {
  std::string name;
  std::string key;  ///< SVG round (0, 0), about a font size large
};

/// Text broken between words, in a font of this size.
Block title_block(const std::string& text, double width, double font_size);
/// Entries from left to right, in as many rows as they need.
Block legend_block(const std::vector<LegendEntry>& entries, double width, double font_size);

/// "#0072b2": of the palette of Okabe and Ito, "Color Universal Design", 2008, which most eyes can tell
/// apart.
std::string style_color(int style);

/// Shape round (0, 0), its outline included; `radius`: about that of a circle of the same area.
std::string style_shape(int style, double radius);

/// A logarithmic axis: where a value lies, and its ticks.
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
