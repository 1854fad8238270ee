// Columns, pairs, lists by name and rows of spectra, read as their layout says.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "src/base/errors.hpp"
#include "src/io/text/spectrum_headings.hpp"
#include "src/io/text/spectrum_layout.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile::io {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class ColumnsReader {
 public:
  ColumnsReader(const TextFile& file, std::optional<WavelengthUnit> stated) : file_(file), stated_(stated) {}

  Result<RawTable> read() {
    layout_ = find_layout(file_, stated_);
    SPECTILE_TRY(check_layout());
    SPECTILE_TRY(take_headings());
    for (std::size_t i = layout_.first_line; i <= file_.lines.size(); ++i) {
      const std::string_view text = without_comment(file_.lines[i - 1]);
      if (text.empty()) continue;
      split_cells(text, layout_.format, cells_);
      if (!cells_.empty()) SPECTILE_TRY(line(text, i));
    }
    SPECTILE_TRY(check_table());
    finish_notes();
    return std::move(out_);
  }

 private:
  bool decimal() const { return layout_.format.decimal_comma; }
  bool is_rows() const {
    return layout_.arrangement == Arrangement::kRows || layout_.arrangement == Arrangement::kNamelessRows;
  }

  Result<void> check_layout() const {
    if (layout_.first_line == 0 && layout_.orphan_line != 0) {
      return line_error(file_, layout_.orphan_line,
                        "a name and values, but no heading row of wavelengths says where they lie");
    }
    if (layout_.first_line == 0) {
      return make_error(ErrorCode::kBadFile,
                        "{}: holds no sample, which is a line \"wavelength_nm,value,...\" or "
                        "\"name,wavelength_nm,value\"",
                        file_.path);
    }
    if (layout_.two_readings) {
      return line_error(file_, layout_.heading_line,
                        "both the first row and the first column could be wavelengths; begin the row with "
                        "\"wavelength\" where the column is, with \"name\" and names where the row is");
    }
    return {};
  }

  Result<void> take_headings() {
    TableHeadings found = read_headings(file_, layout_);
    if (!found.unknown_unit.empty() && !stated_) {
      return make_error(ErrorCode::kBadFile,
                        "{}: wavelengths in {} are not read, only nm, um, m, angstrom and cm^-1", file_.path,
                        found.unknown_unit);
    }
    out_.unit = found.unit;
    if (found.unit) out_.unit_source = "as its heading says";
    out_.quantity = std::move(found.quantity);
    all_percent_ = found.percent;
    headings_ = std::move(found.cells);
    return {};
  }

  Result<void> line(std::string_view text, std::size_t number) {
    switch (layout_.arrangement) {
      case Arrangement::kColumns:
        return sample(text, number);
      case Arrangement::kPairs:
        return sample_pairs(number);
      case Arrangement::kNamed:
        return named_sample(text, number);
      case Arrangement::kRows:
      case Arrangement::kNamelessRows:
        return row(text, number);
    }
    return {};
  }

  Error no_sample(std::string_view text, std::size_t number, std::string_view cell) const {
    return place_error(
        file_, number, cell.data() == nullptr ? text.data() : cell.data(),
        io::quoted(text) + (columns_ > 1 || several_ ? " is not a wavelength in nm and values"
                                                     : " is not a wavelength in nm and a value"));
  }

  Result<WavelengthCell> wavelength(std::string_view text, std::size_t number, std::string_view cell) {
    const auto found = wavelength_cell(cell, decimal());
    if (!found) return no_sample(text, number, cell);
    if (!std::isfinite(found->value))
      return place_error(file_, number, cell.data(), io::quoted(text) + " is not finite");
    if (found->unit) SPECTILE_TRY(unit_of_cell(*found->unit, number, cell));
    return *found;
  }

  Result<void> unit_of_cell(WavelengthUnit unit, std::size_t number, std::string_view cell) {
    if (!cell_unit_) {
      cell_unit_ = out_.unit = unit;
      out_.unit_source = "as its numbers say";
    }
    if (*cell_unit_ == unit) return {};
    return place_error(file_, number, cell.data(),
                       fmt::format("{} is in {}, the first wavelength in {}", io::quoted(cell),
                                   to_string(unit), to_string(*cell_unit_)));
  }

  /// The value of a cell, NaN for an empty one. `text` is quoted where the line holds one value.
  Result<double> value(std::string_view text, std::size_t number, std::string_view cell, std::size_t column) {
    if (cell.empty()) {
      ++out_.empty_cells;
      return kNaN;
    }
    const auto found = cell_number(cell, decimal());
    if (!found || !is_value_unit(found->unit)) {
      if (columns_ <= 1 && !several_ && layout_.arrangement == Arrangement::kColumns)
        return no_sample(text, number, cell);
      return place_error(file_, number, cell.data(), io::quoted(cell) + " is not a number");
    }
    if (!std::isfinite(found->value))
      return place_error(file_, number, cell.data(), io::quoted(text) + " is not finite");
    if (column >= units_.size()) units_.resize(column + 1);
    if (!units_[column]) units_[column] = found->unit;
    if (const std::string_view known = *units_[column]; known != found->unit) {
      return place_error(file_, number, cell.data(),
                         fmt::format("{} has another unit than the first value, {}", io::quoted(cell),
                                     known.empty() ? "none" : io::quoted(known)));
    }
    return found->value;
  }

  /// Percent, or a power with its prefix and what it is per.
  static bool is_value_unit(std::string_view unit) {
    if (unit.empty() || unit == "%") return true;
    const std::size_t watts = unit.find('W');
    return watts <= 2 && unit.find_first_of(" ,;") == std::string_view::npos &&
           unit.find_first_of("0123456789") > watts;
  }

  bool outside_run(std::size_t sample) const {
    return layout_.run_count > 0 &&
           (sample < layout_.run_first || sample >= layout_.run_first + layout_.run_count);
  }

  Result<void> sample(std::string_view text, std::size_t number) {
    if (layout_.labelled && !wavelength_cell(cells_.front(), decimal())) return {};
    if (outside_run(samples_++)) return {};
    if (out_.axes.empty()) {
      out_.axes.emplace_back();
      columns_ = 0;
    }
    std::size_t count = cells_.size() - 1;
    if (columns_ > 0 && count != columns_) {
      while (count > columns_ && cells_[count].empty()) --count;
    }
    several_ = columns_ == 0 && count > 1;
    SPECTILE_ASSIGN(const auto at, wavelength(text, number, cells_.front()));
    if (count == 0) return no_sample(text, number, cells_.front());
    if (columns_ > 0 && count != columns_) {
      if (columns_ == 1) return no_sample(text, number, count > 1 ? cells_[2] : std::string_view());
      return line_error(file_, number,
                        fmt::format("has {} values than the first line of samples, which has {}",
                                    count < columns_ ? "fewer" : "more", columns_));
    }
    if (count > kMaxSpectra) return too_many(number);
    if (columns_ == 0) out_.spectra.resize(count);
    columns_ = count;
    out_.axes.front().wavelengths.push_back(at.value);
    out_.axes.front().lines.push_back(static_cast<std::uint32_t>(number));
    for (std::size_t c = 0; c < count; ++c) {
      SPECTILE_ASSIGN(const auto v, value(text, number, cells_[c + 1], c));
      out_.spectra[c].values.push_back(v);
    }
    return {};
  }

  Result<void> sample_pairs(std::size_t number) {
    if (out_.axes.empty()) {
      out_.axes.emplace_back();
      out_.spectra.emplace_back();
    }
    columns_ = 2;  // a line holds more than one value
    while (!cells_.empty() && cells_.back().empty()) cells_.pop_back();
    if (cells_.size() % 2 != 0) {
      return place_error(file_, number, cells_.back().data(), "a wavelength without its value");
    }
    for (std::size_t i = 0; i < cells_.size(); i += 2) {
      SPECTILE_ASSIGN(const auto at, wavelength(cells_[i], number, cells_[i]));
      SPECTILE_ASSIGN(const auto v, value(cells_[i + 1], number, cells_[i + 1], 0));
      out_.axes.front().wavelengths.push_back(at.value);
      out_.axes.front().lines.push_back(static_cast<std::uint32_t>(number));
      out_.spectra.front().values.push_back(v);
    }
    return {};
  }

  Result<void> named_sample(std::string_view text, std::size_t number) {
    columns_ = 2;
    const auto at = cells_.size() == 3 ? wavelength_cell(cells_[1], decimal()) : std::nullopt;
    const auto v = cells_.size() == 3 ? cell_number(cells_[2], decimal()) : std::nullopt;
    if (!at || !v || !is_value_unit(v->unit) || cells_[0].empty() || number_in(cells_[0])) {
      return place_error(file_, number, text.data(),
                         io::quoted(text) + " is not a name, a wavelength in nm and a value");
    }
    if (!std::isfinite(at->value) || !std::isfinite(v->value)) {
      return place_error(file_, number, cells_[1].data(), io::quoted(text) + " is not finite");
    }
    const auto [known, added] = places_.try_emplace(cells_[0], out_.spectra.size());
    if (added) {
      if (out_.spectra.size() >= kMaxSpectra) return too_many(number);
      out_.axes.emplace_back();
      out_.spectra.push_back({std::string(cells_[0]), known->second, {}, 0, v->unit == "%"});
    }
    RawAxis& axis = out_.axes[known->second];
    axis.wavelengths.push_back(at->value);
    axis.lines.push_back(static_cast<std::uint32_t>(number));
    out_.spectra[known->second].values.push_back(v->value);
    return {};
  }

  Result<void> row(std::string_view text, std::size_t number) {
    const std::size_t name = layout_.arrangement == Arrangement::kRows ? 1 : 0;
    columns_ = 2;
    if (out_.axes.empty()) {
      const bool itself = name == 0;
      SPECTILE_TRY(row_of_wavelengths(itself ? number : layout_.heading_line, name));
      if (itself) return {};
      split_cells(text, layout_.format, cells_);
    }
    if (cells_.size() != out_.axes.front().wavelengths.size() + name) {
      return line_error(
          file_, number,
          fmt::format("has {} values for {} wavelengths", cells_.size() - std::min(cells_.size(), name),
                      out_.axes.front().wavelengths.size()));
    }
    if (out_.spectra.size() >= kMaxSpectra) return too_many(number);
    RawSpectrum s;
    if (name == 1) s.name = cells_.front();
    s.line = static_cast<std::uint32_t>(number);
    for (std::size_t i = name; i < cells_.size(); ++i) {
      SPECTILE_ASSIGN(const auto v, value(text, number, cells_[i], 0));
      s.values.push_back(v);
    }
    out_.spectra.push_back(std::move(s));
    return {};
  }

  Result<void> row_of_wavelengths(std::size_t number, std::size_t name) {
    out_.axes.emplace_back();
    split_cells(without_comment(file_.lines[number - 1]), layout_.format, cells_);
    for (std::size_t i = name; i < cells_.size(); ++i) {
      const auto at = wavelength_heading(cells_[i], decimal());
      if (!at)
        return place_error(file_, number, cells_[i].data(), io::quoted(cells_[i]) + " is not a wavelength");
      if (at->unit) SPECTILE_TRY(unit_of_cell(*at->unit, number, cells_[i]));
      out_.axes.front().wavelengths.push_back(at->value);
      out_.axes.front().lines.push_back(static_cast<std::uint32_t>(number));
    }
    return {};
  }

  Error too_many(std::size_t number) const {
    return line_error(file_, number, fmt::format("holds more than {} spectra", kMaxSpectra));
  }

  Result<void> check_table() {
    if (out_.spectra.empty()) {
      return line_error(file_, layout_.first_line, "wavelengths without a row of values");
    }
    // A column that is empty throughout is a separator at the end of each line.
    const bool named = headings_.size() == columns_ + 1;
    for (std::size_t c = out_.spectra.size(); c-- > 0 && layout_.arrangement == Arrangement::kColumns;) {
      RawSpectrum& s = out_.spectra[c];
      if (named) s.name = headings_[c + 1];
      const bool holds_values = c < units_.size() && units_[c];
      s.percent = all_percent_ || says_percent(s.name) || (holds_values && *units_[c] == "%");
      if (holds_values || out_.spectra.size() == 1) continue;
      out_.empty_cells -= s.values.size();
      out_.spectra.erase(out_.spectra.begin() + static_cast<std::ptrdiff_t>(c));
    }
    const bool percent = !units_.empty() && units_.front() && *units_.front() == "%";
    for (std::size_t i = 0; i < out_.spectra.size(); ++i) {
      RawSpectrum& s = out_.spectra[i];
      if (s.name.empty()) s.name = std::to_string(i);
      if (layout_.arrangement == Arrangement::kColumns) continue;
      s.percent = s.percent || all_percent_ || percent;
    }
    return {};
  }

  void finish_notes() {
    if (decimal()) out_.notes.emplace_back("numbers have decimal commas");
    if (is_rows()) out_.notes.emplace_back("a spectrum in each row, wavelengths in the first");
    if (layout_.run_count > 0) {
      out_.notes.push_back(fmt::format("holds {} runs of wavelengths; the one of {} samples is read",
                                       layout_.runs, layout_.run_count));
    }
  }

  const TextFile& file_;
  std::optional<WavelengthUnit> stated_;
  Layout layout_;
  RawTable out_;
  std::vector<std::string_view> cells_;
  std::vector<std::string> headings_;
  std::optional<WavelengthUnit> cell_unit_;
  bool all_percent_ = false;
  std::size_t columns_ = 0;  // values of the first line of samples
  bool several_ = false;     // that line holds more than one
  std::size_t samples_ = 0;
  std::vector<std::optional<std::string_view>> units_;  // behind the values of a column
  std::map<std::string_view, std::size_t> places_;
};

}  // namespace

Result<RawTable> read_columns(const TextFile& file, std::optional<WavelengthUnit> stated_unit) {
  return ColumnsReader(file, stated_unit).read();
}

}  // namespace spectile::io
