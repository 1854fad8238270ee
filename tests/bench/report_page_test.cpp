// A benchmark's report as a page: everything in it, nothing that breaks it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "bench/report/text.hpp"
#include "tests/bench/report_support.hpp"

namespace spectile::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string& full_page() {
  static const std::string page = benchmark_to_html(full());
  return page;
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size()))
    ++count;
  return count;
}

/// The text between two marks, the first occurrence of each; empty where there is none.
std::string part(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t first = text.find(from);
  if (first == std::string::npos) return {};
  const std::size_t last = text.find(to, first + from.size());
  return text.substr(first, last == std::string::npos ? last : last - first);
}

std::vector<std::string> parts(const std::string& text, const std::string& from, const std::string& to) {
  std::vector<std::string> out;
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1)) {
    out.push_back(text.substr(at, text.find(to, at) - at));
  }
  return out;
}

/// The first error in the tags of a page; empty for none. Every element must be closed, in order, every
/// attribute quoted, and every & begin a name.
std::string flaw_in_tags(const std::string& page) {
  std::vector<std::string> open;
  for (std::size_t at = 0; at < page.size(); ++at) {
    if (page[at] == '&') {
      const std::size_t end = page.find(';', at);
      const bool named = end != std::string::npos && end - at <= 6 && end > at + 1;
      if (!named) return "a bare & before " + page.substr(at, 20);
    }
    if (page[at] == '>') return "a bare > before " + page.substr(at, 20);
    if (page[at] != '<') continue;
    std::size_t end = at + 1;
    bool quoted = false;
    while (end < page.size() && (quoted || page[end] != '>')) {
      if (page[end] == '"') quoted = !quoted;
      if (page[end] == '<') return "< within a tag, before " + page.substr(end, 20);
      ++end;
    }
    if (end >= page.size()) return "a tag without an end";
    const std::string tag = page.substr(at + 1, end - at - 1);
    at = end;
    if (tag.front() == '!') continue;
    if (tag.front() == '/') {
      if (open.empty() || open.back() != tag.substr(1)) {
        return "</" + tag.substr(1) + "> closes " + (open.empty() ? "nothing" : open.back());
      }
      open.pop_back();
      continue;
    }
    if (tag.back() == '/') continue;
    std::string name = tag.substr(0, tag.find(' '));
    if (!std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0; })) {
      return "no name in <" + tag + ">";
    }
    open.push_back(name);
    if (name == "style") at = page.find("</style>", at) - 1;  // not markup
  }
  return open.empty() ? "" : open.back() + " stays open";
}

TEST(BenchmarkPage, IsWellFormed) {
  EXPECT_EQ(flaw_in_tags(full_page()), "");
  EXPECT_EQ(flaw_in_tags(benchmark_to_html(filled_with(1, "<b>&\"'"))), "");
}

TEST(BenchmarkPage, NeedsNothingElse) {
  for (const char* what :
       {"http:", "https:", "//", "<script", "<link", "<iframe", "@import", "url(", "src=", "javascript"}) {
    EXPECT_THAT(full_page(), Not(HasSubstr(what)));
  }
}

TEST(BenchmarkPage, SaysItsLanguageAndFitsItsWindow) {
  EXPECT_THAT(full_page(), HasSubstr("<html lang=\"en\">"));
  EXPECT_THAT(full_page(), HasSubstr("name=\"viewport\""));
  EXPECT_EQ(count_of(full_page(), "<h1>"), 1U);
}

TEST(BenchmarkPage, LinksLeadSomewhere) {
  const auto links = parts(full_page(), "href=\"#", "\">");
  EXPECT_GT(links.size(), 15U);  // sections, and lights of each job
  for (const std::string& link : links) {
    const std::string id = link.substr(std::string("href=\"#").size());
    EXPECT_EQ(count_of(full_page(), "id=\"" + id + "\""), 1U) << id;
  }
}

TEST(BenchmarkPage, HasEveryMethodInATableAndInBothCharts) {
  const auto tables = parts(full_page(), "<table>", "</table>");
  for (const char* job : kMadeUpJobs) {
    for (const MadeUpLight& light : kMadeUpLights) {
      const std::string head = fmt::format(
          "{}, {}: every method", std::string(job).substr(0, std::string(job).find(';')), light.name);
      const auto table = std::find_if(tables.begin(), tables.end(), [&](const std::string& t) {
        return t.find(head) != std::string::npos;
      });
      ASSERT_NE(table, tables.end()) << head;
      for (const MethodSpeed& w : full().methods) {
        if (w.job != job || w.light != light.name) continue;
        const auto rows = parts(*table, "<tr", "</tr>");
        const std::string name = report::escaped(w.name);
        const auto row = std::find_if(rows.begin(), rows.end(), [&](const std::string& r) {
          const std::size_t at = r.find("</svg> " + name);
          if (at == std::string::npos) return false;
          const char next = r[at + 7 + name.size()];
          return next == '<' || r.compare(at + 7 + name.size(), 2, " <") == 0;
        });
        ASSERT_NE(row, rows.end()) << w.name;
        EXPECT_THAT(*row, HasSubstr("<td>" + report::number(w.nanoseconds) + "</td>"));
        EXPECT_THAT(*row, HasSubstr("<td>" + report::number(w.error.mean) + "</td>"));
        EXPECT_EQ(row->find("★ frontier") != std::string::npos, w.frontier) << w.name;
        EXPECT_EQ(row->find(">AoS baseline</span>") != std::string::npos, w.family == "AoS baseline")
            << w.name;
      }
    }
  }
  // Each in the wide and in the narrow form.
  EXPECT_EQ(count_of(full_page(), "class=\"mark "),
            2 * (full().methods.size() + full().representations.size()));
  EXPECT_EQ(count_of(full_page(), "<title>"),
            1 + 2 * (full().methods.size() + full().representations.size()));
}

TEST(BenchmarkPage, ListsTheFastestMethodsFirst) {
  BenchmarkReport r;
  for (const double ns : {30.0, kNotANumber, 0.2, 400.0, 5.0}) {
    r.methods.push_back(
        {"job", "light", false, "family", fmt::format("at {}", ns), 0, ns, 0, 0, {1, 1, 1}, false});
  }
  const std::string page = benchmark_to_html(r);
  std::vector<std::string> order;
  for (const std::string& row : parts(page, "<span class=\"no\">", "</th>")) {
    order.push_back(row.substr(17, 1) + row.substr(row.find("</svg>") + 6));
  }
  EXPECT_THAT(order, ::testing::ElementsAre("1 at 0.2", "2 at 5", "3 at 30", "4 at 400", "5 at nan"));
}

TEST(BenchmarkPage, HasEveryOperationAtEachLevel) {
  const std::string section = part(full_page(), "<section id=\"operations\">", "</section>");
  for (const char* level : {"second-level cache", "memory"}) {
    const std::string all =
        part(section, fmt::format("<caption><span>In {}: every measurement", level), "</table>");
    std::size_t count = 0;
    for (const OperationSpeed& o : full().operations) {
      if ((o.level == MemoryLevel::kCache) != (std::string(level) != "memory")) continue;
      ++count;
      EXPECT_THAT(all,
                  HasSubstr(fmt::format(">{}</th><td class=\"words\">{}</td><td>{}</td><td>{}", o.name, o.isa,
                                        o.threads, report::with_prefix(o.items_per_second, o.item + "s/s"))));
    }
    EXPECT_EQ(count_of(all, "scope=\"row\""), count);
    // The short table: each once, as the best instruction set does it.
    const std::string best =
        part(section, fmt::format("<caption><span>In {}: every operation, avx512", level), "</table>");
    EXPECT_EQ(count_of(best, "scope=\"row\""), count / full().machine.isas.size());
  }
}

TEST(BenchmarkPage, SetsAnOperationsShareAgainstItsLimit) {
  BenchmarkReport r;
  r.machine.isas = {"sse4.2", "avx2"};
  r.limits = {{"avx2", 1, MemoryLevel::kMemory, 1e9, 2e9, 3e9, 7.7e9, 5e9, 6e9, 0},
              {"avx2", 2, MemoryLevel::kCache, 1e9, 2e9, 3e9, 8.8e9, 5e9, 6e9, 0},
              {"sse4.2", 1, MemoryLevel::kCache, 1e9, 2e9, 3e9, 9.9e9, 5e9, 6e9, 0},
              {"avx2", 1, MemoryLevel::kCache, 1e9, 2e9, 3e9, 84.2e9, 5e9, 6e9, 0}};
  r.operations = {{"arithmetic", "multiply", "avx2", 1, MemoryLevel::kCache, "lane", 1.23e9, 8e9, 0.01,
                   "copy", 0.83, 1.5, 1, "u", "two permutes"}};
  const std::string page = benchmark_to_html(r);
  EXPECT_THAT(page, HasSubstr("1.23\u00A0Glanes/s"));
  EXPECT_THAT(page, HasSubstr("width:83.0%"));
  EXPECT_THAT(page, HasSubstr("83\u00A0%"));
  EXPECT_THAT(page, HasSubstr("copy, 84.2\u00A0GB/s <small>two permutes</small>"));
  EXPECT_EQ(count_of(page, ">beyond<"), 1U);  // 1.5 u with a bound of 1 u
  r.operations[0].error = 1;
  EXPECT_EQ(count_of(benchmark_to_html(r), ">beyond<"), 0U);
}

TEST(BenchmarkPage, MarksStressRowsBeyondTheirBoundAndPutsThemFirst) {
  const std::string section = part(full_page(), "<section id=\"stress\">", "</section>");
  const auto rows = parts(section, "<tr", "</tr>");
  ASSERT_EQ(rows.size(), 1 + full().stress.size());  // and the head
  std::size_t beyond = 0;
  for (const StressResult& s : full().stress) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const std::string& r) {
      return r.find(">" + s.operation + " <small>") != std::string::npos;
    });
    ASSERT_NE(row, rows.end()) << s.operation;
    EXPECT_EQ(row->find("<tr class=\"beyond\">") == 0, s.beyond > 0) << s.operation;
    EXPECT_EQ(row->find(">beyond</span>") != std::string::npos, s.beyond > 0) << s.operation;
    EXPECT_THAT(*row, HasSubstr(report::count_text(s.cases)));
    if (s.beyond == 0) continue;
    ++beyond;
    EXPECT_LE(row - rows.begin(), 2) << s.operation;  // after the head
  }
  EXPECT_EQ(beyond, 2U);
  EXPECT_THAT(section, HasSubstr("2 of 80 rows are <strong>beyond</strong>"));
}

TEST(BenchmarkPage, CountsAWorstBeyondItsBoundOrNoNumberAsBeyond) {
  BenchmarkReport r;
  r.stress = {{"held", "", "u", 2, 2, 10, 0, ""}, {"exact", "", "u", 0, 0, 10, 0, ""}};
  EXPECT_EQ(count_of(benchmark_to_html(r), ">beyond</span>"), 0U);
  r.stress = {{"worse", "", "u", 2, 2.1, 10, 0, ""},
              {"odd", "", "u", 2, kNotANumber, 10, 0, ""},
              {"few", "", "u", 2, 1, 10, 1, ""}};
  EXPECT_EQ(count_of(benchmark_to_html(r), ">beyond</span>"), 3U);
}

TEST(BenchmarkPage, HasEveryRepresentationLimitBaselineScalingAdviceAndWarning) {
  const std::string representations =
      part(full_page(), "<section id=\"representations\">", "<section id=\"operations\">");
  for (const RepresentationSpeed& r : full().representations) {
    EXPECT_THAT(representations,
                HasSubstr(fmt::format("{}</th><td>{}</td><td>{}</td><td>{}</td>", r.name, r.bounces,
                                      report::number(r.nanoseconds), report::number(r.error.mean))));
  }
  const std::string limits = part(full_page(), "<section id=\"limits\">", "</section>");
  EXPECT_EQ(count_of(limits, "scope=\"row\""), full().limits.size());
  for (const MachineLimit& l : full().limits) {
    EXPECT_THAT(limits, HasSubstr(fmt::format(">{}</th><td>{}</td><td>{}</td>", l.isa, l.threads,
                                              report::with_prefix(l.load, "B/s"))));
  }
  const std::string baseline = part(full_page(), "<section id=\"baseline\">", "</section>");
  for (const BaselineSpeed& b : full().baseline) {
    EXPECT_THAT(baseline,
                HasSubstr(fmt::format(">{}</th><td>{}</td><td>{}</td>", b.name, report::number(b.nanoseconds),
                                      report::number(b.baseline_nanoseconds))));
  }
  const std::string threads = part(full_page(), "<section id=\"threads\">", "</section>");
  for (const ThreadScaling& s : full().scaling) {
    EXPECT_THAT(threads,
                HasSubstr(fmt::format("{} ({})", report::number(s.speed_up), report::number(s.limit))));
  }
  const std::string advice = part(full_page(), "<section id=\"advice\">", "</section>");
  EXPECT_EQ(count_of(advice, "<li>"), full().advice.size());
  const std::string warning = part(full_page(), "class=\"warning\"", "</aside>");
  for (const std::string& w : full().disturbed) EXPECT_THAT(warning, HasSubstr(w));
  EXPECT_THAT(benchmark_to_html({}), Not(HasSubstr("class=\"warning\"")));
}

TEST(BenchmarkPage, EscapesEveryText) {
  const std::string evil = "<b>&\"'";
  const std::string page = benchmark_to_html(filled_with(1, evil));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
  EXPECT_THAT(page, Not(HasSubstr("&\"")));
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;&amp;&quot;&#39;"));
  EXPECT_EQ(flaw_in_tags(page), "");
}

TEST(BenchmarkPage, MendsTextThatIsNoUtf8) {
  EXPECT_EQ(report::escaped("a\xFF"
                            "b\xC3"),
            "a\uFFFDb\uFFFD");
  EXPECT_EQ(report::escaped("\xE0\x80\x80"), "\uFFFD\uFFFD\uFFFD");  // a longer form than needed
  EXPECT_EQ(report::escaped("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");  // half of a pair
  EXPECT_EQ(report::escaped(std::string("\0\x1B", 2)), "\uFFFD\uFFFD");
  EXPECT_EQ(report::escaped("\u00E9\u20AC\U0001F600\n"), "\u00E9\u20AC\U0001F600\n");
}

TEST(BenchmarkPage, WritesNoNumberThatIsNone) {
  for (const double x : {kNotANumber, kInfinity, -kInfinity}) {
    const std::string page = benchmark_to_html(filled_with(x, "xyz"));
    EXPECT_EQ(flaw_in_tags(page), "");
    std::string lower = part(page, "<body>", "</body>");
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    std::string word;
    for (const char c : lower) {
      if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
        word += c;
        continue;
      }
      EXPECT_TRUE(word != "nan" && word != "inf" && word != "infinity") << word;
      word.clear();
    }
    // Entries with numbers are drawn, others are in the tables alone.
    EXPECT_EQ(count_of(page, "class=\"mark "), 4U);
  }
}

TEST(BenchmarkPage, OfAnEmptyReportIsAPage) {
  const std::string page = benchmark_to_html({});
  EXPECT_EQ(flaw_in_tags(page), "");
  EXPECT_THAT(page, HasSubstr("holds no measurements"));
  EXPECT_THAT(page, Not(HasSubstr("<table>")));
  EXPECT_THAT(page, Not(HasSubstr("<figure>")));
}

}  // namespace
}  // namespace spectile::test
