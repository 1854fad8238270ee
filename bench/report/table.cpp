// A table of a page: caption, heads, groups of rows; wide ones scroll in a box of their own.
#include "bench/report/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace spectile::report {

Table::Table(std::string caption, std::vector<std::string> heads, std::vector<std::size_t> words)
    : caption_(std::move(caption)), heads_(std::move(heads)), words_(std::move(words)) {}

const char* Table::column_class(std::size_t column) const {
  return std::find(words_.begin(), words_.end(), column) != words_.end() ? " class=\"words\"" : "";
}

void Table::group(const std::string& name) {
  rows_ += fmt::format(
      "{}<tbody>\n<tr class=\"group\"><th scope=\"rowgroup\" colspan=\"{}\"><span>{}</span></th></tr>\n",
      rows_.empty() ? "" : "</tbody>\n", heads_.size(), escaped(name));
}

void Table::row(const std::vector<Html>& cells, const std::string& kind) {
  if (rows_.empty()) rows_ += "<tbody>\n";
  rows_ += kind.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", kind);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    rows_ += fmt::format(fmt::runtime(i == 0 ? "<th scope=\"row\"{}>{}</th>" : "<td{}>{}</td>"),
                         column_class(i), cells[i].code);
  }
  rows_ += "</tr>\n";
}

std::string Table::code() const {
  std::string heads;
  for (std::size_t i = 0; i < heads_.size(); ++i) {
    heads += fmt::format("<th scope=\"col\"{}>{}</th>", column_class(i), escaped(heads_[i]));
  }
  // Reached by the keyboard, as what scrolls must be.
  return fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{0}\">\n<table>\n"
      "<caption><span>{0}</span></caption>\n<thead><tr>{1}</tr></thead>\n{2}{3}</table>\n</div>\n",
      escaped(caption_), heads, rows_, rows_.empty() ? "" : "</tbody>\n");
}

}  // namespace spectile::report
