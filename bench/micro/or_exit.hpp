// What benchmarks do with errors: say them and end.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <spectile/result.hpp>
#include <string>
#include <utility>
#include <vector>

namespace bench {

template <class T>
T value_or_exit(spectile::Result<T> result) {
  if (result) return *std::move(result);
  fmt::print(stderr, "{}\n", result.error().message);
  std::exit(1);
}

inline void done_or_exit(const spectile::Result<void>& result) {
  if (result) return;
  fmt::print(stderr, "{}\n", result.error().message);
  std::exit(1);
}

inline void write_or_exit(const std::string& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  if (out.flush()) return;
  fmt::print(stderr, "{} cannot be written\n", path);
  std::exit(1);
}

inline double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

}  // namespace bench
