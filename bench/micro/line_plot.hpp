// A picture of panels side by side, each with lines over two logarithmic axes, as SVG.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct PlotLine {
  std::string color;  ///< as SVG has it
  bool dashed = false;
  bool thin = false;  ///< a guide, without marks
  std::vector<double> x, y;
};

struct PlotPanel {
  std::string title;
  std::vector<PlotLine> lines;
};

struct PlotKey {
  std::string label;
  PlotLine like;
};

struct Plot {
  std::string title, x_label, y_label;
  double x0 = 1, x1 = 10, y0 = 0.1, y1 = 1;  ///< ends of the axes
  std::vector<PlotKey> keys;
  std::vector<PlotPanel> panels;  ///< two a row
};

std::string to_svg(const Plot& plot);

}  // namespace bench
