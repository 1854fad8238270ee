// A table of a page: caption, heads, groups of rows; wide ones scroll in a box of their own.
#include "bench/report/table.hpp"

#include <fmt/format.h>

#include <utility>

namespace spectile::report {

Table::Table(std::string caption, std::vector<Column> columns)
    : caption_(std::move(caption)), columns_(std::move(columns)) {}

void Table::group(const std::string& name) {
  rows_ += fmt::format(
      "{}<tbody>\n<tr class=\"group\"><th scope=\"rowgroup\" colspan=\"{}\"><span>{}</span></th></tr>\n",
      rows_.empty() ? "" : "</tbody>\n", columns_.size(), escaped(name));
}

void Table::row(const std::vector<Html>& cells, const std::string& kind) {
  if (rows_.empty()) rows_ += "<tbody>\n";
  rows_ += kind.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", kind);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const char* words = i < columns_.size() && columns_[i].words ? " class=\"words\"" : "";
    rows_ += i == 0 ? fmt::format("<th scope=\"row\"{}>{}</th>", words, cells[i].code)
                    : fmt::format("<td{}>{}</td>", words, cells[i].code);
  }
  rows_ += "</tr>\n";
}

std::string Table::code() const {
  std::string heads;
  for (const Column& column : columns_) {
    heads += fmt::format("<th scope=\"col\"{}>{}</th>", column.words ? " class=\"words\"" : "",
                         escaped(column.head));
  }
  // Reached by the keyboard, as what scrolls must be.
  return fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{0}\">\n<table>\n"
      "<caption><span>{0}</span></caption>\n<thead><tr>{1}</tr></thead>\n{2}{3}</table>\n</div>\n",
      escaped(caption_), heads, rows_, rows_.empty() ? "" : "</tbody>\n");
}

}  // namespace spectile::report
