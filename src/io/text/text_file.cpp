// Text files: reading, UTF-16, lines, and errors that name a place in them.
#include "src/io/text/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>

#include "src/base/atomic_file.hpp"
#include "src/base/errors.hpp"
#include "src/base/text.hpp"

namespace spectile::io {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
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

void append_utf8(std::string& out, std::uint32_t c) {
  const auto add = [&out](std::uint32_t byte) { out.push_back(static_cast<char>(byte)); };
  if (c < 0x80) {
    add(c);
  } else if (c < 0x800) {
    add(0xC0U | (c >> 6U));
    add(0x80U | (c & 0x3FU));
  } else if (c < 0x10000) {
    add(0xE0U | (c >> 12U));
    add(0x80U | ((c >> 6U) & 0x3FU));
    add(0x80U | (c & 0x3FU));
  } else {
    add(0xF0U | (c >> 18U));
    add(0x80U | ((c >> 12U) & 0x3FU));
    add(0x80U | ((c >> 6U) & 0x3FU));
    add(0x80U | (c & 0x3FU));
  }
}

/// UTF-16, told by its byte order mark, as UTF-8; nothing for other texts, or where half a character is left.
/// Surrogates without their other become U+FFFD.
std::optional<std::string> from_utf16(std::string_view text) {
  const bool little = text.starts_with("\xFF\xFE");
  if ((!little && !text.starts_with("\xFE\xFF")) || text.size() % 2 != 0) return std::nullopt;
  const auto unit = [&](std::size_t at) {
    const auto a = static_cast<unsigned char>(text[at]);
    const auto b = static_cast<unsigned char>(text[at + 1]);
    return static_cast<std::uint32_t>(little ? a | (b << 8U) : b | (a << 8U));
  };
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 2; i + 1 < text.size(); i += 2) {
    std::uint32_t c = unit(i);
    if (c >= 0xD800 && c < 0xE000) {
      const std::uint32_t low = c < 0xDC00 && i + 3 < text.size() ? unit(i + 2) : 0;
      const bool pair = low >= 0xDC00 && low < 0xE000;
      c = pair ? 0x10000 + ((c - 0xD800) << 10U) + (low - 0xDC00) : 0xFFFD;
      if (pair) i += 2;
    }
    append_utf8(out, c);
  }
  return out;
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
  if (auto utf8 = from_utf16(text)) text = *std::move(utf8);
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

Error place_error(const TextFile& file, std::size_t line, const char* place, const std::string& what) {
  const std::string_view text = file.lines[line - 1];
  const auto column = static_cast<std::size_t>(place - text.data()) + 1;
  return make_error(ErrorCode::kBadFile, "{}: line {}, column {}: {}", file.path, line, column, what);
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kMax = 60;
  const std::size_t end = text.find_last_not_of(",; \t\f\v");
  text = text.substr(0, end == std::string_view::npos ? 0 : end + 1);
  if (text.size() <= kMax) return fmt::format("\"{}\"", text);
  std::size_t length = kMax;
  // Not within a character of UTF-8.
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
  return fmt::format("\"{}...\"", text.substr(0, length));
}

std::optional<double> number_in(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-' && word[1] != '+') word.remove_prefix(1);
  return parse_number<double>(word);
}

}  // namespace spectile::io
