// The head of a chart: its title, broken into lines, and the legend in rows.
#pragma once

#include <string>
#include <vector>

namespace spectile::report {

/// SVG of a given height, drawn from y = 0 down.
struct Block {
  std::string code;
  double height = 0;
};

struct LegendEntry {
  std::string name;
  std::string key;  ///< SVG round (0, 0), about a font size large
};

/// Text broken between words, in a font of this size.
Block title_block(const std::string& text, double width, double font_size);
/// Entries from left to right, in as many rows as they need.
Block legend_block(const std::vector<LegendEntry>& entries, double width, double font_size);

}  // namespace spectile::report
