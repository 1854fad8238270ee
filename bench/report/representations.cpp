// The section that sets representations side by side: error against time as the bounces grow.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bench/report/chart/svg_chart.hpp"
#include "bench/report/sections.hpp"
#include "bench/report/table.hpp"

namespace spectile::report {
namespace {

using Rows = std::vector<const RepresentationSpeed*>;

/// Mean errors below this are too small to matter, a thousandth of what can be seen: the chart has them as
/// none.
constexpr double kNoError = 1e-3;

/// Those of a light and a name, by bounces.
Rows representation_rows(const BenchmarkReport& report, const std::string& light, const std::string& name) {
  Rows rows;
  for (const RepresentationSpeed& r : report.representations) {
    if (r.light == light && r.name == name) rows.push_back(&r);
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto* a, const auto* b) { return a->bounces < b->bounces; });
  return rows;
}

Chart make_chart(const BenchmarkReport& report, const std::string& light,
                 const std::vector<std::string>& names) {
  Chart chart;
  chart.title = "Representations, 1 bounce and more; light: " + light;
  chart.description = chart.title + ". Mean CIEDE2000 against nanoseconds a path.";
  chart.x_label = "nanoseconds a path, one thread";
  chart.y_label = "CIEDE2000, mean";
  for (std::size_t i = 0; i < names.size(); ++i) {
    ChartSeries series;
    series.name = names[i];
    series.style = static_cast<int>(i) + 1;
    series.line = true;
    for (const RepresentationSpeed* r : representation_rows(report, light, names[i])) {
      const std::string title = fmt::format("{}, {} bounce{}: {} ns, CIEDE2000 {} mean, {} at most", r->name,
                                            r->bounces, r->bounces == 1 ? "" : "s", number(r->nanoseconds),
                                            number(r->error.mean), number(r->error.maximum));
      const double mean = r->error.mean < kNoError ? 0 : r->error.mean;
      series.marks.push_back({r->nanoseconds, mean, title, "", fmt::format("{}", r->bounces)});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

/// The errors alone, a column for each number of bounces: what a glance is for.
std::string overview(const BenchmarkReport& report, const std::string& light,
                     const std::vector<std::string>& names) {
  std::set<int> bounces;
  for (const RepresentationSpeed& r : report.representations) {
    if (r.light == light) bounces.insert(r.bounces);
  }
  std::vector<std::string> columns = {"representation"};
  for (const int b : bounces) columns.push_back(fmt::format("{} bounce{}", b, b == 1 ? "" : "s"));
  Table table(light + ": CIEDE2000, mean, after so many bounces", columns);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Rows rows = representation_rows(report, light, names[i]);
    if (rows.empty()) continue;
    std::vector<Html> cells = {{mark_in_text(static_cast<int>(i) + 1).code + " " + escaped(names[i])}};
    for (const int b : bounces) {
      const auto found =
          std::find_if(rows.begin(), rows.end(), [&](const auto* r) { return r->bounces == b; });
      cells.push_back(html(found == rows.end() ? kDash : number((*found)->error.mean)));
    }
    table.row(cells);
  }
  return table.code();
}

std::string details(const BenchmarkReport& report, const std::string& light,
                    const std::vector<std::string>& names) {
  Table table(light + ": every measurement. ns: a path, one thread; mean, 95 %, max: CIEDE2000",
              {"representation", "bounces", "ns", "mean", "95 %", "max", "spread", "coefficients", "source"},
              {0, 8});
  std::size_t count = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const RepresentationSpeed* r : representation_rows(report, light, names[i])) {
      table.row({{mark_in_text(static_cast<int>(i) + 1).code + " " + escaped(r->name)},
                 html(fmt::format("{}", r->bounces)),
                 html(number(r->nanoseconds)),
                 html(number(r->error.mean)),
                 html(number(r->error.percentile95)),
                 html(number(r->error.maximum)),
                 html("±" + percent(r->spread)),
                 html(fmt::format("{}", r->coefficients)),
                 html(r->source)});
      ++count;
    }
  }
  return fmt::format("<details><summary>Table: all {} measurements</summary>\n{}</details>\n", count,
                     table.code());
}

}  // namespace

Section representation_section(const BenchmarkReport& report) {
  if (report.representations.empty()) return {};
  const auto names = distinct(report.representations, [](const auto& r) { return r.name; });
  std::string body =
      "<p>A path meets a light, then one material a bounce, and ends as a colour: its products and its "
      "colour are timed, for drawn wavelengths those of all samples, and the colour is compared with that of "
      "the same path computed from the spectra themselves. The number beside a mark is that of the bounces. "
      "Sharpened RGB and spikes are made for the light, bases and trees for the light and the scene's own "
      "materials, planned bands for the light and other materials; <q>RGB to</q> begins with the materials' "
      "RGB "
      "alone.</p>\n";
  for (const std::string& light : distinct(report.representations, [](const auto& r) { return r.light; })) {
    const bool line_spectrum =
        std::any_of(report.representations.begin(), report.representations.end(),
                    [&](const auto& r) { return r.light == light && r.line_spectrum; });
    body += light_head("", light, line_spectrum, make_chart(report, light, names),
                       "Lower and further left is better.");
    body += overview(report, light, names) + details(report, light, names) + "</section>\n";
  }
  return make_section("representations", "Representations", "Representations of light and materials", body);
}

}  // namespace spectile::report
