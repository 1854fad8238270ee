// The sections of a report's page. Each is empty where the report has nothing for it.
#pragma once

#include <spectile/bench/benchmark.hpp>
#include <string>
#include <vector>

namespace spectile::report {

/// A section of the page, listed in its navigation.
struct Section {
  std::string id;
  std::string name;  ///< in the navigation
  std::string code;
};

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

/// The values of a field in their order of appearance, each once.
template <class T, class F>
std::vector<std::string> distinct(const std::vector<T>& items, F field) {
  std::vector<std::string> out;
  for (const T& item : items) {
    const std::string value = field(item);
    bool known = false;
    for (const std::string& other : out) known = known || other == value;
    if (!known) out.push_back(value);
  }
  return out;
}

}  // namespace spectile::report
