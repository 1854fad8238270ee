// The charts of a benchmark's report: marks where the axes say, labels over nothing, the frontier as a
// staircase.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>

#include "bench/report/chart/chart_labels.hpp"
#include "bench/report/chart/svg_chart.hpp"
#include "tests/bench/report_support.hpp"

namespace spectile::test {
namespace {

using report::Chart;
using report::ChartForm;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr ChartForm kForms[] = {ChartForm::kWide, ChartForm::kNarrow, ChartForm::kAlone};

std::string attribute(const std::string& tag, const std::string& name) {
  const std::size_t at = tag.find(" " + name + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t first = at + name.size() + 3;
  return tag.substr(first, tag.find('"', first) - first);
}

/// The pieces of an SVG that begin so, each up to its end.
std::vector<std::string> pieces(const std::string& svg, const std::string& from, const std::string& to) {
  std::vector<std::string> out;
  for (std::size_t at = svg.find(from); at != std::string::npos; at = svg.find(from, at + 1)) {
    out.push_back(svg.substr(at, svg.find(to, at) - at));
  }
  return out;
}

struct Point {
  double x, y;
};

/// Positions of marks, by the beginning of their title.
std::map<std::string, Point> marks_of(const std::string& svg) {
  std::map<std::string, Point> out;
  for (const std::string& mark : pieces(svg, "<g class=\"mark", "</title>")) {
    const std::string place = attribute(mark, "transform");
    char* end = nullptr;
    const double x = std::strtod(place.c_str() + place.find('(') + 1, &end);
    const std::string title = mark.substr(mark.find("<title>") + 7);
    out[title.substr(0, title.find(':'))] = {x, std::strtod(end, nullptr)};
  }
  return out;
}

/// Ticks of an axis as its labels say: value to pixel. The text of the vertical axis is set a third of its
/// size below its tick.
std::map<double, double> ticks_of(const std::string& svg, bool horizontal) {
  std::map<double, double> out;
  const double font = std::atof(attribute(svg.substr(svg.find("<svg")), "font-size").c_str());
  for (const std::string& tick : pieces(svg, "<text", "</text>")) {
    if (attribute(tick, "class") != (horizontal ? "tick x" : "tick y")) continue;
    std::string label = tick.substr(tick.find('>') + 1);
    for (std::size_t at = label.find("\u202F"); at != std::string::npos; at = label.find("\u202F"))
      label.erase(at, 3);
    const double value = std::atof(label.c_str());
    out[value] = horizontal ? std::atof(attribute(tick, "x").c_str())
                            : std::atof(attribute(tick, "y").c_str()) - 0.34 * font;
  }
  return out;
}

/// Position of a value according to two labelled ticks.
double expected(const std::map<double, double>& ticks, double from, double to, double value) {
  const double part = (std::log10(value) - std::log10(from)) / (std::log10(to) - std::log10(from));
  return ticks.at(from) + part * (ticks.at(to) - ticks.at(from));
}

Chart chart_with(std::vector<report::ChartMark> marks) {
  Chart chart;
  chart.title = "A chart";
  chart.description = "What it shows";
  chart.x_label = "time";
  chart.y_label = "error";
  chart.series = {{"family", 1, false, std::move(marks)}};
  return chart;
}

TEST(BenchmarkChart, MarksAreWhereTheTicksSay) {
  const Chart chart = chart_with({{0.3, 0.002, "low: ", "", "", false},
                                  {40, 0.07, "middle: ", "", "", false},
                                  {5000, 8, "high: ", "", "", false}});
  for (const ChartForm form : kForms) {
    const std::string svg = report::svg_chart(chart, form);
    const auto marks = marks_of(svg);
    const auto x = ticks_of(svg, true);
    const auto y = ticks_of(svg, false);
    ASSERT_EQ(marks.size(), 3U);
    for (const auto& [name, time, error] :
         {std::tuple{"low", 0.3, 0.002}, std::tuple{"middle", 40.0, 0.07}, std::tuple{"high", 5000.0, 8.0}}) {
      EXPECT_NEAR(marks.at(name).x, expected(x, 1, 100, time), 0.15) << name;
      EXPECT_NEAR(marks.at(name).y, expected(y, 0.01, 1, error), 0.15) << name;
    }
    EXPECT_GT(x.at(100), x.at(1));
    EXPECT_LT(y.at(1), y.at(0.01));  // more is further up
  }
}

TEST(BenchmarkChart, EveryMarkIsWithinThePicture) {
  for (const double scale : {1e-300, 1e-9, 1.0, 1e9, 1e300}) {
    const Chart chart =
        chart_with({{scale, scale, "a: ", "", "", false}, {3 * scale, 2 * scale, "b: ", "", "", false}});
    for (const ChartForm form : kForms) {
      const std::string svg = report::svg_chart(chart, form);
      const std::string box = attribute(svg.substr(svg.find("<svg")), "viewBox");
      const double width = std::atof(box.c_str() + 4);
      const double height = std::atof(box.c_str() + box.rfind(' '));
      for (const auto& [name, at] : marks_of(svg)) {
        EXPECT_TRUE(at.x > 0 && at.x < width && at.y > 0 && at.y < height)
            << scale << name << at.x << ' ' << at.y;
      }
      EXPECT_GE(ticks_of(svg, true).size(), 2U) << scale;
      EXPECT_LE(ticks_of(svg, true).size(), 10U) << scale;
    }
  }
}

TEST(BenchmarkChart, AnErrorOfNoneIsInAStripBelowTheAxis) {
  const Chart chart = chart_with({{1, 0.01, "some: ", "", "", false},
                                  {10, 1, "more: ", "", "", false},
                                  {20, 0, "none: ", "", "", false}});
  const std::string svg = report::svg_chart(chart, ChartForm::kWide);
  const auto marks = marks_of(svg);
  const auto y = ticks_of(svg, false);
  ASSERT_EQ(y.count(0), 1U);
  EXPECT_NEAR(marks.at("none").y, y.at(0), 0.15);
  // Below the end of the axis, which is at 0.005.
  EXPECT_GT(marks.at("none").y, expected(y, 0.01, 1, 0.005) + 5);
  EXPECT_EQ(ticks_of(report::svg_chart(chart_with({{1, 0.01, "", "", "", false}}), ChartForm::kWide), false)
                .count(0),
            0U);
}

TEST(BenchmarkChart, LeavesOutWhatHasNoPlace) {
  const double nan = std::nan("");
  const double infinity = HUGE_VAL;
  EXPECT_EQ(report::svg_chart(chart_with({{nan, 1, "", "", "", true},
                                          {0, 1, "", "", "", true},
                                          {infinity, 1, "", "", "", true},
                                          {1, infinity, "", "", "", true}}),
                              ChartForm::kWide),
            "");
  EXPECT_EQ(report::svg_chart(chart_with({}), ChartForm::kWide), "");
  EXPECT_EQ(
      marks_of(report::svg_chart(chart_with({{nan, 1, "a: ", "", "", true}, {1, 1, "b: ", "", "", true}}),
                                 ChartForm::kWide))
          .size(),
      1U);
}

TEST(BenchmarkChart, TheFrontierIsAStaircaseThroughItsMarks) {
  Chart chart = chart_with(
      {{10, 0.1, "b: ", "", "", true}, {1, 1, "a: ", "", "", true}, {20, 5, "c: ", "", "", false}});
  chart.frontier = "frontier";
  const std::string svg = report::svg_chart(chart, ChartForm::kWide);
  const auto marks = marks_of(svg);
  const auto lines = pieces(svg, "<polyline class=\"frontier\"", ">");
  ASSERT_EQ(lines.size(), 1U);
  const std::string points = attribute(lines[0], "points");
  for (const char* name : {"a", "b"}) {
    EXPECT_THAT(points, HasSubstr(fmt::format("{:.2f},{:.2f}", marks.at(name).x, marks.at(name).y)));
  }
  // Not along the straight line: what lies between is not known.
  EXPECT_THAT(points, HasSubstr(fmt::format("{:.2f},{:.2f}", marks.at("b").x, marks.at("a").y)));
  EXPECT_THAT(points, Not(HasSubstr(fmt::format("{:.2f},{:.2f}", marks.at("c").x, marks.at("c").y))));
}

TEST(BenchmarkChart, StylesDifferInColorAndShape) {
  std::set<std::string> seen;
  std::set<std::string> shapes;
  for (int style = 0; style <= 42; ++style) {
    const std::string code = report::mark_in_text(style).code;
    EXPECT_TRUE(seen.insert(code).second) << style;
    if (style <= 7) shapes.insert(code.substr(code.find("\">", code.find("<g ")) + 2));
  }
  EXPECT_EQ(shapes.size(), 8U);
}

TEST(BenchmarkChart, EscapesItsText) {
  Chart chart = chart_with({{1, 1, "<b>&\"", "<b>&\"", "<b>", true}});
  chart.title = chart.description = chart.x_label = chart.series[0].name = "<b>&\"";
  for (const ChartForm form : kForms) {
    const std::string svg = report::svg_chart(chart, form);
    EXPECT_THAT(svg, Not(HasSubstr("<b>")));
    EXPECT_THAT(svg, HasSubstr("aria-label=\"&lt;b&gt;&amp;&quot;\""));
  }
}

TEST(BenchmarkChart, PlotOfAJobStandsAlone) {
  const BenchmarkReport report = made_up_report();
  const std::string svg = benchmark_plot(report, kMadeUpJobs[0], "FL11");
  EXPECT_THAT(svg, HasSubstr("xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(svg, HasSubstr("role=\"img\""));
  EXPECT_THAT(svg, HasSubstr("<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>"));
  EXPECT_THAT(svg, HasSubstr("nanoseconds a pixel, one thread"));
  EXPECT_EQ(marks_of(svg).size(),
            report.methods.size() / (std::size(kMadeUpJobs) * std::size(kMadeUpLights)));
  // The key of the numbers is below.
  const std::vector<std::string> numbers = pieces(svg, "<text class=\"number\"", "</text>");
  EXPECT_GT(numbers.size(), 3U);
  for (const std::string& number : numbers) {
    const std::string words = number.substr(number.find('>') + 1);
    const std::size_t at = svg.find("<title>" + words + ". ");
    ASSERT_NE(at, std::string::npos) << words;
    const std::size_t first = at + 9 + words.size();
    EXPECT_THAT(svg, HasSubstr(">" + svg.substr(first, svg.find(':', first) - first) + "</text>"));
  }
  // The AoS baseline is the heavy cross, in every chart.
  EXPECT_EQ(pieces(svg, "<g class=\"mark s0\"", ">").size(), 3U);
  EXPECT_EQ(benchmark_plot(report, kMadeUpJobs[0], "no such light"), "");
  EXPECT_EQ(benchmark_plot(report, "no such job", "FL11"), "");
}

TEST(BenchmarkChart, LabelsLieOverNoMarkAndNoOtherLabel) {
  using report::Box;
  const Box inside{0, 0, 300, 200};
  report::LabelPlaces places(inside, 12);
  std::vector<Box> taken;
  std::vector<Point> marks;
  for (int i = 0; i < 40; ++i) marks.push_back({20.0 + 21 * (i % 8), 15.0 + 31 * (i / 8) + 9 * (i % 3)});
  for (const Point& m : marks) taken.push_back({m.x - 6, m.y - 6, m.x + 6, m.y + 6});
  for (const Box& box : taken) places.occupy(box);
  std::size_t placed = 0;
  for (const Point& m : marks) {
    const auto label = places.place(m.x, m.y, 6, "12", report::LabelPlaces::LabelDistance::kBeside);
    if (!label) continue;
    ++placed;
    const double width = report::text_width("12", 12);
    const double left = label->x - (label->anchor[0] == 's'   ? 0
                                    : label->anchor[0] == 'e' ? width
                                                              : width / 2);
    // Digits, from their base line up.
    const Box box{left, label->y - 0.7 * 12, left + width, label->y};
    EXPECT_TRUE(box.left >= 0 && box.right <= 300 && box.top >= 0 && box.bottom <= 200);
    for (const Box& other : taken) EXPECT_FALSE(report::overlap(box, other));
    taken.push_back(box);
  }
  EXPECT_GT(placed, 25U);
  // A name that no place is wide enough for has none.
  EXPECT_FALSE(places.place(150, 100, 6, std::string(80, 'm'), report::LabelPlaces::LabelDistance::kClear));
}

}  // namespace
}  // namespace spectile::test
