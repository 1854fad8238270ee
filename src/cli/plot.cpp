// A spectrum drawn in the terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/cli/common.hpp"

namespace spectile::cli {
namespace {

constexpr int kColumns = 60;
constexpr int kRows = 10;

// Eighths of a character cell, from the bottom up.
constexpr const char* kEighths[] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};

}  // namespace

std::vector<std::string> plot(std::span<const float> values, const Bands& bands) {
  float top = 0;
  float bottom = 0;
  for (const float v : values) {
    if (!std::isfinite(v)) continue;
    top = std::max(top, v);
    bottom = std::min(bottom, v);
  }
  if (top == bottom) top = bottom + 1;
  const double first = bands[0].lower_nm;
  const double last = bands[bands.count() - 1].upper_nm;
  std::vector<int> heights;  // in eighths of a row
  for (int column = 0; column < kColumns; ++column) {
    const double lambda = first + (column + 0.5) / kColumns * (last - first);
    std::size_t b = 0;
    while (b + 1 < bands.count() && bands[b].upper_nm <= lambda) ++b;
    const double v =
        std::isfinite(values[b]) ? (static_cast<double>(values[b]) - bottom) / (top - bottom) : 0.0;
    heights.push_back(static_cast<int>(std::lround(v * 8 * kRows)));
  }
  std::vector<std::string> lines;
  for (int row = kRows - 1; row >= 0; --row) {
    const double level = bottom + (row + 1.0) / kRows * (top - bottom);
    std::string line =
        row == kRows - 1 || row == kRows / 2 - 1 ? fmt::format("{:>9.4g} │", level) : "          │";
    for (const int height : heights) line += kEighths[std::clamp(height - 8 * row, 0, 8)];
    lines.push_back(line);
  }
  std::string axis = fmt::format("{:>9.4g} └", bottom);
  for (int column = 0; column < kColumns; ++column) axis += "─";
  lines.push_back(axis);
  lines.push_back(fmt::format("           {:<20.6g}{:^20.6g}{:>20}", first, 0.5 * (first + last),
                              fmt::format("{:.6g} nm", last)));
  return lines;
}

}  // namespace spectile::cli
