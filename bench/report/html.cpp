// A benchmark's report as one page of HTML that needs nothing else.
#include <fmt/format.h>

#include <algorithm>
#include <spectile/bench/benchmark.hpp>

#include "bench/report/sections.hpp"
#include "bench/report/text.hpp"

namespace spectile {
namespace report {
namespace {

Section machine_section(const BenchmarkReport& report) {
  const BenchmarkMachine& m = report.machine;
  std::string isas;
  for (const std::string& isa : m.isas) isas += (isas.empty() ? "" : ", ") + isa;
  std::string list;
  const auto entry = [&](const char* name, const std::string& value) {
    if (value.empty() || value == kDash) return;
    list += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escaped(value));
  };
  entry("Processor", m.processor);
  entry("Cores for this process", fmt::format("{}", m.cores));
  entry("Instruction sets", isas);
  entry("Second-level cache", bytes_text(m.second_level_cache));
  entry("Last-level cache", bytes_text(m.last_level_cache));
  entry("Worked on, a thread, for the cache", bytes_text(m.cache_bytes));
  entry("Worked on for memory", bytes_text(m.memory_bytes));
  entry("System", m.system);
  entry("Compiler", m.compiler);
  entry("spectile", m.version);
  entry("Date", m.date);
  if (report.seconds > 0) entry("The run took", number(report.seconds) + " s");
  return make_section("machine", "Machine", "Machine and build", "<dl class=\"facts\">\n" + list + "</dl>\n");
}

std::string warning_part(const BenchmarkReport& report) {
  if (report.disturbed.empty()) return {};
  std::string list;
  for (const std::string& part : report.disturbed) list += fmt::format("<li>{}</li>\n", escaped(part));
  return fmt::format(
      "<aside class=\"warning\" aria-label=\"Warning\">\n<p><strong>⚠ Other work took the processor during "
      "this run.</strong> Do not rely on the times of these parts; repeat the run on an idle "
      "machine:</p>\n<ul>\n{}</ul>\n"
      "</aside>\n",
      list);
}

Section advice_section(const BenchmarkReport& report) {
  if (report.advice.empty()) return {};
  std::string body = "";
  for (const std::string& job : distinct(report.advice, [](const auto& a) { return a.job; })) {
    body += fmt::format("<h3>{}</h3>\n<ul class=\"advice\">\n", escaped(job));
    for (const BenchmarkAdvice& a : report.advice) {
      if (a.job != job) continue;
      body += a.light.empty()
                  ? fmt::format("<li>{}</li>\n", escaped(a.sentence))
                  : fmt::format("<li><strong>{}</strong> {}</li>\n", escaped(a.light), escaped(a.sentence));
    }
    body += "</ul>\n";
  }
  return make_section("advice", "Which to use", "Which to use for a given error", body);
}

Section reproduce_section(const BenchmarkReport& report) {
  const std::string version = report.machine.version.empty() ? "" : " " + report.machine.version;
  return make_section(
      "reproduce", "Reproduce", "How to reproduce this page",
      fmt::format("<p>With spectile{} on an idle machine; <code>spectile bench --help</code> lists what can "
                  "be left out or chosen:</p>\n<pre><code>spectile bench --report out.html</code></pre>\n"
                  "<p>Times vary with the machine and from run to run: the spread is half the range of the "
                  "middle half of the runs, over their median. Errors do not vary: every instruction set and "
                  "number of threads gives the same bits.</p>\n",
                  escaped(version)));
}

std::string summary(const BenchmarkReport& report) {
  std::vector<std::string> parts;
  const auto count = [&](std::size_t n, const char* what) {
    if (n > 0) parts.push_back(fmt::format("{} {}", count_text(n), what));
  };
  count(report.methods.size(), "timings of methods");
  count(report.representations.size(), "of representations");
  count(report.operations.size(), "of operations");
  count(report.baseline.size(), "beside the AoS baseline");
  if (!report.stress.empty()) {
    const auto beyond = std::count_if(report.stress.begin(), report.stress.end(), is_beyond);
    parts.push_back(beyond == 0
                        ? fmt::format("{} stress rows, all within their bounds", report.stress.size())
                        : fmt::format("{} stress rows, <strong class=\"bad\">{} beyond</strong> their bounds",
                                      report.stress.size(), beyond));
  }
  if (parts.empty()) return "<p>This report holds no measurements.</p>\n";
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : "; ") + part;
  return fmt::format("<p class=\"summary\">In this report: {}.</p>\n", out);
}

std::string navigation(const std::vector<Section>& sections) {
  std::string links = "<li><a href=\"#machine\">Machine</a></li>\n";
  for (const Section& s : sections) {
    if (!s.code.empty()) links += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", s.id, escaped(s.name));
  }
  return fmt::format("<nav aria-label=\"On this page\">\n<ul>\n{}</ul>\n</nav>\n", links);
}

}  // namespace

Section make_section(const std::string& id, const std::string& name, const std::string& heading,
                     const std::string& body) {
  return {id, name, fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, heading, body)};
}

std::string light_head(const std::string& id, const std::string& light, bool line_spectrum,
                       const Chart& chart, const char* note) {
  std::string out = fmt::format("<section{} class=\"light\">\n<h3>{}{}</h3>\n", id, escaped(light),
                                line_spectrum ? " <span class=\"badge\">has lines</span>" : "");
  const std::string wide = svg_chart(chart, ChartForm::kWide);
  if (wide.empty()) return out;
  return out + fmt::format("<figure>\n<figcaption>{}. {}</figcaption>\n{}{}</figure>\n", escaped(chart.title),
                           note, wide, svg_chart(chart, ChartForm::kNarrow));
}

}  // namespace report

std::string benchmark_to_html(const BenchmarkReport& benchmark) {
  using report::Section;
  const Section machine = report::machine_section(benchmark);
  std::vector<Section> sections = {report::advice_section(benchmark)};
  for (Section& section : report::method_sections(benchmark)) sections.push_back(std::move(section));
  for (Section (*make)(const BenchmarkReport&) :
       {report::representation_section, report::operation_section, report::baseline_section,
        report::limit_section, report::scaling_section, report::stress_section, report::reproduce_section}) {
    sections.push_back(make(benchmark));
  }

  std::string body;
  for (const Section& section : sections) body += section.code;
  const std::string on = benchmark.machine.processor.empty() ? "" : " on " + benchmark.machine.processor;
  const std::string title = report::escaped("spectile benchmark" + on);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{}</title>\n"
      "<style>\n{}</style>\n</head>\n<body>\n<header>\n<h1>{}</h1>\n"
      "<p>spectile computes with spectra in place of colours; this page says what its operations cost on one "
      "machine in one run, as a share of what that machine can do, and how wrong each is. For every method "
      "of doing a job it sets the time against the colour error that is left, in CIEDE2000, of which about 1 "
      "can just be seen, so that you can take the fastest that is good "
      "enough.</p>\n{}</header>\n{}<main>\n{}{}{}</main>\n</body>\n</html>\n",
      title, report::kStyleSheet, title, report::summary(benchmark), report::navigation(sections),
      machine.code, report::warning_part(benchmark), body);
}

}  // namespace spectile
