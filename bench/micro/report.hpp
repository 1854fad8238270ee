// A run of benchmarks, interleaved at random, as a table of speeds with an error and a ratio beside each.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <spectile/result.hpp>
#include <string>
#include <vector>

namespace report {

/// The value, or the end of the program with the error's sentence.
template <class T>
T need(spectile::Result<T> result) {
  if (!result) {
    fmt::print(stderr, "{}\n", result.error().message);
    std::exit(1);
  }
  return *std::move(result);
}

inline void need(spectile::Result<void> result) {
  if (result) return;
  fmt::print(stderr, "{}\n", result.error().message);
  std::exit(1);
}

/// One line of the result.
struct Line {
  std::string name;
  double items = 0;  // a call
  double bytes = 0;  // a call
  void (*run)() = nullptr;
  double (*error)() = nullptr;  // relative, against double
  std::string baseline;         // line that it is compared with
  bool by_bytes = false;        // compare bytes a second rather than items a second
  double target = 0;            // least ratio to the baseline; 0 for none
  double most_ns = 0;           // most nanoseconds an item; 0 for no such target
};

/// Runs all lines and prints the table; 1 where a target was missed. Options are Google Benchmark's.
int run(int argc, char** argv, const std::vector<Line>& lines, const std::string& heading);

}  // namespace report
