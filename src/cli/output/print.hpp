// All text that the tool prints: arguments are escaped here, in one place.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <type_traits>

namespace spectile::cli {

/// A text on one line that leaves the terminal as it is: control characters (below U+0020, U+007F to U+009F)
/// and bytes that are not UTF-8 become \n, \r, \t or \xNN.
std::string escaped(std::string_view text);

/// Writes a text as it is. Throws: std::system_error where standard output is full or closed.
void print_verbatim(std::string_view text);
/// The same to stderr. What cannot be written there is lost: a diagnostic never ends a run.
void print_error_verbatim(std::string_view text) noexcept;
/// Prints to stderr that there is not enough memory: one line, however often and on however many threads it
/// is found. On return the line is there.
void print_out_of_memory() noexcept;

/// An argument as it is printed: texts escaped, anything else as it is.
template <class T>
decltype(auto) printable(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    return escaped(value);
  } else {
    return (value);
  }
}

/// A text of escaped arguments. Only the format itself can hold line breaks.
template <class... T>
std::string format_printable(fmt::string_view format, const T&... arguments) {
  const auto formatted = [&format](const auto&... values) {
    return fmt::vformat(format, fmt::make_format_args(values...));
  };
  return formatted(printable(arguments)...);
}

/// Prints to standard output. Errors: as print_verbatim().
template <class... T>
void print(fmt::format_string<T...> format, const T&... arguments) {
  print_verbatim(format_printable(fmt::string_view(format), arguments...));
}

/// Prints to stderr; where there is no memory for it, that there is none.
template <class... T>
void print_error(fmt::format_string<T...> format, const T&... arguments) noexcept {
  try {
    print_error_verbatim(format_printable(fmt::string_view(format), arguments...));
  } catch (const std::exception&) {
    print_out_of_memory();
  }
}

}  // namespace spectile::cli
