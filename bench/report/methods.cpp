// The sections that show error against time, one for each job, with a chart and a table for each light.
#include <fmt/format.h>

#include <algorithm>

#include "bench/report/chart/svg_chart.hpp"
#include "bench/report/sections.hpp"
#include "bench/report/table.hpp"

namespace spectile::report {
namespace {

constexpr const char* kAosBaseline = "AoS baseline";

/// A method, with its place among those of its job and light: the fastest is number 1.
struct Numbered {
  const MethodSpeed* method;
  int number;
};

std::vector<Numbered> timed_methods(const BenchmarkReport& report, const std::string& job,
                                    const std::string& light) {
  std::vector<const MethodSpeed*> methods;
  for (const MethodSpeed& method : report.methods) {
    if (method.job == job && method.light == light) methods.push_back(&method);
  }
  // Times that are no numbers last: comparing them would be no order.
  const auto known = std::stable_partition(
      methods.begin(), methods.end(), [](const MethodSpeed* w) { return w->nanoseconds == w->nanoseconds; });
  std::stable_sort(methods.begin(), known, [](const MethodSpeed* a, const MethodSpeed* b) {
    return a->nanoseconds < b->nanoseconds;
  });
  std::vector<Numbered> out;
  out.reserve(methods.size());
  for (const MethodSpeed* method : methods) out.push_back({method, static_cast<int>(out.size()) + 1});
  return out;
}

/// The same in every chart of a report.
std::vector<std::string> method_families(const BenchmarkReport& report) {
  std::vector<std::string> families = {kAosBaseline};
  for (const std::string& family : distinct(report.methods, [](const MethodSpeed& w) { return w.family; })) {
    if (family != kAosBaseline) families.push_back(family);
  }
  return families;
}

int family_style(const std::vector<std::string>& families, const std::string& family) {
  return static_cast<int>(std::find(families.begin(), families.end(), family) - families.begin());
}

/// A job's name: what stands before its reference.
std::string short_name(const std::string& job) {
  return job.substr(0, job.find(';'));
}

std::string light_in_words(const std::string& light, bool line_spectrum) {
  return line_spectrum ? light + " (a light with lines)" : light;
}

Chart make_chart(const std::vector<Numbered>& methods, const std::vector<std::string>& families) {
  const MethodSpeed& first = *methods.front().method;
  Chart chart;
  chart.title = fmt::format("{}; light: {}", first.job, light_in_words(first.light, first.line_spectrum));
  chart.x_label = "nanoseconds a pixel, one thread";
  chart.y_label = "CIEDE2000, mean";
  chart.frontier = "frontier";
  std::string best;
  for (std::size_t family = 0; family < families.size(); ++family) {
    ChartSeries series;
    series.name = families[family].empty() ? "other" : families[family];
    series.style = static_cast<int>(family);
    for (const auto& [method, place] : methods) {
      if (method->family != families[family]) continue;
      const std::string number_text = fmt::format("{}", place);
      const std::string title =
          fmt::format("{}. {}: {} ns, CIEDE2000 {} mean, {} at most{}", place, method->name,
                      number(method->nanoseconds), number(method->error.mean), number(method->error.maximum),
                      method->frontier ? "; on the frontier" : "");
      series.marks.push_back(
          {method->nanoseconds, method->error.mean, title, method->name, number_text, method->frontier});
    }
    chart.series.push_back(std::move(series));
  }
  for (const auto& [method, place] : methods) {
    if (!method->frontier) continue;
    best += fmt::format("{}{} ({} ns, {})", best.empty() ? "" : ", ", method->name,
                        number(method->nanoseconds), number(method->error.mean));
  }
  chart.description =
      fmt::format("{}. Mean CIEDE2000 against nanoseconds a pixel of {} methods{}{}.", chart.title,
                  methods.size(), best.empty() ? "" : "; on the frontier, the fastest first: ", best);
  return chart;
}

Html name_cell(const Numbered& entry, int style) {
  const MethodSpeed& method = *entry.method;
  std::string code = fmt::format("<span class=\"no\">{}</span> {} {}", entry.number, mark_in_text(style).code,
                                 escaped(method.name));
  if (method.frontier) code += " <span class=\"badge best\">★ frontier</span>";
  if (method.family == kAosBaseline) code += " <span class=\"badge\">AoS baseline</span>";
  return {code};
}

std::string method_table(const std::vector<Numbered>& methods, const std::vector<std::string>& families) {
  const MethodSpeed& first = *methods.front().method;
  Table table(
      fmt::format(
          "{}, {}: every method, the fastest first. ns: a pixel, one thread; mean, 95 %, max: CIEDE2000",
          short_name(first.job), first.light),
      {"method", "ns", "mean", "95 %", "max", "spread", "bands", "bytes a pixel", "family"}, {0, 8});
  for (const Numbered& entry : methods) {
    const MethodSpeed& w = *entry.method;
    table.row({name_cell(entry, family_style(families, w.family)), html(number(w.nanoseconds)),
               html(number(w.error.mean)), html(number(w.error.percentile95)), html(number(w.error.maximum)),
               html("±" + percent(w.spread)), html(w.bands > 0 ? fmt::format("{}", w.bands) : kDash),
               html(w.bytes > 0 ? count_text(w.bytes) : kDash), html(w.family)},
              w.frontier ? "best" : "");
  }
  const auto best =
      std::count_if(methods.begin(), methods.end(), [](const Numbered& n) { return n.method->frontier; });
  return fmt::format(
      "<details open=\"open\"><summary>Table: {} methods, {} on the frontier</summary>\n{}</details>\n",
      methods.size(), best, table.code());
}

/// The speed-up over the AoS baseline of the fastest method that is no worse, in words; empty where there is
/// none.
std::string against_baseline(const std::vector<Numbered>& methods) {
  std::string out;
  for (const Numbered& entry : methods) {
    const MethodSpeed* baseline = entry.method;
    if (baseline->family != kAosBaseline || !(baseline->nanoseconds > 0)) continue;
    const auto better = std::find_if(methods.begin(), methods.end(), [&](const Numbered& n) {
      return n.method->family != kAosBaseline && n.method->error.mean <= baseline->error.mean &&
             n.method->nanoseconds > 0;
    });
    if (better == methods.end() || better->method->nanoseconds >= baseline->nanoseconds) continue;
    const MethodSpeed& w = *better->method;
    out += fmt::format(
        "<li>No less accurate than <em>{}</em> ({} ns, mean {}) and <strong>{} times as fast</strong>: {} "
        "({} ns, mean {}).</li>\n",
        escaped(baseline->name), number(baseline->nanoseconds), number(baseline->error.mean),
        number(baseline->nanoseconds / w.nanoseconds), escaped(w.name), number(w.nanoseconds),
        number(w.error.mean));
  }
  return out.empty() ? out : "<ul>\n" + out + "</ul>\n";
}

std::string light_part(const std::vector<Numbered>& methods, const std::vector<std::string>& families,
                       const std::string& id) {
  const MethodSpeed& first = *methods.front().method;
  const Chart chart = make_chart(methods, families);
  const std::string head =
      light_head(fmt::format(" id=\"{}\"", id), first.light, first.line_spectrum, chart,
                 "Lower and further left is better; numbers are those of the table's rows.");
  return head + against_baseline(methods) + method_table(methods, families) + "</section>\n";
}

}  // namespace

std::vector<Section> method_sections(const BenchmarkReport& report) {
  std::vector<Section> sections;
  const std::vector<std::string> families = method_families(report);
  const std::vector<std::string> lights =
      distinct(report.methods, [](const MethodSpeed& w) { return w.light; });
  for (const std::string& job : distinct(report.methods, [](const MethodSpeed& w) { return w.job; })) {
    const std::string id = fmt::format("job-{}", sections.size() + 1);
    const std::string name = "Error against time: " + short_name(job);
    std::string parts;
    std::string links;
    for (std::size_t i = 0; i < lights.size(); ++i) {
      const std::vector<Numbered> methods = timed_methods(report, job, lights[i]);
      if (methods.empty()) continue;
      const std::string light_id = fmt::format("{}-light-{}", id, i + 1);
      parts += light_part(methods, families, light_id);
      links +=
          fmt::format("{}<a href=\"#{}\">{}</a>", links.empty() ? "" : " · ", light_id, escaped(lights[i]));
    }
    sections.push_back(make_section(
        id, name, escaped(name),
        fmt::format("<p class=\"job\">The job: {}.</p>\n"
                    "<p>Each mark is one method. The grey staircase, the <em>frontier</em>, joins the "
                    "methods that no other is as fast and as accurate as; its marks have a heavier outline. "
                    "Errors are CIEDE2000 colour differences from the reference that the job names, times "
                    "those of one thread; both axes are logarithmic.</p>\n<p>Lights: {}</p>\n{}",
                    escaped(job), links, parts)));
  }
  return sections;
}

}  // namespace spectile::report

namespace spectile {

std::string benchmark_plot(const BenchmarkReport& report, const std::string& job, const std::string& light) {
  const auto methods = report::timed_methods(report, job, light);
  if (methods.empty()) return {};
  return report::svg_chart(report::make_chart(methods, report::method_families(report)),
                           report::ChartForm::kAlone);
}

}  // namespace spectile
