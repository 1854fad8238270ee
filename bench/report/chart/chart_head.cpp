// The head of a chart: its title, broken into lines, and the legend in rows.
#include "bench/report/chart/chart_head.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/report/chart/chart_labels.hpp"
#include "bench/report/text.hpp"

namespace spectile::report {
namespace {

constexpr double kLeft = 12;
constexpr double kKeyWidth = 24;
constexpr double kBetween = 14;

}  // namespace

Block title_block(const std::string& text, double width, double font_size) {
  Block block;
  std::string line;
  const auto flush = [&] {
    block.height += 1.35 * font_size;
    block.code +=
        fmt::format("<text x=\"{}\" y=\"{:.1f}\" font-size=\"{:.1f}\" font-weight=\"600\">{}</text>\n", kLeft,
                    block.height, font_size, escaped(line));
    line.clear();
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    std::string longer = line;
    if (!line.empty()) longer += ' ';
    longer += word;
    if (!line.empty() && text_width(longer, font_size) > width - 2 * kLeft) {
      flush();
      longer = word;
    }
    line = longer;
    at = end + 1;
  }
  if (!line.empty()) flush();
  block.height += 0.4 * font_size;
  return block;
}

Block legend_block(const std::vector<LegendEntry>& entries, double width, double font_size) {
  Block block;
  if (entries.empty()) return block;
  const double row = 1.45 * font_size;
  double x = kLeft;
  double y = 0.75 * row;
  for (const LegendEntry& entry : entries) {
    const double wide = kKeyWidth + text_width(entry.name, font_size) + kBetween;
    if (x > kLeft && x + wide - kBetween > width) {
      x = kLeft;
      y += row;
    }
    block.code += fmt::format(
        "<g transform=\"translate({:.1f} {:.1f})\">{}</g>\n<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        x + 8, y - 0.34 * font_size, entry.key, x + kKeyWidth, y, escaped(entry.name));
    x += wide;
  }
  block.height = y + 0.6 * row;
  return block;
}

}  // namespace spectile::report
