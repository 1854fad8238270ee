// Building errors.
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
