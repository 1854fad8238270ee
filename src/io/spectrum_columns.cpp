// Text files as lines, and columns of wavelengths and values in them.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>

#include "src/base/errors.hpp"
#include "src/io/atomic_file.hpp"
#include "src/io/spectrum_text.hpp"

namespace spectile::io {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20U;
constexpr std::string_view kSeparators = ",; \t\f\v";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Fills `text`; the error of the system where there is one.
int read_all(int descriptor, std::string& text) {
  std::array<char, 65536> buffer;
  while (text.size() <= kMostBytes) {
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
  if (text.size() > kMostBytes) {
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
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
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

}  // namespace spectile::io
