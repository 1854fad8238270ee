// A chart with two logarithmic axes as SVG: marks of several series, a frontier, a legend, labels beside
// marks.
#include "bench/report/chart/svg_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bench/report/chart/chart_labels.hpp"
#include "bench/report/chart/chart_parts.hpp"

namespace spectile::report {
namespace {

constexpr const char* kInk = "#1b1f24";
constexpr const char* kGrid = "#d5dae0";
constexpr const char* kOutline = "#30363d";
constexpr const char* kFrontier = "#5b6470";
constexpr double kMarkExtent = 1.25;  // of a mark, over its radius: corners stand out
constexpr double kZeroStrip = 30;     // pixels below the axis, for errors of 0

struct Format {
  double width, font, plot_height, left, radius;
};

/// Widths are those of the view box: on the screen a pixel of the narrow form is about a pixel at 400.
Format chart_format(ChartForm form) {
  if (form == ChartForm::kNarrow) return {400, 13.5, 330, 50, 5.2};
  return {960, 15, 430, 70, 6};
}

/// A mark with its place.
struct Placed {
  const ChartMark* mark;
  int style;
  double x, y, radius;
};

bool drawable(const ChartMark& mark) {
  return std::isfinite(mark.x) && mark.x > 0 && std::isfinite(mark.y);
}

class Drawing {
 public:
  Drawing(const Chart& chart, ChartForm form)
      : chart_(chart), form_(form), f_(chart_format(form)), line_height_(1.45 * f_.font) {}

  std::string svg();

 private:
  bool range();
  void add(const Block& block);
  void head();
  void axes();
  void frontier();
  void series_lines();
  void labels();
  void foot(std::vector<const Placed*> numbered);
  void marks();
  double vertical(double value) const { return value > 0 ? y_axis_->at(value) : zero_y_; }
  void text(double x, double y, const char* anchor, const std::string& words, const char* more = "");

  const Chart& chart_;
  ChartForm form_;
  Format f_;
  double line_height_;
  double lowest_x_ = 0, highest_x_ = 0, lowest_y_ = 0, highest_y_ = 0;
  bool zeros_ = false;
  double top_ = 0, bottom_ = 0, right_ = 0, zero_y_ = 0, height_ = 0;
  std::optional<LogAxis> x_axis_, y_axis_;
  std::vector<Placed> placed_;
  std::vector<std::pair<double, double>> staircase_;
  std::string body_;
};

void Drawing::text(double x, double y, const char* anchor, const std::string& words, const char* more) {
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                       escaped(words));
}

/// Places the marks; false if there are none.
bool Drawing::range() {
  bool any = false;
  bool any_above = false;
  for (const ChartSeries& series : chart_.series) {
    for (const ChartMark& mark : series.marks) {
      if (!drawable(mark)) continue;
      lowest_x_ = any ? std::min(lowest_x_, mark.x) : mark.x;
      highest_x_ = any ? std::max(highest_x_, mark.x) : mark.x;
      any = true;
      if (mark.y <= 0) {
        zeros_ = true;
        continue;
      }
      lowest_y_ = any_above ? std::min(lowest_y_, mark.y) : mark.y;
      highest_y_ = any_above ? std::max(highest_y_, mark.y) : mark.y;
      any_above = true;
    }
  }
  if (any && !any_above) lowest_y_ = highest_y_ = 1;
  return any;
}

/// Below what there is so far.
void Drawing::add(const Block& block) {
  body_ += fmt::format("<g transform=\"translate(0 {:.1f})\">\n{}</g>\n", height_, block.code);
  height_ += block.height;
}

/// Title and legend, above the plot.
void Drawing::head() {
  height_ = 6;
  if (form_ == ChartForm::kAlone) add(title_block(chart_.title, f_.width, 1.15 * f_.font));
  std::vector<LegendEntry> entries;
  for (const ChartSeries& series : chart_.series) {
    if (std::none_of(series.marks.begin(), series.marks.end(), drawable)) continue;
    entries.push_back({series.name, fmt::format("<g fill=\"{}\" stroke=\"{}\" stroke-width=\"0.8\">{}</g>",
                                                style_color(series.style), kOutline,
                                                style_shape(series.style, f_.radius))});
  }
  if (!chart_.frontier.empty()) {
    entries.push_back(
        {chart_.frontier,
         fmt::format(
             "<path class=\"frontier\" d=\"M-9 0H9\" fill=\"none\" stroke=\"{}\" stroke-width=\"2.5\"/>",
             kFrontier)});
  }
  add(legend_block(entries, f_.width, f_.font));
}

/// The axes, and the places of the marks between them.
void Drawing::axes() {
  height_ += line_height_;
  text(12, height_ - 0.2 * f_.font, "start", "↑ " + chart_.y_label);
  top_ = height_ + 0.8 * f_.font;
  bottom_ = top_ + f_.plot_height;
  right_ = f_.width - 16;
  x_axis_.emplace(lowest_x_, highest_x_, f_.left, right_);
  y_axis_.emplace(lowest_y_, highest_y_, bottom_, top_);
  const double foot = bottom_ + (zeros_ ? kZeroStrip : 0);
  zero_y_ = bottom_ + 0.6 * kZeroStrip;

  std::string lines;
  const auto line = [&](double x1, double y1, double x2, double y2, bool strong) {
    lines += fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke-width=\"{}\"/>\n",
                         strong ? "grid" : "grid fine", x1, y1, x2, y2, strong ? "1.2" : "0.5");
  };
  for (const auto& tick : x_axis_->ticks()) line(tick.at, top_, tick.at, foot, tick.decade);
  for (const auto& tick : y_axis_->ticks()) line(f_.left, tick.at, right_, tick.at, tick.decade);
  if (zeros_) line(f_.left, foot, right_, foot, true);
  body_ += fmt::format("<g fill=\"none\" stroke=\"{}\">\n{}</g>\n", kGrid, lines);

  const double base = foot + 1.3 * f_.font;
  for (const auto& tick : x_axis_->ticks()) {
    if (!tick.label.empty()) text(tick.at, base, "middle", tick.label, " class=\"tick x\"");
  }
  for (const auto& tick : y_axis_->ticks()) {
    if (!tick.label.empty()) {
      text(f_.left - 6, tick.at + 0.34 * f_.font, "end", tick.label, " class=\"tick y\"");
    }
  }
  if (zeros_) text(f_.left - 6, zero_y_ + 0.34 * f_.font, "end", "0", " class=\"tick y\"");
  text(right_, base + line_height_, "end", chart_.x_label + " →");
  height_ = base + line_height_ + 0.5 * f_.font;
  for (const ChartSeries& series : chart_.series) {
    for (const ChartMark& mark : series.marks) {
      if (!drawable(mark)) continue;
      const double radius = series.style == 0 ? 1.1 * f_.radius : f_.radius;
      placed_.push_back({&mark, series.style, x_axis_->at(mark.x), vertical(mark.y), radius});
    }
  }
}

/// The Pareto frontier: a staircase, as nothing is known between two marks.
void Drawing::frontier() {
  if (chart_.frontier.empty()) return;
  std::vector<std::pair<double, double>> corners;
  for (const Placed& p : placed_) {
    if (p.mark->frontier) corners.emplace_back(p.x, p.y);
  }
  if (corners.empty()) return;
  std::sort(corners.begin(), corners.end());
  staircase_.emplace_back(corners.front().first, top_);
  for (const auto& [x, y] : corners) {
    staircase_.emplace_back(x, staircase_.back().second);
    staircase_.emplace_back(x, y);
  }
  staircase_[1] = staircase_[0];  // the first step comes down from the top
  staircase_.emplace_back(right_, staircase_.back().second);
  std::string points;
  for (const auto& [x, y] : staircase_) points += fmt::format(" {:.2f},{:.2f}", x, y);
  body_ += fmt::format(
      "<polyline class=\"frontier\" fill=\"none\" stroke=\"{}\" stroke-width=\"2.5\" stroke-opacity=\"0.75\" "
      "points=\"{}\"/>\n",
      kFrontier, points.substr(1));
}

void Drawing::series_lines() {
  for (const ChartSeries& series : chart_.series) {
    if (!series.line) continue;
    std::string points;
    for (const ChartMark& mark : series.marks) {
      if (drawable(mark)) points += fmt::format(" {:.2f},{:.2f}", x_axis_->at(mark.x), vertical(mark.y));
    }
    if (points.empty()) continue;
    body_ += fmt::format(
        "<polyline class=\"s{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" points=\"{}\"/>\n",
        series.style, style_color(series.style), points.substr(1));
  }
}

void Drawing::labels() {
  LabelPlaces places({f_.left + 2, top_ + 2, right_ - 2, bottom_ + (zeros_ ? kZeroStrip : 0) - 2}, f_.font);
  for (const Placed& p : placed_) {
    const double r = kMarkExtent * p.radius + 1;
    places.occupy({p.x - r, p.y - r, p.x + r, p.y + r});
  }
  for (std::size_t i = 1; i < staircase_.size(); ++i) {
    const auto [x1, y1] = staircase_[i - 1];
    const auto [x2, y2] = staircase_[i];
    places.avoid({std::min(x1, x2) - 2, std::min(y1, y2) - 2, std::max(x1, x2) + 2, std::max(y1, y2) + 2});
  }
  std::string leaders;
  std::string words;
  const auto write = [&](const Placed& p, const Label& label) {
    if (label.leader) {
      leaders += fmt::format("<path class=\"leader\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", p.x, p.y,
                             label.leader_x, label.leader_y);
    }
    words += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", label.x, label.y,
                         label.anchor, escaped(label.text));
  };
  // Names first, of what matters most; what finds no room for its name has its number, or the table below. A
  // name must not cover the frontier; a number, being short, may.
  std::vector<const Placed*> unnamed;
  std::vector<const Placed*> numbered;
  for (const bool frontier : {true, false}) {
    for (const Placed& p : placed_) {
      const bool named = !p.mark->label.empty() && (p.mark->frontier || p.style == 0);
      if (p.mark->frontier != frontier) continue;
      const auto label = named ? places.place(p.x, p.y, kMarkExtent * p.radius, p.mark->label,
                                              LabelPlaces::LabelDistance::kClear)
                               : std::nullopt;
      if (label) {
        write(p, *label);
      } else {
        unnamed.push_back(&p);
      }
    }
  }
  for (const Placed* p : unnamed) {
    if (p->mark->number.empty()) continue;
    const auto label = places.place(p->x, p->y, kMarkExtent * p->radius, p->mark->number,
                                    LabelPlaces::LabelDistance::kBeside);
    if (!label) continue;
    write(*p, *label);
    numbered.push_back(p);
  }
  if (form_ == ChartForm::kAlone) foot(numbered);
  body_ += fmt::format("<g fill=\"none\" stroke=\"{}\" stroke-width=\"0.8\">\n{}</g>\n", kFrontier, leaders);
  body_ += fmt::format(
      "<g class=\"halo\" stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" "
      "paint-order=\"stroke\">\n"
      "{}</g>\n",
      words);
}

/// Key of the numbers, where there is no table.
void Drawing::foot(std::vector<const Placed*> numbered) {
  std::stable_sort(numbered.begin(), numbered.end(),
                   [](const Placed* a, const Placed* b) { return a->x < b->x; });
  std::vector<LegendEntry> entries;
  for (const Placed* p : numbered) {
    if (p->mark->label.empty()) continue;
    entries.push_back(
        {p->mark->label,
         fmt::format(
             "<text class=\"number\" x=\"10\" y=\"{:.1f}\" text-anchor=\"end\" font-weight=\"600\">{}</text>",
             0.34 * f_.font, escaped(p->mark->number))});
  }
  height_ += 0.4 * f_.font;
  add(legend_block(entries, f_.width, f_.font));
}

void Drawing::marks() {
  for (const Placed& p : placed_) {
    body_ += fmt::format(
        "<g class=\"mark s{}\" transform=\"translate({:.2f} {:.2f})\" fill=\"{}\" stroke=\"{}\" "
        "stroke-width=\"{}\"><title>{}</title>{}</g>\n",
        p.style, p.x, p.y, style_color(p.style), kOutline, p.mark->frontier ? "2" : "0.8",
        escaped(p.mark->title), style_shape(p.style, p.radius));
  }
}

std::string Drawing::svg() {
  if (!range()) return {};
  head();
  axes();
  frontier();
  series_lines();
  labels();
  marks();
  const bool alone = form_ == ChartForm::kAlone;
  const char* name = alone ? "alone" : form_ == ChartForm::kWide ? "wide" : "narrow";
  return fmt::format(
      "<svg{} class=\"chart {}\" viewBox=\"0 0 {:.0f} {:.0f}\"{} role=\"img\" aria-label=\"{}\" "
      "font-family=\"system-ui, 'DejaVu Sans', Arial, sans-serif\" font-size=\"{}\">\n{}<g class=\"ink\" "
      "fill=\"{}\">\n{}</g>\n</svg>\n",
      alone ? " xmlns=\"http://www.w3.org/2000/svg\"" : "", name, f_.width, height_,
      alone ? fmt::format(" width=\"{:.0f}\" height=\"{:.0f}\"", f_.width, height_) : "",
      escaped(chart_.description), f_.font,
      alone ? "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n" : "", kInk, body_);
}

}  // namespace

std::string svg_chart(const Chart& chart, ChartForm form) {
  return Drawing(chart, form).svg();
}

Html mark_in_text(int style) {
  return {
      fmt::format("<svg class=\"key\" viewBox=\"-9 -9 18 18\" aria-hidden=\"true\"><g fill=\"{}\" "
                  "stroke=\"{}\" stroke-width=\"0.8\">{}</g></svg>",
                  style_color(style), kOutline, style_shape(style, 5))};
}

}  // namespace spectile::report
