// Helpers to build and hand on errors.
#pragma once

#include <fmt/format.h>

#include <spectile/result.hpp>
#include <utility>

namespace spectile {

/// An Error whose message is formatted with fmt.
template <class... Args>
Error make_error(ErrorCode code, fmt::format_string<Args...> format, Args&&... args) {
  return Error{code, fmt::format(format, std::forward<Args>(args)...)};
}

}  // namespace spectile

#define SPECTILE_JOIN_LINE_2(name, line) name##line
#define SPECTILE_JOIN_LINE(name, line) SPECTILE_JOIN_LINE_2(name, line)

/// Returns the error of a Result<void> from the enclosing function.
#define SPECTILE_TRY(...)                                     \
  do {                                                        \
    if (auto result_of_try = (__VA_ARGS__); !result_of_try) { \
      return result_of_try.error();                           \
    }                                                         \
  } while (false)

/// SPECTILE_ASSIGN(const auto value, function(...)): the value of a Result, or its error is returned from the
/// enclosing function. The target may also be a variable that exists.
#define SPECTILE_ASSIGN(target, ...)                                                                \
  auto SPECTILE_JOIN_LINE(result_, __LINE__) = (__VA_ARGS__);                                       \
  if (!SPECTILE_JOIN_LINE(result_, __LINE__)) return SPECTILE_JOIN_LINE(result_, __LINE__).error(); \
  target = *std::move(SPECTILE_JOIN_LINE(result_, __LINE__))
