// All text that the tool prints: arguments are escaped here, in one place.
#include "src/cli/output/print.hpp"

#include <cerrno>
#include <cstddef>
#include <mutex>
#include <system_error>

namespace spectile::cli {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

/// Bytes of the UTF-8 character at `i`; 0 where there is none. Source: Unicode 15.0, table 3-7.
std::size_t character_length(std::string_view text, std::size_t i) {
  const unsigned first = byte_at(text, i);
  const unsigned second = byte_at(text, i + 1);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  const std::size_t length = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  const unsigned low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  if (second < low || second > high) return 0;
  for (std::size_t k = 2; k < length; ++k) {
    if ((byte_at(text, i + k) & 0xC0U) != 0x80) return 0;
  }
  return length;
}

/// True for a control character: of ASCII, or U+0080 to U+009F, which terminals obey too.
bool is_control(std::string_view text, std::size_t i, std::size_t length) {
  const unsigned first = byte_at(text, i);
  return length == 1 ? first < 0x20 || first == 0x7F : first == 0xC2 && byte_at(text, i + 1) < 0xA0;
}

std::string escape_of(char c) {
  switch (c) {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      return fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_length(text, i);
    if (length > 0 && !is_control(text, i, length)) {
      out += text.substr(i, length);
      i += length;
      continue;
    }
    const std::size_t end = i + (length > 0 ? length : 1);
    for (; i < end; ++i) out += escape_of(text[i]);
  }
  return out;
}

void print_verbatim(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size()) return;
  throw std::system_error(errno, std::generic_category());
}

void print_error_verbatim(std::string_view text) noexcept {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
}

void print_out_of_memory() noexcept {
  static std::mutex mutex;
  static bool printed = false;
  const std::scoped_lock lock(mutex);
  if (!printed) print_error_verbatim("spectile: not enough memory\n");
  printed = true;
}

}  // namespace spectile::cli
