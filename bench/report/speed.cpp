// The sections of operations' speed, the machine's limits, and the gain of several threads.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "bench/report/sections.hpp"
#include "bench/report/table.hpp"

namespace spectile::report {
namespace {

constexpr std::array kLevels = {MemoryLevel::kCache, MemoryLevel::kMemory};

int isa_rank(const BenchmarkMachine& machine, const std::string& isa) {
  return static_cast<int>(std::find(machine.isas.begin(), machine.isas.end(), isa) - machine.isas.begin());
}

/// The operation as most will run it: with the best instruction set, on the fewest threads measured.
std::vector<const OperationSpeed*> main_rows(const BenchmarkReport& report, MemoryLevel level) {
  std::vector<const OperationSpeed*> rows;
  const auto known = [&](const OperationSpeed& o) {
    const int rank = isa_rank(report.machine, o.isa);
    return rank == static_cast<int>(report.machine.isas.size()) ? -1 : rank;
  };
  for (const OperationSpeed& o : report.operations) {
    if (o.level != level) continue;
    const auto same = std::find_if(rows.begin(), rows.end(), [&](const OperationSpeed* r) {
      return r->group == o.group && r->name == o.name;
    });
    if (same == rows.end()) {
      rows.push_back(&o);
    } else if (o.threads < (*same)->threads || (o.threads == (*same)->threads && known(o) > known(**same))) {
      *same = &o;
    }
  }
  return rows;
}

/// The limit that an operation is held against, with its value where it is one that was measured.
std::string limit_in_words(const BenchmarkReport& report, const OperationSpeed& o) {
  for (const MachineLimit& l : report.limits) {
    if (l.isa != o.isa || l.threads != o.threads || l.level != o.level) continue;
    if (o.limit == "load") return "load, " + with_prefix(l.load, "B/s");
    if (o.limit == "store") return "store, " + with_prefix(l.store, "B/s");
    if (o.limit == "stream") return "stream, " + with_prefix(l.stream, "B/s");
    if (o.limit == "copy") return "copy, " + with_prefix(l.copy, "B/s");
    if (o.limit == "multiply-add") return "multiply-add, " + with_prefix(l.multiply_add, "op/s");
  }
  return o.limit;
}

Html fraction_cell(double fraction) {
  if (!std::isfinite(fraction)) return html(kDash);
  return {
      fmt::format("<span class=\"fraction\"><span class=\"bar\" aria-hidden=\"true\"><i "
                  "style=\"width:{:.1f}%\"></i></span> <span class=\"share\">{}</span></span>",
                  100 * std::clamp(fraction, 0.0, 1.0), percent(fraction))};
}

/// Limiting resource, and the bottleneck where its limit is not reached.
Html limit_cell(const BenchmarkReport& report, const OperationSpeed& o) {
  return {escaped(limit_in_words(report, o)) +
          (o.note.empty() ? "" : " <small>" + escaped(o.note) + "</small>")};
}

std::vector<Html> row_cells(const BenchmarkReport& report, const OperationSpeed& o, bool full) {
  // Written so that an error that is no number is beyond.
  const bool beyond = !(o.error <= o.bound);
  std::vector<Html> cells = {html(o.name)};
  if (full) cells.insert(cells.end(), {html(o.isa), html(fmt::format("{}", o.threads))});
  cells.insert(cells.end(), {html(with_prefix(o.items_per_second, o.item + "s/s")),
                             fraction_cell(o.fraction),
                             {escaped(quantity(o.error, o.error_unit)) +
                              (beyond ? " <span class=\"badge bad\">beyond</span>" : "")},
                             html(o.bound == 0 ? "exact" : quantity(o.bound, o.error_unit)),
                             html(with_prefix(o.bytes_per_second, "B/s")),
                             html("±" + percent(o.spread)),
                             limit_cell(report, o)});
  return cells;
}

Table operation_table(const BenchmarkReport& report, const std::vector<const OperationSpeed*>& rows,
                      const std::string& caption, bool full) {
  std::vector<std::string> columns = {"operation"};
  if (full) columns.insert(columns.end(), {"ISA", "threads"});
  columns.insert(columns.end(),
                 {"items/s", "of its limit", "error", "bound", "bytes/s", "spread", "limiting resource"});
  Table table(caption, columns, full ? std::vector<std::size_t>{0, 1, 9} : std::vector<std::size_t>{0, 7});
  for (const std::string& group : distinct(rows, [](const OperationSpeed* o) { return o->group; })) {
    table.group(group);
    for (const OperationSpeed* o : rows) {
      if (o->group == group) table.row(row_cells(report, *o, full));
    }
  }
  return table;
}

/// "avx512, 1 thread" of rows that agree in it; where they do not, in words.
std::string measurement_place(const std::vector<const OperationSpeed*>& rows) {
  const bool same = std::all_of(rows.begin(), rows.end(), [&](const OperationSpeed* o) {
    return o->isa == rows.front()->isa && o->threads == rows.front()->threads;
  });
  if (!same) return "the best instruction set of each, fewest threads";
  return fmt::format("{}, {} thread{}", rows.front()->isa, rows.front()->threads,
                     rows.front()->threads == 1 ? "" : "s");
}

std::string level_part(const BenchmarkReport& report, MemoryLevel level) {
  std::vector<const OperationSpeed*> all;
  for (const OperationSpeed& o : report.operations) {
    if (o.level == level) all.push_back(&o);
  }
  if (all.empty()) return {};
  const auto main = main_rows(report, level);
  std::string out = fmt::format(
      "<h3>In {}</h3>\n{}", escaped(level_name(level)),
      operation_table(report, main,
                      "In " + level_name(level) + ": every operation, " + measurement_place(main), false)
          .code());
  if (all.size() > main.size()) {
    out += fmt::format(
        "<details><summary>Every instruction set and number of threads: {} rows</summary>\n{}</details>\n",
        all.size(),
        operation_table(report, all, "In " + level_name(level) + ": every measurement", true).code());
  }
  return out;
}

}  // namespace

std::string level_name(MemoryLevel level) {
  return level == MemoryLevel::kCache ? "second-level cache" : "memory";
}

Section operation_section(const BenchmarkReport& report) {
  if (report.operations.empty()) return {};
  std::string body =
      "<p>The bar is the share of the operation's limit that it reaches: how fast this machine loads, "
      "stores, copies, or multiplies and adds with nothing else to do, measured in the same run. A share "
      "above 100 % beats the plain loop that the limit was measured with. Bytes are those that an operation "
      "must read and write. Errors are against double precision; u is 2<sup>−24</sup> of the sum of "
      "magnitudes.</p>\n";
  for (const MemoryLevel level : kLevels) body += level_part(report, level);
  return make_section("operations", "Operations", "Operations against the machine's limits", body);
}

Section baseline_section(const BenchmarkReport& report) {
  if (report.baseline.empty()) return {};
  Table table("The engine and the baseline, one thread, " + report.machine.processor,
              {"operation", "engine, ns", "baseline, ns", "ratio", "tuned by hand, ns", "ratio",
               "engine's error", "baseline's error", "of its limit", "limit"},
              {0, 9});
  for (const std::string& group : distinct(report.baseline, [](const BaselineSpeed& b) { return b.group; })) {
    table.group(group);
    for (const BaselineSpeed& b : report.baseline) {
      if (b.group != group) continue;
      const bool tuned = b.fused_nanoseconds > 0;
      table.row({html(b.name), html(number(b.nanoseconds)), html(number(b.baseline_nanoseconds)),
                 html(number(b.ratio)), html(tuned ? number(b.fused_nanoseconds) : kDash),
                 html(tuned ? number(b.fused_ratio) : kDash), html(quantity(b.error, b.error_unit)),
                 html(quantity(b.baseline_error, b.error_unit)), fraction_cell(b.fraction), html(b.limit)});
    }
  }
  return make_section(
      "baseline", "AoS baseline", "Against a scalar array of structures",
      fmt::format("<p>The baseline is a struct of samples a pixel in plain C++, compiled with -O3 for this "
                  "processor. Ratios differ from processor to processor.</p>\n{}",
                  table.code()));
}

Section limit_section(const BenchmarkReport& report) {
  if (report.limits.empty()) return {};
  Table table("What the machine can do with nothing else to do; medians",
              {"where, ISA", "threads", "load", "store", "stream", "copy", "multiply-add", "fused", "divide",
               "spread"});
  for (const MemoryLevel level : kLevels) {
    bool first = true;
    for (const MachineLimit& l : report.limits) {
      if (l.level != level) continue;
      if (first) table.group(level_name(level));
      first = false;
      table.row({html(l.isa), html(fmt::format("{}", l.threads)), html(with_prefix(l.load, "B/s")),
                 html(with_prefix(l.store, "B/s")), html(with_prefix(l.stream, "B/s")),
                 html(with_prefix(l.copy, "B/s")), html(with_prefix(l.multiply_add, "op/s")),
                 html(with_prefix(l.fused_multiply_add, "op/s")), html(with_prefix(l.divide, "op/s")),
                 html("±" + percent(l.spread))});
    }
  }
  return make_section(
      "limits", "Machine limits", "The machine's limits",
      fmt::format(
          "<p>Load: bytes read. Store: written by ordinary stores. Stream: written by non-temporal stores. "
          "Copy: bytes read and written, together. Multiply-add: multiply, then add, each rounded and "
          "counted. Fused: each fused multiply-add counted once. Divide: float divisions.</p>\n{}",
          table.code()));
}

Section scaling_section(const BenchmarkReport& report) {
  if (report.scaling.empty()) return {};
  std::set<int> threads;
  for (const ThreadScaling& s : report.scaling) threads.insert(s.threads);
  std::vector<std::string> columns = {"where, what"};
  for (const int t : threads) columns.push_back(fmt::format("{} thread{}", t, t == 1 ? "" : "s"));
  Table table("Speed-up over one thread, and in brackets that of the machine's own limit", columns);
  const auto names = distinct(report.scaling, [](const auto& s) { return s.name; });
  for (const MemoryLevel level : kLevels) {
    bool first = true;
    for (const std::string& name : names) {
      std::vector<Html> cells = {html(name)};
      bool any = false;
      for (const int t : threads) {
        const auto found = std::find_if(report.scaling.begin(), report.scaling.end(), [&](const auto& s) {
          return s.name == name && s.level == level && s.threads == t;
        });
        const bool there = found != report.scaling.end();
        any = any || there;
        cells.push_back(
            html(there ? fmt::format("{} ({})", number(found->speed_up), number(found->limit)) : kDash));
      }
      if (!any) continue;
      if (first) table.group(level_name(level));
      first = false;
      table.row(cells);
    }
  }
  return make_section("threads", "Threads", "Several threads", fmt::format("{}", table.code()));
}

}  // namespace spectile::report
