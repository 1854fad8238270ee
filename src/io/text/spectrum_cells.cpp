// Lines of a table as cells: comments, quotation marks, separators, decimal commas, numbers with units.
#include "src/io/text/spectrum_cells.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace spectile::io {
namespace {

constexpr std::string_view kBlank = " \t\f\v";
constexpr std::string_view kAnySeparator = ",; \t\f\v";

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view trim(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  return text.substr(0, text.find_last_not_of(kBlank) + 1);
}

/// Counts the numbers that `text` holds between any separators, up to two.
int numbers_before(std::string_view text) {
  int count = 0;
  while (count < 2) {
    text.remove_prefix(std::min(text.find_first_not_of(kAnySeparator), text.size()));
    if (text.empty()) break;
    const std::string_view word = text.substr(0, text.find_first_of(kAnySeparator));
    if (!begins_like_a_word(word)) ++count;
    text.remove_prefix(word.size());
  }
  return count;
}

/// Counts over the lines from which the format follows.
struct Counts {
  std::size_t lines = 0;
  std::size_t semicolons = 0, tabs = 0, commas = 0;  ///< lines that hold one
  std::size_t colons = 0;                            ///< lines whose first number ends in a colon
  std::size_t points = 0;                            ///< between digits
  std::size_t comma_digits = 0;                      ///< commas between digits
  std::size_t bare_commas = 0;                       ///< those that no quotation marks enclose
  bool spaced_commas =
      true;           ///< every line is two or more numbers apart by blanks, each with a comma at most
  bool pairs = true;  ///< every word between blanks has a comma, the digits before them ascend
  double last = -1;
};

/// Words between blanks as numbers with decimal commas.
void count_spaced(std::string_view line, Counts& out) {
  int words = 0;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    if (line.empty()) break;
    const std::string_view word = line.substr(0, line.find_first_of(kBlank));
    line.remove_prefix(word.size());
    ++words;
    const auto commas = std::ranges::count(word, ',');
    const std::size_t at = word.find(',');
    const bool inside =
        commas == 0 || (at > 0 && at + 1 < word.size() && is_digit(word[at - 1]) && is_digit(word[at + 1]));
    const auto number = cell_number(word, true);
    out.spaced_commas = out.spaced_commas && commas <= 1 && inside && number && number->unit.empty();
    double before = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), before);
    out.pairs = out.pairs && commas == 1 && error == std::errc{} && *end == ',' && before > out.last;
    out.last = before;
  }
  out.spaced_commas = out.spaced_commas && words >= 2;
}

void count_line(std::string_view line, Counts& out) {
  ++out.lines;
  out.semicolons += line.find(';') != std::string_view::npos ? 1 : 0;
  out.tabs += line.find('\t') != std::string_view::npos ? 1 : 0;
  out.commas += line.find(',') != std::string_view::npos ? 1 : 0;
  bool in_quotes = line.starts_with('"');
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    if (line[i] == '"') in_quotes = !in_quotes;
    if (!is_digit(line[i - 1]) || !is_digit(line[i + 1])) continue;
    out.points += line[i] == '.' ? 1 : 0;
    out.comma_digits += line[i] == ',' ? 1 : 0;
    out.bare_commas += line[i] == ',' && !in_quotes ? 1 : 0;
  }
  const std::size_t digits = line.find_first_not_of("0123456789.");
  out.colons += digits != 0 && digits != std::string_view::npos && line[digits] == ':' ? 1 : 0;
  count_spaced(line, out);
}

bool begins_with_number(std::string_view line) {
  if (line.starts_with('"')) line.remove_prefix(1);
  return !line.empty() && !begins_like_a_word(line);
}

/// So many lines of samples tell the format of all.
constexpr std::size_t kMaxTellingLines = 10000;

/// Calls `take` with the lines that tell the format.
template <class Take>
void for_telling_lines(const TextFile& file, bool numbers_first, const Take& take) {
  std::size_t count = 0;
  for (const std::string_view whole : file.lines) {
    const std::string_view line = without_comment(whole);
    if (line.empty()) continue;
    if (numbers_first ? begins_with_number(line) && line.find_first_of(",;: \t") != std::string_view::npos
                      : numbers_before(line) == 2) {
      take(line);
      if (++count == kMaxTellingLines) return;
    }
  }
}

/// True if the first cell of every telling line is a number with at most a unit behind it, and no cell holds
/// two.
bool fits(const TextFile& file, bool numbers_first, const CellFormat& format) {
  std::vector<std::string_view> cells;
  bool good = true;
  for_telling_lines(file, numbers_first, [&](std::string_view line) {
    if (!good) return;
    split_cells(line, format, cells);
    for (const std::string_view cell : cells) {
      const auto number = cell_number(cell, format.decimal_comma);
      // A second number behind the first: blanks separate as well.
      if (number && !number->unit.empty() && !begins_like_a_word(number->unit)) {
        good = false;
      }
    }
  });
  return good;
}

/// True if all telling lines have as many cells.
bool even_rows(const TextFile& file, bool numbers_first, const CellFormat& format) {
  std::vector<std::string_view> cells;
  std::size_t count = 0;
  bool good = true;
  for_telling_lines(file, numbers_first, [&](std::string_view line) {
    split_cells(line, format, cells);
    good = good && (count == 0 || cells.size() == count);
    count = cells.size();
  });
  return good;
}

}  // namespace

bool begins_like_a_word(std::string_view cell) {
  return cell.empty() ||
         (!is_digit(cell.front()) && std::string_view("+-.").find(cell.front()) == std::string_view::npos);
}

std::string_view without_comment(std::string_view line) {
  line = trim(line);
  bool in_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') in_quotes = !in_quotes;
    if (in_quotes) continue;
    if (c == '#' || (c == '/' && i + 1 < line.size() && line[i + 1] == '/')) {
      line = line.substr(0, i);
      break;
    }
    if (c != ';') continue;
    const std::string_view before = trim(line.substr(0, i));
    const std::string_view after = trim(line.substr(i + 1));
    const bool words = !after.empty() && after.front() != '"' && begins_like_a_word(after) &&
                       kAnySeparator.find(after.front()) == std::string_view::npos;
    if ((before.empty() && (words || after.empty())) ||
        (words && numbers_before(before) == 2 && before.find(';') == std::string_view::npos)) {
      line = before;
      break;
    }
    if (words) break;  // of two semicolons the first separates; later ones need no second look
  }
  return trim(line);
}

std::optional<CellNumber> cell_number(std::string_view cell, bool decimal_comma) {
  if (cell.size() > 1 && cell.front() == '+' && cell[1] != '-' && cell[1] != '+') cell.remove_prefix(1);
  std::array<char, 64> copy{};
  const char* first = cell.data();
  std::size_t size = cell.size();
  if (decimal_comma && cell.find(',') != std::string_view::npos && size <= copy.size()) {
    // "1.234,5" is no number: a point stays none.
    if (cell.find('.') < cell.find(',')) return std::nullopt;
    std::ranges::copy(cell, copy.begin());
    copy[cell.find(',')] = '.';
    first = copy.data();
  }
  CellNumber out;
  const auto [end, error] = std::from_chars(first, first + size, out.value);
  if (error != std::errc{}) return std::nullopt;
  out.unit = trim(cell.substr(static_cast<std::size_t>(end - first)));
  return out;
}

void split_cells(std::string_view line, const CellFormat& format, std::vector<std::string_view>& cells) {
  cells.clear();
  const bool any = format.delimiter == 0;
  const auto separates = [&](char c) {
    if (format.colons && c == ':') return true;
    if (!any) return c == format.delimiter;
    return kAnySeparator.find(c) != std::string_view::npos && !(c == ',' && format.decimal_comma);
  };
  std::size_t at = 0;
  while (at <= line.size()) {
    while (at < line.size() && (any ? separates(line[at]) : line[at] == ' ')) ++at;
    if (any && at >= line.size()) break;
    if (at < line.size() && line[at] == '"') {
      const std::size_t end = std::min(line.find('"', at + 1), line.size());
      cells.push_back(trim(line.substr(at + 1, end - at - 1)));
      at = end;
      while (at < line.size() && !separates(line[at])) ++at;
    } else {
      std::size_t end = at;
      while (end < line.size() && !separates(line[end])) ++end;
      cells.push_back(trim(line.substr(at, end - at)));
      at = end;
    }
    if (at >= line.size()) break;
    ++at;
  }
}

CellFormat find_cell_format(const TextFile& file) {
  bool numbers_first = true;
  Counts counts;
  const auto add = [&](std::string_view line) { count_line(line, counts); };
  for_telling_lines(file, true, add);
  if (counts.lines == 0) {
    numbers_first = false;
    for_telling_lines(file, false, add);
  }
  CellFormat out;
  if (counts.lines == 0) return out;
  out.colons = counts.colons == counts.lines;
  if (out.colons) return out;
  const bool decimals = counts.comma_digits > 0 && counts.points == 0;
  if (counts.semicolons == counts.lines) {
    out.delimiter = ';';
  } else if (counts.tabs == counts.lines) {
    out.delimiter = '\t';
  } else if (decimals && counts.spaced_commas && !counts.pairs) {
    out.decimal_comma = true;
    return out;
  } else if (counts.commas == counts.lines) {
    out.delimiter = ',';
  }
  if (out.delimiter == 0) return out;
  out.decimal_comma = decimals && (out.delimiter != ',' || counts.bare_commas == 0);
  if (!fits(file, numbers_first, out)) return {};
  // Tabs may stand several at a time between columns that are lined up.
  if (out.delimiter == '\t' && !even_rows(file, numbers_first, out)) {
    CellFormat aligned = out;
    aligned.delimiter = 0;
    if (even_rows(file, numbers_first, aligned)) return aligned;
  }
  return out;
}

}  // namespace spectile::io
