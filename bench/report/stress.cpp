// The section of how far the numbers hold.
#include <fmt/format.h>

#include <algorithm>

#include "bench/report/sections.hpp"
#include "bench/report/table.hpp"

namespace spectile::report {
namespace {

std::vector<Html> row_cells(const StressResult& s) {
  const Html verdict = is_beyond(s) ? Html{"<span class=\"badge bad\">beyond</span>"} : html("holds");
  return {{escaped(s.operation) + " <small>" + escaped(s.inputs) + "</small>"},
          verdict,
          html(s.bound == 0 ? "exact" : quantity(s.bound, s.unit)),
          html(quantity(s.worst, s.unit)),
          html(count_text(s.cases)),
          html(count_text(s.beyond)),
          {s.worst_case.empty() ? kDash : "<small>" + escaped(s.worst_case) + "</small>"}};
}

}  // namespace

bool is_beyond(const StressResult& result) {
  // Written so that a worst that is no number is beyond.
  return result.beyond > 0 || !(result.worst <= result.bound);
}

Section stress_section(const BenchmarkReport& report) {
  if (report.stress.empty()) return {};
  const auto beyond = std::count_if(report.stress.begin(), report.stress.end(), is_beyond);
  std::uint64_t cases = 0;
  for (const StressResult& s : report.stress) cases += s.cases;
  Table table(
      "Every operation and kind of input; rows beyond their bound first",
      {"operation, and its inputs", "verdict", "bound", "worst", "cases", "cases beyond", "worst case"},
      {0, 1, 6});
  for (const bool bad : {true, false}) {
    for (const StressResult& s : report.stress) {
      if (is_beyond(s) == bad) table.row(row_cells(s), bad ? "beyond" : "");
    }
  }
  const std::string verdict =
      beyond == 0 ? fmt::format("<p class=\"good\">All {} rows hold", report.stress.size())
                  : fmt::format("<p class=\"bad\">{} of {} rows are <strong>beyond</strong> their bound",
                                beyond, report.stress.size());
  return make_section(
      "stress", "Stress test", "How far the numbers hold",
      fmt::format("{}, {} cases in all. “Exact” asks for exactly the documented result.</p>\n{}", verdict,
                  count_text(cases), table.code()));
}

}  // namespace spectile::report
