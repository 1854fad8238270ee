// A chart with two logarithmic axes as SVG: marks of several series, a frontier, a legend, labels beside
// marks.
#pragma once

#include <string>
#include <vector>

#include "bench/report/text.hpp"

namespace spectile::report {

struct ChartMark {
  double x = 0;        ///< above 0, or it is left out
  double y = 0;        ///< 0 or less is drawn in a strip of its own below the axis
  std::string title;   ///< all about it, for hovering
  std::string label;   ///< beside it where there is room: a name
  std::string number;  ///< else this, which is short
  bool frontier = false;
};

struct ChartSeries {
  std::string name;
  /// Colour and shape. 0 is the heavy black cross, for what the others are compared with.
  int style = 1;
  bool line = false;  ///< joins its marks
  std::vector<ChartMark> marks;
};

struct Chart {
  std::string title;        ///< what was done; written out where the chart stands alone
  std::string description;  ///< in place of the picture, for those who cannot see it
  std::string x_label, y_label;
  std::string frontier;  ///< the legend of its line; empty for none
  std::vector<ChartSeries> series;
};

enum class ChartForm {
  kWide,    ///< inside a page, some 900 pixels wide
  kNarrow,  ///< inside a page on a small screen
  kAlone,   ///< a file: with its title, a name space and a white background
};

/// Empty where no mark can be drawn.
std::string svg_chart(const Chart& chart, ChartForm form);

/// The mark of a style for use in text.
Html mark_in_text(int style);

}  // namespace spectile::report
