// One treatment of a failed allocation.
#pragma once

#include <new>
#include <utility>

#include "src/base/errors.hpp"

namespace spectile {

/// The Result of `work`, or kOutOfMemory with this message where it throws std::bad_alloc. The message is
/// made first: there may be no memory for it afterwards.
template <class Work, class... Args>
auto guard_memory(const Work& work, fmt::format_string<Args...> format, Args&&... args) -> decltype(work()) {
  Error error = make_error(ErrorCode::kOutOfMemory, format, std::forward<Args>(args)...);
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return error;
  }
}

}  // namespace spectile
