// A spectrum drawn in the terminal.
#include "src/cli/output/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spectile::cli {
namespace {

constexpr int kColumns = 60;
constexpr int kRows = 10;

// Eighths of a character cell, from the bottom up.
constexpr const char* kEighths[] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};

}  // namespace

std::vector<std::string> plot_columns(std::span<const double> values, int rows, double first_nm,
                                      double last_nm) {
  double top = 0;
  double bottom = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    top = std::max(top, v);
    bottom = std::min(bottom, v);
  }
  if (top == bottom) top = bottom + 1;
  std::vector<int> heights;  // in eighths of a row
  for (const double value : values) {
    // Divided first, as the difference of the largest values is infinite.
    const double range = top / 2 - bottom / 2;
    const double v = std::isfinite(value) ? (value / 2 - bottom / 2) / range : 0.0;
    heights.push_back(static_cast<int>(std::lround(v * 8 * rows)));
  }
  std::vector<std::string> lines;
  for (int row = rows - 1; row >= 0; --row) {
    const double part = (row + 1.0) / rows;
    std::string line = row == rows - 1 || row == rows / 2 - 1
                           ? fmt::format("{:>9.4g} │", (1 - part) * bottom + part * top)
                           : "          │";
    for (const int height : heights) line += kEighths[std::clamp(height - 8 * row, 0, 8)];
    lines.push_back(line);
  }
  std::string axis = fmt::format("{:>9.4g} └", bottom);
  for (std::size_t column = 0; column < values.size(); ++column) axis += "─";
  lines.push_back(axis);
  const std::size_t third = values.size() / 3;
  lines.push_back(fmt::format("           {:<{}.6g}{:^{}.6g}{:>{}}", first_nm, third,
                              0.5 * (first_nm + last_nm), values.size() - 2 * third,
                              fmt::format("{:.6g} nm", last_nm), third));
  return lines;
}

std::vector<std::string> plot(std::span<const float> values, const Bands& bands) {
  const auto [first, last] = bands.range_nm();
  std::vector<double> columns;
  for (int column = 0; column < kColumns; ++column) {
    const double lambda = first + (column + 0.5) / kColumns * (last - first);
    std::size_t b = 0;
    while (b + 1 < bands.count() && bands[b].upper_nm <= lambda) ++b;
    // Of bands that overlap, the one whose middle is nearest.
    while (b + 1 < bands.count() && bands[b + 1].lower_nm <= lambda &&
           std::abs(bands[b + 1].centre_nm - lambda) < std::abs(bands[b].centre_nm - lambda))
      ++b;
    columns.push_back(static_cast<double>(values[b]));
  }
  return plot_columns(columns, kRows, first, last);
}

}  // namespace spectile::cli
