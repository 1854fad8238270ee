// Text files as lines, and columns of wavelengths and values in them.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <map>

#include "src/base/atomic_file.hpp"
#include "src/base/errors.hpp"
#include "src/base/text.hpp"
#include "src/io/text/spectrum_text.hpp"

namespace spectile::io {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
constexpr std::string_view kSeparators = ",; \t\f\v";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Fills `text`; the error of the system where there is one.
int read_all(int descriptor, std::string& text) {
  std::array<char, 65536> buffer;
  while (text.size() <= kMaxBytes) {
    const ssize_t got = ::read(descriptor, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(got));
  }
  return 0;
}

std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end);
    if (text.starts_with("\r\n")) text.remove_prefix(1);
    if (!text.empty()) text.remove_prefix(1);
  }
  return lines;
}

std::string_view next_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kSeparators), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kSeparators));
  line.remove_prefix(word.size());
  return word;
}

/// A heading begins like a word: a damaged number is none.
bool begins_like_a_word(std::string_view word) {
  return std::isdigit(static_cast<unsigned char>(word.front())) == 0 &&
         std::string_view("+-.").find(word.front()) == std::string_view::npos;
}

}  // namespace

Result<TextFile> read_text_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return system_error(path, "read", errno);
  if (!S_ISREG(status.st_mode))
    return make_error(ErrorCode::kBadFile, "{}: cannot read: not a plain file", path);
  // Does not wait for a writer, should the file have become a pipe meanwhile.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return system_error(path, "read", errno);
  TextFile file;
  file.path = path;
  file.text = std::make_unique<std::string>();
  std::string& text = *file.text;
  const int failed = read_all(descriptor, text);
  ::close(descriptor);
  if (failed != 0) return system_error(path, "read", failed);
  if (text.size() > kMaxBytes) {
    return make_error(ErrorCode::kBadFile, "{}: is larger than 64 MiB, which no spectrum's text is", path);
  }
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  file.lines = split_lines(text);
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    for (const char c : file.lines[i]) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte >= 32 || std::isspace(byte) != 0) continue;
      return line_error(file, i + 1, fmt::format("holds a byte of value {}; this is no text", byte));
    }
  }
  return file;
}

Error line_error(const TextFile& file, std::size_t line, const std::string& what) {
  return make_error(ErrorCode::kBadFile, "{}: line {}: {}", file.path, line, what);
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 60;
  const std::size_t end = text.find_last_not_of(kSeparators);
  text = text.substr(0, end == std::string_view::npos ? 0 : end + 1);
  if (text.size() <= kMost) return fmt::format("\"{}\"", text);
  std::size_t length = kMost;
  // Not within a character of UTF-8.
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
  return fmt::format("\"{}...\"", text.substr(0, length));
}

std::optional<double> number_in(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-' && word[1] != '+') word.remove_prefix(1);
  return parse_number<double>(word);
}

Result<SampleLines> read_columns(const TextFile& file) {
  SampleLines out;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    std::string_view rest = file.lines[i];
    const std::string_view first = next_word(rest);
    if (first.empty() || first.front() == '#') continue;
    const std::optional<double> wavelength = number_in(first);
    if (!wavelength && out.values.empty() && begins_like_a_word(first)) continue;
    const std::optional<double> value = number_in(next_word(rest));
    if (!wavelength || !value || !next_word(rest).empty()) {
      return line_error(file, i + 1, quoted(file.lines[i]) + " is not a wavelength in nm and a value");
    }
    if (!std::isfinite(*wavelength) || !std::isfinite(*value)) {
      return line_error(file, i + 1, quoted(file.lines[i]) + " is not finite");
    }
    out.wavelengths_nm.push_back(*wavelength);
    out.values.push_back(*value);
    out.lines.push_back(i + 1);
  }
  if (out.values.empty()) {
    return make_error(ErrorCode::kBadFile, "{}: holds no sample, which is a line \"wavelength_nm,value\"",
                      file.path);
  }
  return out;
}

namespace {

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSeparators), text.size()));
  return text.substr(0, text.find_last_not_of(kSeparators) + 1);
}

/// A line "name,wavelength_nm,value"; names may hold spaces, so those do not separate.
struct NamedSample {
  std::string_view name;
  double wavelength_nm = 0;
  double value = 0;
};

std::optional<NamedSample> named_sample(std::string_view line) {
  for (const char separator : {',', ';', '\t'}) {
    if (line.find(separator) == std::string_view::npos) continue;
    const auto fields = split(line, separator);
    if (fields.size() != 3) return {};
    const std::string_view name = trimmed(fields[0]);
    const auto wavelength = number_in(trimmed(fields[1]));
    const auto value = number_in(trimmed(fields[2]));
    if (name.empty() || number_in(name) || !wavelength || !value) return {};
    return NamedSample{name, *wavelength, *value};
  }
  return {};
}

/// Spectra side by side, or one below the other under their names; the first line of samples tells which.
class SpectraReader {
 public:
  explicit SpectraReader(const TextFile& file) : file_(file) {}

  Result<std::vector<SampleLines>> read() {
    for (std::size_t i = 0; i < file_.lines.size(); ++i) SPECTILE_TRY(line(file_.lines[i], i + 1));
    if (spectra_.empty()) {
      return make_error(ErrorCode::kBadFile,
                        "{}: holds no sample, which is a line \"wavelength_nm,value,...\" or "
                        "\"name,wavelength_nm,value\"",
                        file_.path);
    }
    return std::move(spectra_);
  }

 private:
  Result<void> line(std::string_view text, std::size_t number) {
    std::string_view rest = text;
    const std::string_view first = next_word(rest);
    if (first.empty() || first.front() == '#') return {};
    if (spectra_.empty() || named_) {
      if (const auto sample = named_sample(text)) {
        named_ = true;
        const auto at = places_.try_emplace(sample->name, spectra_.size()).first->second;
        return add(at, sample->wavelength_nm, sample->value, number);
      }
      if (named_)
        return line_error(file_, number, quoted(text) + " is not a name, a wavelength in nm and a value");
    }
    const std::optional<double> wavelength = number_in(first);
    if (!wavelength && spectra_.empty() && begins_like_a_word(first)) return {};
    std::size_t values = 0;
    for (std::string_view word = next_word(rest); wavelength && !word.empty(); word = next_word(rest)) {
      const std::optional<double> value = number_in(word);
      if (!value) return line_error(file_, number, quoted(word) + " is not a number");
      if (columns_ > 0 && values == columns_) return wrong_count(number, "more");
      SPECTILE_TRY(add(values, *wavelength, *value, number));
      ++values;
    }
    if (values == 0) return line_error(file_, number, quoted(text) + " is not a wavelength in nm and values");
    if (columns_ > 0 && values < columns_) return wrong_count(number, "fewer");
    columns_ = values;
    return {};
  }

  Error wrong_count(std::size_t number, const char* execution) const {
    return line_error(
        file_, number,
        fmt::format("has {} values than the first line of samples, which has {}", execution, columns_));
  }

  Result<void> add(std::size_t at, double wavelength_nm, double value, std::size_t number) {
    if (!std::isfinite(wavelength_nm) || !std::isfinite(value)) {
      return line_error(file_, number, quoted(file_.lines[number - 1]) + " is not finite");
    }
    if (at >= kMaxSpectra) {
      return line_error(file_, number, fmt::format("holds more than {} spectra", kMaxSpectra));
    }
    if (at == spectra_.size()) spectra_.emplace_back();
    spectra_[at].wavelengths_nm.push_back(wavelength_nm);
    spectra_[at].values.push_back(value);
    spectra_[at].lines.push_back(number);
    return {};
  }

  static constexpr std::size_t kMaxSpectra = 100000;
  const TextFile& file_;
  std::vector<SampleLines> spectra_;
  std::size_t columns_ = 0;  // of the first line of samples
  bool named_ = false;
  std::map<std::string_view, std::size_t> places_;
};

}  // namespace

Result<std::vector<SampleLines>> read_all_columns(const TextFile& file) {
  return SpectraReader(file).read();
}

}  // namespace spectile::io
