// Facts that the lines in front of a table's samples state: unit, percent, quantity, names of columns.
#include <algorithm>

#include "src/io/text/spectrum_headings.hpp"
#include "src/io/text/spectrum_layout.hpp"

namespace spectile::io {
namespace {

/// A heading of the wavelengths themselves wins over what other lines say.
void take_unit(TableHeadings& out, std::string_view heading, bool of_wavelengths) {
  const auto named = unit_of_heading(heading);
  const bool known = out.unit || !out.unknown_unit.empty();
  if (!named || (known && !of_wavelengths)) return;
  out.unit = named->unit;
  out.unknown_unit = named->unknown;
}

}  // namespace

TableHeadings read_headings(const TextFile& file, const Layout& layout) {
  TableHeadings out;
  const std::size_t end = std::max(layout.heading_line + 1, layout.first_line);
  for (std::size_t i = 1; i < end; ++i) {
    const std::string_view text = file.lines[i - 1];
    take_unit(out, part_on_wavelengths(text), false);
    if (!describes_values(text)) continue;
    out.percent = out.percent || says_percent(text);
    if (out.quantity.empty()) out.quantity = quantity_of_heading(text);
  }
  if (layout.heading_line == 0) return out;
  std::vector<std::string_view> cells;
  split_cells(without_comment(file.lines[layout.heading_line - 1]), layout.format, cells);
  if (cells.size() < 2) return out;
  take_unit(out, cells.front(), true);
  if (layout.arrangement == Arrangement::kRows) return out;
  for (const std::string_view cell : cells) {
    out.cells.emplace_back(cell);
    if (out.quantity.empty()) out.quantity = quantity_of_heading(cell);
  }
  return out;
}

}  // namespace spectile::io
