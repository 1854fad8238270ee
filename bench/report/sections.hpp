// The sections of a report's page. Each is empty where the report has nothing for it.
#pragma once

#include <algorithm>
#include <spectile/bench/benchmark.hpp>
#include <string>
#include <vector>

#include "bench/report/chart/svg_chart.hpp"

namespace spectile::report {

/// A section of the page, listed in its navigation.
struct Section {
  std::string id;
  std::string name;  ///< in the navigation
  std::string code;
};

/// A section with its heading above the body, which is HTML.
Section make_section(const std::string& id, const std::string& name, const std::string& heading,
                     const std::string& body);

/// The style sheet, for a screen of any width and for paper.
extern const char* const kStyleSheet;

/// Per job and light: error against time, and its table.
std::vector<Section> method_sections(const BenchmarkReport& report);
Section representation_section(const BenchmarkReport& report);
Section operation_section(const BenchmarkReport& report);
/// The engine beside the AoS baseline.
Section baseline_section(const BenchmarkReport& report);
Section limit_section(const BenchmarkReport& report);
Section scaling_section(const BenchmarkReport& report);
Section stress_section(const BenchmarkReport& report);

/// A row whose numbers do not hold: some cases beyond the bound, or the worst is.
bool is_beyond(const StressResult& result);
std::string level_name(MemoryLevel level);
/// The heading of a light's part, and its chart for wide and narrow screens where it has marks; `note` is
/// added to the caption. `id`: an attribute, or empty.
std::string light_head(const std::string& id, const std::string& light, bool line_spectrum,
                       const Chart& chart, const char* note);

/// The values of a field in their order of appearance, each once.
template <class T, class F>
std::vector<std::string> distinct(const std::vector<T>& items, F field) {
  std::vector<std::string> out;
  for (const T& item : items) {
    const std::string value = field(item);
    if (std::find(out.begin(), out.end(), value) == out.end()) out.push_back(value);
  }
  return out;
}

}  // namespace spectile::report
