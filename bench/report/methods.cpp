// The sections that show error against time, one for each job, with a chart and a table for each light.
#include <fmt/format.h>

#include <algorithm>

#include "bench/report/sections.hpp"
#include "bench/report/svg_chart.hpp"
#include "bench/report/table.hpp"

namespace spectile::report {
namespace {

constexpr const char* kTextbook = "textbook";

/// A way, with its place among those of its job and light: the fastest is number 1.
struct Numbered {
  const WaySpeed* way;
  int number;
};

std::vector<Numbered> ways_of(const BenchmarkReport& report, const std::string& job,
                              const std::string& light) {
  std::vector<const WaySpeed*> ways;
  for (const WaySpeed& way : report.ways) {
    if (way.job == job && way.light == light) ways.push_back(&way);
  }
  // Times that are no numbers last: comparing them would be no order.
  const auto known = std::stable_partition(
      ways.begin(), ways.end(), [](const WaySpeed* w) { return w->nanoseconds == w->nanoseconds; });
  std::stable_sort(ways.begin(), known,
                   [](const WaySpeed* a, const WaySpeed* b) { return a->nanoseconds < b->nanoseconds; });
  std::vector<Numbered> out;
  out.reserve(ways.size());
  for (const WaySpeed* way : ways) out.push_back({way, static_cast<int>(out.size()) + 1});
  return out;
}

/// The same in every chart of a report.
std::vector<std::string> families_of(const BenchmarkReport& report) {
  std::vector<std::string> families = {kTextbook};
  for (const std::string& family : distinct(report.ways, [](const WaySpeed& w) { return w.family; })) {
    if (family != kTextbook) families.push_back(family);
  }
  return families;
}

int style_of(const std::vector<std::string>& families, const std::string& family) {
  return static_cast<int>(std::find(families.begin(), families.end(), family) - families.begin());
}

/// A job's name: what stands before its truth.
std::string head_of(const std::string& job) {
  return job.substr(0, job.find(';'));
}

std::string light_in_words(const std::string& light, bool spiky) {
  return spiky ? light + " (a light with lines)" : light;
}

Chart chart_of(const std::vector<Numbered>& ways, const std::vector<std::string>& families) {
  const WaySpeed& first = *ways.front().way;
  Chart chart;
  chart.title = fmt::format("{}; light: {}", first.job, light_in_words(first.light, first.spiky));
  chart.x_label = "nanoseconds a pixel, one thread";
  chart.y_label = "CIEDE2000, mean";
  chart.frontier = "frontier";
  std::string best;
  for (std::size_t family = 0; family < families.size(); ++family) {
    ChartSeries series;
    series.name = families[family].empty() ? "other" : families[family];
    series.style = static_cast<int>(family);
    for (const auto& [way, place] : ways) {
      if (way->family != families[family]) continue;
      ChartMark mark;
      mark.x = way->nanoseconds;
      mark.y = way->error.mean;
      mark.title = fmt::format("{}. {}: {} ns, CIEDE2000 {} mean, {} at most{}", place, way->name,
                               number(way->nanoseconds), number(way->error.mean), number(way->error.maximum),
                               way->frontier ? "; on the frontier" : "");
      mark.label = way->name;
      mark.number = fmt::format("{}", place);
      mark.frontier = way->frontier;
      series.marks.push_back(std::move(mark));
    }
    chart.series.push_back(std::move(series));
  }
  for (const auto& [way, place] : ways) {
    if (!way->frontier) continue;
    best += fmt::format("{}{} ({} ns, {})", best.empty() ? "" : ", ", way->name, number(way->nanoseconds),
                        number(way->error.mean));
  }
  chart.description =
      fmt::format("{}. Mean CIEDE2000 against nanoseconds a pixel of {} ways{}{}.", chart.title, ways.size(),
                  best.empty() ? "" : "; on the frontier, the fastest first: ", best);
  return chart;
}

Html name_cell(const Numbered& entry, int style) {
  const WaySpeed& way = *entry.way;
  std::string code = fmt::format("<span class=\"no\">{}</span> {} {}", entry.number, mark_in_text(style).code,
                                 escaped(way.name));
  if (way.frontier) code += " <span class=\"badge best\">★ frontier</span>";
  if (way.family == kTextbook) code += " <span class=\"badge\">textbook</span>";
  return {code};
}

std::string table_of(const std::vector<Numbered>& ways, const std::vector<std::string>& families) {
  const WaySpeed& first = *ways.front().way;
  Table table(
      fmt::format("{}, {}: every way, the fastest first. ns: a pixel, one thread; mean, 95 %, max: CIEDE2000",
                  head_of(first.job), first.light),
      {{"way", true},
       {"ns"},
       {"mean"},
       {"95 %"},
       {"max"},
       {"spread"},
       {"bands"},
       {"bytes a pixel"},
       {"family", true}});
  for (const Numbered& entry : ways) {
    const WaySpeed& w = *entry.way;
    table.row({name_cell(entry, style_of(families, w.family)), html(number(w.nanoseconds)),
               html(number(w.error.mean)), html(number(w.error.percentile95)), html(number(w.error.maximum)),
               html("±" + percent(w.spread)), html(w.bands > 0 ? fmt::format("{}", w.bands) : kDash),
               html(w.bytes > 0 ? count_text(w.bytes) : kDash), html(w.family)},
              w.frontier              ? "best"
              : w.family == kTextbook ? "textbook"
                                      : "");
  }
  const auto best =
      std::count_if(ways.begin(), ways.end(), [](const Numbered& n) { return n.way->frontier; });
  return fmt::format(
      "<details open=\"open\"><summary>Table: {} ways, {} on the frontier</summary>\n{}</details>\n",
      ways.size(), best, table.code());
}

/// How often the textbook's time the fastest way takes that is no worse, in words; empty where there is none.
std::string against_textbook(const std::vector<Numbered>& ways) {
  std::string out;
  for (const Numbered& entry : ways) {
    const WaySpeed* textbook = entry.way;
    if (textbook->family != kTextbook || !(textbook->nanoseconds > 0)) continue;
    const auto better = std::find_if(ways.begin(), ways.end(), [&](const Numbered& n) {
      return n.way->family != kTextbook && n.way->error.mean <= textbook->error.mean &&
             n.way->nanoseconds > 0;
    });
    if (better == ways.end() || better->way->nanoseconds >= textbook->nanoseconds) continue;
    const WaySpeed& w = *better->way;
    out += fmt::format(
        "<li>No less accurate than <em>{}</em> ({} ns, mean {}) and <strong>{} times as fast</strong>: {} "
        "({} ns, "
        "mean {}).</li>\n",
        escaped(textbook->name), number(textbook->nanoseconds), number(textbook->error.mean),
        number(textbook->nanoseconds / w.nanoseconds), escaped(w.name), number(w.nanoseconds),
        number(w.error.mean));
  }
  return out.empty() ? out : "<ul>\n" + out + "</ul>\n";
}

std::string part_of(const std::vector<Numbered>& ways, const std::vector<std::string>& families,
                    const std::string& id) {
  const WaySpeed& first = *ways.front().way;
  const Chart chart = chart_of(ways, families);
  std::string out =
      fmt::format("<section id=\"{}\" class=\"light\">\n<h3>{}{}</h3>\n", id, escaped(first.light),
                  first.spiky ? " <span class=\"badge\">has lines</span>" : "");
  const std::string wide = svg_chart(chart, ChartForm::kWide);
  if (!wide.empty()) {
    out += fmt::format(
        "<figure>\n<figcaption>{}. Lower and further left is better; numbers are those of the table's "
        "rows.</figcaption>\n{}{}</figure>\n",
        escaped(chart.title), wide, svg_chart(chart, ChartForm::kNarrow));
  }
  return out + against_textbook(ways) + table_of(ways, families) + "</section>\n";
}

}  // namespace

std::vector<Section> way_sections(const BenchmarkReport& report) {
  std::vector<Section> sections;
  const std::vector<std::string> families = families_of(report);
  const std::vector<std::string> lights = distinct(report.ways, [](const WaySpeed& w) { return w.light; });
  for (const std::string& job : distinct(report.ways, [](const WaySpeed& w) { return w.job; })) {
    Section section;
    section.id = fmt::format("job-{}", sections.size() + 1);
    section.name = "Error against time: " + head_of(job);
    std::string parts;
    std::string links;
    for (std::size_t i = 0; i < lights.size(); ++i) {
      const std::vector<Numbered> ways = ways_of(report, job, lights[i]);
      if (ways.empty()) continue;
      const std::string id = fmt::format("{}-light-{}", section.id, i + 1);
      parts += part_of(ways, families, id);
      links += fmt::format("{}<a href=\"#{}\">{}</a>", links.empty() ? "" : " · ", id, escaped(lights[i]));
    }
    section.code = fmt::format(
        "<section id=\"{}\">\n<h2>Error against time: {}</h2>\n<p class=\"job\">The job: {}.</p>\n"
        "<p>Each mark is one way of doing this job. The grey staircase, the <em>frontier</em>, joins the "
        "ways that "
        "no other is as fast and as accurate as; its marks have a heavier outline. Errors are CIEDE2000 "
        "colour "
        "differences from the truth that the job names, times those of one thread; both axes are "
        "logarithmic.</p>\n<p>Lights: {}</p>\n{}</section>\n",
        section.id, escaped(head_of(job)), escaped(job), links, parts);
    sections.push_back(std::move(section));
  }
  return sections;
}

}  // namespace spectile::report

namespace spectile {

std::string benchmark_plot(const BenchmarkReport& report, const std::string& job, const std::string& light) {
  const auto ways = report::ways_of(report, job, light);
  if (ways.empty()) return {};
  return report::svg_chart(report::chart_of(ways, report::families_of(report)), report::ChartForm::kAlone);
}

}  // namespace spectile
