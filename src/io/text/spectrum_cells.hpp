// Lines of a table as cells: comments, quotation marks, separators, decimal commas, numbers with units.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "src/io/text/text_file.hpp"

namespace spectile::io {

/// Separators of a file's cells.
struct CellFormat {
  char delimiter = 0;   ///< ',', ';' or '\t', each of which ends a cell; 0: any run of , ; and white space
  bool colons = false;  ///< "380:0.9": a colon separates too
  bool decimal_comma = false;
};

/// A number and the text behind it, a unit.
struct CellNumber {
  double value = 0;
  std::string_view unit;
};

/// The line without its comment (from # or // on, or all of a line that begins with ;, or from a ; behind
/// samples on when words follow), and without white space at its ends.
std::string_view without_comment(std::string_view line);

/// The number that a cell begins with, and what follows it; nothing where it begins with none.
std::optional<CellNumber> cell_number(std::string_view cell, bool decimal_comma);

/// True if a cell begins with a letter or another character that no number begins with. A damaged number
/// does not.
bool begins_like_a_word(std::string_view cell);

/// Cells of a line without its comment, without white space and quotation marks around them. A quotation mark
/// that is not closed runs to the end.
void split_cells(std::string_view line, const CellFormat& format, std::vector<std::string_view>& cells);

/// Finds out which separators a file has, from all its lines that begin with a number, or where there are
/// none, from all that hold two.
CellFormat find_cell_format(const TextFile& file);

}  // namespace spectile::io
