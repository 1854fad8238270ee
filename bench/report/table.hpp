// A table of a page: caption, heads, groups of rows; wide ones scroll in a box of their own.
#pragma once

#include <string>
#include <vector>

#include "bench/report/text.hpp"

namespace spectile::report {

class Table {
 public:
  /// `words`: the columns that are set to the left; numbers are set to the right.
  Table(std::string caption, std::vector<std::string> heads, std::vector<std::size_t> words = {0});

  /// Begins a group of rows with a head of its own.
  void group(const std::string& name);
  /// One cell a column; the first is the row's head. `kind`: its class, of the style sheet.
  void row(const std::vector<Html>& cells, const std::string& kind = "");

  std::string code() const;

 private:
  /// The class of a column's cells, as an attribute.
  const char* column_class(std::size_t column) const;

  std::string caption_;
  std::vector<std::string> heads_;
  std::vector<std::size_t> words_;
  std::string rows_;
};

}  // namespace spectile::report
