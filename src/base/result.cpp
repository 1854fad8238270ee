// The end of a program that takes the value of an error.
#include <cstdio>
#include <cstdlib>
#include <spectile/result.hpp>

namespace spectile::detail {

void value_of_error(const Error& error) noexcept {
  std::fprintf(stderr, "spectile: the value of an error was taken: %s\n", error.message.c_str());
  std::abort();
}

}  // namespace spectile::detail
