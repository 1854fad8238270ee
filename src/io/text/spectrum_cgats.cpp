// CGATS text with spectral data, as Argyll CMS writes it (.sp, .cmf).
// Source of the layout: CGATS.17, and Argyll CMS's documentation of its file formats.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "src/base/errors.hpp"
#include "src/io/text/spectrum_layout.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile::io {
namespace {

constexpr double kMaxBands = 100000;
/// Smaller numbers in the names of fields count something else.
constexpr double kMinFieldNm = 100;

struct Word {
  std::string_view text;
  std::size_t line = 0;  ///< from 1; 0 for none
};

struct Table {
  std::map<std::string_view, Word> numbers;  ///< of kNumberKeywords
  std::size_t format_line = 0;               ///< of BEGIN_DATA_FORMAT; 0: there is none
  std::vector<std::string_view> fields;
  std::size_t data_line = 0;  ///< of BEGIN_DATA
  std::size_t end_line = 0;   ///< of END_DATA
  std::vector<Word> data;
};

constexpr std::string_view kNumberKeywords[] = {"SPECTRAL_BANDS", "SPECTRAL_START_NM", "SPECTRAL_END_NM",
                                                "SPECTRAL_NORM",  "NUMBER_OF_FIELDS",  "NUMBER_OF_SETS"};
constexpr std::string_view kBlanks = " \t\f\v";

/// Next word of a line, without its quotation marks; empty at the end and where a comment begins.
/// False for a quotation mark without its other.
bool next_word(std::string_view& rest, std::string_view& word) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  word = {};
  if (rest.empty() || rest.front() == '#') return true;
  if (rest.front() != '"') {
    word = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(word.size());
    return true;
  }
  // A doubled mark inside stands for one; what is quoted is never shown, so it may stay doubled.
  std::size_t end = 1;
  while (end < rest.size() && (rest[end] != '"' || rest.substr(end).starts_with("\"\""))) {
    end += rest[end] == '"' ? 2 : 1;
  }
  if (end >= rest.size()) return false;
  word = rest.substr(1, end - 1);
  rest.remove_prefix(end + 1);
  return true;
}

/// Where a line of a file belongs.
enum class Part { kHead, kFormat, kData, kEnd };

class Reader {
 public:
  explicit Reader(const TextFile& file) : file_(file) {}

  Result<Table> read() {
    for (std::size_t i = 0; i < file_.lines.size() && part_ != Part::kEnd; ++i) {
      SPECTILE_TRY(line(file_.lines[i], i + 1));
    }
    if (part_ == Part::kEnd) return std::move(table_);
    const char* const missing = part_ == Part::kFormat ? "END_DATA_FORMAT"
                                : part_ == Part::kData ? "END_DATA"
                                                       : "BEGIN_DATA";
    return line_error(file_, file_.lines.size(), fmt::format("the file ends without {}", missing));
  }

 private:
  Result<void> line(std::string_view rest, std::size_t number) {
    for (bool first = true;; first = false) {
      std::string_view word;
      if (!next_word(rest, word)) return line_error(file_, number, "a quotation mark is not closed");
      // An empty text in quotation marks is a word of the data.
      if (word.empty() && (rest.empty() || rest.front() == '#')) return {};
      if (part_ == Part::kHead && !first && word != "BEGIN_DATA" && word != "BEGIN_DATA_FORMAT") continue;
      SPECTILE_TRY(take(word, rest, number));
      if (part_ == Part::kEnd) return {};
    }
  }

  Result<void> take(std::string_view word, std::string_view& rest, std::size_t number) {
    if (part_ == Part::kFormat) {
      if (word == "END_DATA_FORMAT") {
        part_ = Part::kHead;
      } else {
        table_.fields.push_back(word);
      }
    } else if (part_ == Part::kData) {
      if (word == "END_DATA") {
        part_ = Part::kEnd;
        table_.end_line = number;
      } else {
        table_.data.push_back({word, number});
      }
    } else if (word == "BEGIN_DATA_FORMAT") {
      part_ = Part::kFormat;
      table_.format_line = number;
    } else if (word == "BEGIN_DATA") {
      part_ = Part::kData;
      table_.data_line = number;
    } else if (std::ranges::find(kNumberKeywords, word) != std::end(kNumberKeywords)) {
      std::string_view value;
      if (!next_word(rest, value)) return line_error(file_, number, "a quotation mark is not closed");
      const auto [known, added] = table_.numbers.try_emplace(word, Word{value, number});
      if (!added && known->second.text != value) {
        return line_error(file_, number,
                          fmt::format("{} is {} here and {} on line {}", word, io::quoted(value),
                                      io::quoted(known->second.text), known->second.line));
      }
    }
    return {};
  }

  const TextFile& file_;
  Part part_ = Part::kHead;
  Table table_;
};

/// The number after a keyword, between two limits; `otherwise` where the keyword is missing.
Result<double> number_of(const TextFile& file, const Table& table, std::string_view keyword,
                         std::optional<double> otherwise, bool whole, double least, double most) {
  const auto found = table.numbers.find(keyword);
  if (found == table.numbers.end()) {
    if (otherwise) return *otherwise;
    return make_error(ErrorCode::kBadFile, "{}: has no {}", file.path, keyword);
  }
  const std::optional<double> value = number_in(found->second.text);
  if (!value || !(*value >= least && *value <= most) || (whole && std::trunc(*value) != *value)) {
    return line_error(file, found->second.line,
                      fmt::format("{} {} is not {} {} to {}", keyword, io::quoted(found->second.text),
                                  whole ? "an integer," : "a number,", least, most));
  }
  return *value;
}

/// Spectral fields in their order, of a table that says how many bands it has and where they lie. The numbers
/// in their names are not read: real files have SPEC_383 for 383.33 nm and SPEC_300000 for 300 nm.
Result<std::vector<std::size_t>> spectral_fields(const TextFile& file, const Table& table,
                                                 std::size_t bands) {
  std::vector<std::size_t> out;
  if (table.format_line == 0) {
    for (std::size_t i = 0; i < bands; ++i) out.push_back(i);
    return out;
  }
  for (std::size_t i = 0; i < table.fields.size(); ++i) {
    if (table.fields[i].starts_with("SPEC")) out.push_back(i);
  }
  if (out.size() != bands) {
    return line_error(
        file, table.format_line,
        fmt::format("the data have {} fields SPEC_*, but SPECTRAL_BANDS is {}", out.size(), bands));
  }
  return out;
}

/// Checks that the data are whole rows, as many as they should be. Returns how many.
Result<std::size_t> count_rows(const TextFile& file, const Table& table, std::size_t fields) {
  SPECTILE_ASSIGN(const auto named,
                  number_of(file, table, "NUMBER_OF_FIELDS", static_cast<double>(fields), true, 0, 1e9));
  if (named != static_cast<double>(fields)) {
    return line_error(file, table.numbers.at("NUMBER_OF_FIELDS").line,
                      fmt::format("NUMBER_OF_FIELDS is {}, but a row has {}", named, fields));
  }
  const std::size_t rows = table.data.size() / fields;
  if (rows * fields != table.data.size() || rows == 0) {
    return line_error(file, table.end_line,
                      fmt::format("the data that begin on line {} have {} values, which is not one row or "
                                  "more of {}",
                                  table.data_line, table.data.size(), fields));
  }
  SPECTILE_ASSIGN(const auto sets,
                  number_of(file, table, "NUMBER_OF_SETS", static_cast<double>(rows), true, 0, 1e9));
  if (sets != static_cast<double>(rows)) {
    return line_error(file, table.numbers.at("NUMBER_OF_SETS").line,
                      fmt::format("NUMBER_OF_SETS is {}, but there are {} rows", sets, rows));
  }
  return rows;
}

/// CGATS data whose keywords agree with each other.
struct SpectralData {
  Table table;
  std::vector<double> wavelengths_nm;
  double norm = 1;
  std::vector<std::size_t> places;  ///< of the spectral fields in a row
  std::size_t fields = 0;           ///< of a row
  std::size_t rows = 0;
};

/// Bands by the keywords that Argyll CMS writes.
Result<void> place_by_keywords(const TextFile& file, SpectralData& out) {
  SPECTILE_ASSIGN(const auto bands,
                  number_of(file, out.table, "SPECTRAL_BANDS", std::nullopt, true, 2, kMaxBands));
  SPECTILE_ASSIGN(const auto start,
                  number_of(file, out.table, "SPECTRAL_START_NM", std::nullopt, false, 1e-3, 1e9));
  SPECTILE_ASSIGN(const auto end,
                  number_of(file, out.table, "SPECTRAL_END_NM", std::nullopt, false, 1e-3, 1e9));
  if (!(end > start)) {
    return line_error(file, out.table.numbers.at("SPECTRAL_END_NM").line,
                      fmt::format("SPECTRAL_END_NM {} is not above SPECTRAL_START_NM {}", end, start));
  }
  const auto count = static_cast<std::size_t>(bands);
  for (std::size_t i = 0; i < count; ++i) {
    out.wavelengths_nm.push_back(start + (end - start) * static_cast<double>(i) / (bands - 1));
  }
  SPECTILE_ASSIGN(out.places, spectral_fields(file, out.table, count));
  return {};
}

/// Bands by the names of fields, nm380 or SPECTRAL_NM380, as other programs write them.
Result<void> place_by_names(const TextFile& file, SpectralData& out) {
  for (std::size_t i = 0; i < out.table.fields.size(); ++i) {
    const std::string_view field = out.table.fields[i];
    const auto at = number_in(field) ? std::nullopt : wavelength_heading(field, false);
    if (!at || !(at->value >= kMinFieldNm)) continue;
    out.places.push_back(i);
    out.wavelengths_nm.push_back(at->value);
  }
  if (out.places.size() >= 2) return {};
  return make_error(ErrorCode::kBadFile,
                    "{}: has no SPECTRAL_BANDS, and no fields like SPECTRAL_NM380 either", file.path);
}

Result<SpectralData> read_data(const TextFile& file) {
  SpectralData out;
  SPECTILE_ASSIGN(out.table, Reader(file).read());
  const bool by_keywords =
      out.table.numbers.contains("SPECTRAL_BANDS") || out.table.numbers.contains("SPECTRAL_START_NM");
  if (by_keywords || out.table.format_line == 0) {
    SPECTILE_TRY(place_by_keywords(file, out));
  } else {
    SPECTILE_TRY(place_by_names(file, out));
  }
  SPECTILE_ASSIGN(out.norm, number_of(file, out.table, "SPECTRAL_NORM", 1.0, false, 1e-300, 1e300));
  out.fields = out.table.format_line == 0 ? out.places.size() : out.table.fields.size();
  SPECTILE_ASSIGN(out.rows, count_rows(file, out.table, out.fields));
  return out;
}

Result<RawSpectrum> row_of(const TextFile& file, const SpectralData& data, std::size_t row, RawTable& table) {
  RawSpectrum out;
  out.line = static_cast<std::uint32_t>(data.table.data[row * data.fields + data.places.front()].line);
  bool commas = false;
  for (const std::size_t place : data.places) {
    const Word& word = data.table.data[row * data.fields + place];
    if (word.text.empty()) {
      ++table.empty_cells;
      out.values.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    // Only blanks separate words.
    const auto number = cell_number(word.text, true);
    if (!number || !number->unit.empty()) {
      return place_error(file, word.line, word.text.data(), io::quoted(word.text) + " is not a number");
    }
    commas = commas || word.text.find(',') != std::string_view::npos;
    const double scaled = number->value / data.norm;
    if (!std::isfinite(scaled)) {
      return place_error(file, word.line, word.text.data(), io::quoted(word.text) + " is not finite");
    }
    out.values.push_back(scaled);
  }
  if (commas && table.notes.empty()) table.notes.emplace_back("numbers have decimal commas");
  return out;
}

/// Names of the rows: the field SAMPLE_NAME or SAMPLE_ID, else numbers from 0.
std::vector<std::string> row_names(const SpectralData& data) {
  const auto& fields = data.table.fields;
  auto field = std::ranges::find(fields, "SAMPLE_NAME");
  if (field == fields.end()) field = std::ranges::find(fields, "SAMPLE_ID");
  std::vector<std::string> out;
  for (std::size_t row = 0; row < data.rows; ++row) {
    const auto place = row * data.fields + static_cast<std::size_t>(field - fields.begin());
    out.push_back(field == fields.end() ? std::to_string(row) : std::string(data.table.data[place].text));
  }
  return out;
}

}  // namespace

bool is_cgats(const TextFile& file) {
  bool first = true;
  for (std::string_view rest : file.lines) {
    std::string_view word;
    if (!next_word(rest, word) || word.empty()) continue;
    if (first && (word == "SPECT" || word == "CMF" || word.starts_with("CGATS"))) return true;
    first = false;
    if (word == "SPECTRAL_BANDS" || word == "BEGIN_DATA" || word == "BEGIN_DATA_FORMAT") return true;
  }
  return false;
}

Result<RawTable> read_cgats(const TextFile& file, const ColumnChoice& choice) {
  SPECTILE_ASSIGN(const auto data, read_data(file));
  RawTable out;
  out.sure_of_unit = true;
  out.first_by_default = true;
  out.axes.push_back({data.wavelengths_nm, std::vector<std::uint32_t>(data.wavelengths_nm.size(), 0)});
  const std::vector<std::string> names = row_names(data);
  std::size_t first = 0;
  std::size_t last = data.rows;
  if (choice.number || !choice.name.empty()) {
    SPECTILE_ASSIGN(first, chosen(file, names, choice, "data row", out.notes));
    last = first + 1;
  }
  for (std::size_t row = first; row < last; ++row) {
    SPECTILE_ASSIGN(auto spectrum, row_of(file, data, row, out));
    spectrum.name = names[row];
    out.spectra.push_back(std::move(spectrum));
  }
  return out;
}

}  // namespace spectile::io
