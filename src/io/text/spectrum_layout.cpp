// The arrangement of a text of columns, found in one pass over its lines.
#include "src/io/text/spectrum_layout.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "src/io/text/spectrum_headings.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile::io {
namespace {

/// Fewer cells are no row of wavelengths.
constexpr std::size_t kMinRow = 3;
/// Shorter runs that begin anew are samples out of order.
constexpr std::size_t kMinRun = 10;

bool starts_with_ignoring_case(std::string_view text, std::string_view lower) {
  return text.size() >= lower.size() &&
         std::equal(lower.begin(), lower.end(), text.begin(),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

bool ascends_or_descends(const std::vector<double>& w) {
  return std::ranges::adjacent_find(w, std::greater_equal<>()) == w.end() ||
         std::ranges::adjacent_find(w, std::less_equal<>()) == w.end();
}

/// True if wavelengths without a unit of their own, or in this one, lie in the visible range.
bool are_visible(const std::vector<double>& w, std::optional<WavelengthUnit> unit) {
  if (unit) return covers_visible(w, *unit);
  const UnitGuess guess = guess_unit(w);
  return guess.unit || guess.another;
}

constexpr std::string_view kMeterLabel = "spectral data";

/// Passes over the lines and keeps what tells the arrangement.
class LayoutFinder {
 public:
  LayoutFinder(const TextFile& file, std::optional<WavelengthUnit> stated_unit)
      : file_(file), stated_(stated_unit) {
    out_.format = find_cell_format(file);
  }

  Layout find() {
    for (std::size_t i = 0; i < file_.lines.size(); ++i) {
      const std::string_view text = without_comment(file_.lines[i]);
      if (text.empty()) continue;
      split_cells(text, out_.format, cells_);
      if (!cells_.empty()) line(i + 1);
    }
    decide();
    return out_;
  }

 private:
  bool decimal() const { return out_.format.decimal_comma; }

  void line(std::size_t number) {
    if (out_.arrangement == Arrangement::kRows) return;
    const auto first = wavelength_cell(cells_.front(), decimal());
    if (out_.arrangement == Arrangement::kNamed) {
      // The line of three cells was a heading: "Date,12,2021".
      if (!first || cells_.size() != 2) return;
      out_.arrangement = Arrangement::kColumns;
      out_.first_line = 0;
      out_.heading_line = number - 1;
    }
    if (first) return sample(number, *first);
    if (out_.first_line != 0 || !begins_like_a_word(cells_.front())) {
      // A damaged sample; the reader names it.
      if (out_.first_line == 0 && !begins_like_a_word(cells_.front())) out_.first_line = number;
      return;
    }
    heading(number);
  }

  void heading(std::size_t number) {
    if (row_.empty() && is_row_of_wavelengths()) {
      out_.heading_line = number;
      return;
    }
    if (!row_.empty() && cells_.size() == row_.size() + 1 && values_follow()) {
      out_.arrangement = Arrangement::kRows;
      out_.first_line = number;
      return;
    }
    if (is_named_sample()) {
      out_.arrangement = Arrangement::kNamed;
      out_.first_line = number;
      return;
    }
    if (cells_.size() > kMinRow && values_follow() && out_.orphan_line == 0) out_.orphan_line = number;
    row_.clear();
    out_.heading_line = number;
  }

  /// True for "name,wavelength,value", but not for a heading of columns that are numbered.
  bool is_named_sample() const {
    if (out_.format.delimiter == 0 || cells_.size() != 3 || cells_[0].empty()) return false;
    const auto at = wavelength_cell(cells_[1], decimal());
    const auto value = cell_number(cells_[2], decimal());
    if (!at || !value || unit_of_heading(cells_[0]) || !part_on_wavelengths(cells_[0]).empty()) return false;
    constexpr double kMaxColumn = 100;
    const auto counts = [](double v) { return v >= 0 && v < kMaxColumn && std::floor(v) == v; };
    return !counts(at->value) || !counts(value->value);
  }

  /// True if all cells but the first are numbers or empty, and one is a number.
  bool values_follow() const {
    bool any = false;
    for (std::size_t i = 1; i < cells_.size(); ++i) {
      if (cells_[i].empty()) continue;
      if (!cell_number(cells_[i], decimal())) return false;
      any = true;
    }
    return any;
  }

  /// Takes the cells behind the first as the row of wavelengths if they can be that.
  bool is_row_of_wavelengths() {
    std::vector<double> row;
    std::optional<WavelengthUnit> unit = stated_;
    for (std::size_t i = 1; i < cells_.size(); ++i) {
      const auto cell = wavelength_heading(cells_[i], decimal());
      if (!cell) return false;
      row.push_back(cell->value);
      if (!unit) unit = cell->unit;
    }
    if (!unit) {
      if (const auto named = unit_of_heading(cells_.front())) unit = named->unit;
    }
    if (row.size() < kMinRow || !ascends_or_descends(row) || !are_visible(row, unit)) return false;
    row_ = std::move(row);
    corner_names_wavelengths_ =
        !part_on_wavelengths(cells_.front()).empty() || unit_of_heading(cells_.front());
    return true;
  }

  void sample(std::size_t number, const WavelengthCell& first) {
    if (out_.first_line == 0) {
      out_.first_line = number;
      first_cells_ = cells_.size();
      take_first_row();
    }
    if (!unit_) unit_ = first.unit;
    if (starts_with_ignoring_case(cells_.front(), kMeterLabel)) out_.labelled = true;
    wavelengths_.push_back(first.value);
    even_row_ = even_row_ && cells_.size() == row_.size() + 1;
    nameless_row_ = nameless_row_ && cells_.size() == first_cells_;
    pairs(first.value);
  }

  /// The first row could itself be wavelengths.
  void take_first_row() {
    for (const std::string_view cell : cells_) {
      const auto number = wavelength_cell(cell, decimal());
      if (!number) return first_row_.clear();
      first_row_.push_back(number->value);
    }
  }

  /// Follows the wavelengths of pairs through all lines.
  void pairs(double first) {
    std::size_t count = cells_.size();
    while (count > 0 && cells_[count - 1].empty()) --count;
    longest_ = std::max(longest_, count);
    if (count % 2 != 0) are_pairs_ = false;
    for (std::size_t i = 0; are_pairs_ && i < count; i += 2) {
      const auto cell =
          i == 0 ? WavelengthCell{first, {}}
                 : wavelength_cell(cells_[i], decimal()).value_or(WavelengthCell{std::nan(""), {}});
      const bool next =
          pair_count_ == 0 || (pair_count_ == 1 && cell.value != last_) || (cell.value > last_) == ascending_;
      if (!next || std::isnan(cell.value) || cell.value == (pair_count_ == 0 ? std::nan("") : last_))
        are_pairs_ = false;
      if (pair_count_ == 1) ascending_ = cell.value > last_;
      last_ = cell.value;
      ++pair_count_;
      pair_first_ = pair_count_ == 1 ? cell.value : pair_first_;
    }
  }

  void decide() {
    if (wavelengths_.empty() || out_.arrangement != Arrangement::kColumns) return;
    const std::optional<WavelengthUnit> unit = stated_ ? stated_ : unit_;
    if (out_.format.colons ||
        (are_pairs_ && longest_ >= 4 && pair_count_ >= 2 && are_visible({pair_first_, last_}, unit))) {
      out_.arrangement = Arrangement::kPairs;
      return;
    }
    const bool columns = are_visible(wavelengths_, unit);
    if (!row_.empty() && even_row_ && !corner_names_wavelengths_) {
      out_.arrangement = Arrangement::kRows;
      out_.two_readings = columns && ascends_or_descends(wavelengths_);
      return;
    }
    if (!row_.empty() && even_row_ && !columns) {
      out_.arrangement = Arrangement::kRows;
      return;
    }
    const std::vector<double> rest(wavelengths_.begin() + 1, wavelengths_.end());
    if (first_row_.size() >= kMinRow && nameless_row_ && !rest.empty() && ascends_or_descends(first_row_) &&
        covers_visible(first_row_, WavelengthUnit::kNm) && std::ranges::min(first_row_) >= 100 &&
        std::ranges::max(rest) < 100) {
      out_.arrangement = Arrangement::kNamelessRows;
      return;
    }
    find_runs();
  }

  /// A meter writes its spectrum in steps of 5 nm and once more of 1 nm.
  void find_runs() {
    std::vector<std::size_t> starts = {0};
    for (std::size_t i = 1; i < wavelengths_.size(); ++i) {
      if (wavelengths_[i] > wavelengths_[i - 1]) continue;
      if (wavelengths_[i] != wavelengths_.front()) return;
      starts.push_back(i);
    }
    if (starts.size() < 2) return;
    starts.push_back(wavelengths_.size());
    for (std::size_t r = 0; r + 1 < starts.size(); ++r) {
      const std::size_t count = starts[r + 1] - starts[r];
      if (count < kMinRun) return;
    }
    out_.runs = starts.size() - 1;
    for (std::size_t r = 0; r + 1 < starts.size(); ++r) {
      const std::size_t count = starts[r + 1] - starts[r];
      if (count <= out_.run_count) continue;
      out_.run_first = starts[r];
      out_.run_count = count;
    }
  }

  const TextFile& file_;
  std::optional<WavelengthUnit> stated_;
  Layout out_;
  std::vector<std::string_view> cells_;
  std::vector<double> row_;  // of wavelengths, in a heading
  bool corner_names_wavelengths_ = false;
  bool even_row_ = true;           // every line of samples has a cell more than row_
  std::vector<double> first_row_;  // of samples; empty: not all numbers
  std::size_t first_cells_ = 0;
  bool nameless_row_ = true;
  std::vector<double> wavelengths_;  // first cells of samples
  std::optional<WavelengthUnit> unit_;
  bool are_pairs_ = true;
  bool ascending_ = true;
  double last_ = 0;
  double pair_first_ = 0;
  std::size_t pair_count_ = 0;
  std::size_t longest_ = 0;
};

}  // namespace

std::optional<WavelengthCell> wavelength_cell(std::string_view cell, bool decimal_comma) {
  if (starts_with_ignoring_case(cell, kMeterLabel)) {
    cell.remove_prefix(kMeterLabel.size());
    cell.remove_prefix(std::min(cell.find_first_not_of(' '), cell.size()));
  }
  const auto number = cell_number(cell, decimal_comma);
  if (!number) return std::nullopt;
  WavelengthCell out{number->value, std::nullopt};
  if (number->unit.empty()) return out;
  out.unit = unit_behind_number(number->unit);
  if (!out.unit) return std::nullopt;
  return out;
}

std::optional<WavelengthCell> wavelength_heading(std::string_view cell, bool decimal_comma) {
  if (const auto plain = wavelength_cell(cell, decimal_comma)) return plain;
  const std::size_t digits = cell.find_first_of("0123456789");
  if (digits == std::string_view::npos || digits == 0) return std::nullopt;
  const std::string_view prefix = cell.substr(0, digits);
  for (const char* known : {"nm", "nm_", "nm ", "spec", "spec_", "spectral_", "spectral_nm", "spectral_nm_",
                            "r", "r_", "t", "t_", "wl", "wl_", "lambda", "lambda_"}) {
    if (prefix.size() != std::string_view(known).size() || !starts_with_ignoring_case(prefix, known))
      continue;
    auto out = wavelength_cell(cell.substr(digits), decimal_comma);
    const bool nm = std::string_view(known).find("nm") != std::string_view::npos;
    if (out && !out->unit && nm) out->unit = WavelengthUnit::kNm;
    return out;
  }
  return std::nullopt;
}

Layout find_layout(const TextFile& file, std::optional<WavelengthUnit> stated_unit) {
  return LayoutFinder(file, stated_unit).find();
}

}  // namespace spectile::io
