// A picture of panels side by side, each with lines over two logarithmic axes, as SVG.
#include "bench/micro/line_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bench {
namespace {

// Pixels. Wide enough for two panels with 12-pixel figures, and for a page's column.
constexpr double kWidth = 900;
constexpr double kHeight = 620;
constexpr double kLeft = 72;
constexpr double kRight = 18;
constexpr double kTop = 84;
constexpr double kBottom = 56;
constexpr double kBetweenRows = 44;
constexpr double kBetweenColumns = 60;

struct Box {
  double x, y, width, height;
};

/// Where a panel's numbers lie in the picture.
struct Scale {
  const Plot& plot;
  Box box;
  double x(double v) const { return box.x + box.width * std::log(v / plot.x0) / std::log(plot.x1 / plot.x0); }
  double y(double v) const {
    return box.y + box.height * std::log(plot.y1 / v) / std::log(plot.y1 / plot.y0);
  }
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string text(double x, double y, const char* anchor, int size, const std::string& what,
                 const std::string& more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\"{}>{}</text>\n", x,
                     y, anchor, size, more, what);
}

std::string segment(double x0, double y0, double x1, double y1, const std::string& stroke) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x0, y0, x1, y1,
                     stroke);
}

std::string stroke_of(const PlotLine& line) {
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}", line.color, line.thin ? 1 : 2,
                     line.thin     ? " stroke-dasharray=\"2 3\""
                     : line.dashed ? " stroke-dasharray=\"7 4\""
                                   : "");
}

/// 10 to the power, or the number itself where that is short.
std::string decade(int power) {
  if (power >= 0 && power <= 3) return fmt::format("{:.0f}", std::pow(10.0, power));
  if (power < 0 && power >= -3) return fmt::format("{:.{}f}", std::pow(10.0, power), -power);
  return fmt::format("10<tspan dy=\"-5\" font-size=\"10\">{}</tspan>", power);
}

std::string grid(const Scale& s) {
  std::string out;
  const Box& b = s.box;
  const auto ruled = [](double low, double high, const auto& rule) {
    for (int power = static_cast<int>(std::floor(std::log10(low))); power <= std::log10(high); ++power) {
      for (int digit = 1; digit < 10; ++digit) {
        const double v = digit * std::pow(10.0, power);
        if (v >= low * 0.999 && v <= high * 1.001) rule(v, digit == 1, power);
      }
    }
  };
  const auto stroke = [](bool major) { return major ? "stroke=\"#cfcfcf\"" : "stroke=\"#efefef\""; };
  ruled(s.plot.x0, s.plot.x1, [&](double v, bool major, int power) {
    out += segment(s.x(v), b.y, s.x(v), b.y + b.height, stroke(major));
    if (major) out += text(s.x(v), b.y + b.height + 16, "middle", 12, decade(power));
  });
  ruled(s.plot.y0, s.plot.y1, [&](double v, bool major, int power) {
    out += segment(b.x, s.y(v), b.x + b.width, s.y(v), stroke(major));
    if (major) out += text(b.x - 7, s.y(v) + 4, "end", 12, decade(power));
  });
  return out + fmt::format(
                   "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
                   "stroke=\"#808080\"/>\n",
                   b.x, b.y, b.width, b.height);
}

std::string curve(const Scale& s, const PlotLine& line) {
  std::string points;
  std::string marks;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    const double x = s.x(line.x[i]);
    const double y = s.y(line.y[i]);
    points += fmt::format("{:.1f},{:.1f} ", x, y);
    if (!line.thin)
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.4\" fill=\"{}\"/>\n", x, y, line.color);
  }
  return fmt::format("<polyline points=\"{}\" {}/>\n", points, stroke_of(line)) + marks;
}

std::string key_row(const Plot& plot) {
  // A letter of the size of a key takes about so much.
  constexpr double kLetter = 7.6;
  constexpr double kSample = 36;
  constexpr double kApart = 18;
  const auto letters = [](const std::string& label) {
    // Bytes that continue a character of UTF-8 are no letters.
    return std::count_if(label.begin(), label.end(),
                         [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
  };
  const auto width = [&](const PlotKey& key) {
    return kSample + kLetter * static_cast<double>(letters(key.label)) + kApart;
  };
  double all = -kApart;
  for (const PlotKey& key : plot.keys) all += width(key);
  double x = (kWidth - all) / 2;
  std::string out;
  for (const PlotKey& key : plot.keys) {
    out += segment(x, 48, x + 30, 48, stroke_of(key.like));
    out += text(x + kSample, 52, "start", 13, escaped(key.label));
    x += width(key);
  }
  return out;
}

}  // namespace

std::string to_svg(const Plot& plot) {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\" fill=\"#202020\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      kWidth, kHeight);
  out += text(kWidth / 2, 26, "middle", 17, escaped(plot.title));
  out += key_row(plot);
  const std::size_t rows = (plot.panels.size() + 1) / 2;
  const double width = (kWidth - kLeft - kRight - kBetweenColumns) / 2;
  const double height =
      (kHeight - kTop - kBottom - kBetweenRows * static_cast<double>(rows - 1)) / static_cast<double>(rows);
  for (std::size_t p = 0; p < plot.panels.size(); ++p) {
    const Scale s{plot,
                  {kLeft + static_cast<double>(p % 2) * (width + kBetweenColumns),
                   kTop + static_cast<double>(p / 2) * (height + kBetweenRows), width, height}};
    out += grid(s);
    out +=
        text(s.box.x + 4, s.box.y - 6, "start", 14, escaped(plot.panels[p].title), " font-weight=\"bold\"");
    for (const PlotLine& line : plot.panels[p].lines) out += curve(s, line);
  }
  out += text(kLeft + (kWidth - kLeft - kRight) / 2, kHeight - 14, "middle", 14, escaped(plot.x_label));
  const double middle = kTop + (kHeight - kTop - kBottom) / 2;
  out += text(20, middle, "middle", 14, escaped(plot.y_label),
              fmt::format(" transform=\"rotate(-90 20 {:.1f})\"", middle));
  return out + "</svg>\n";
}

}  // namespace bench
