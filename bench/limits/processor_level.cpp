// Level of the x86-64 architecture that this processor reaches, for loops that are compiled once for each.
#include "bench/limits/processor_level.hpp"

#include <string_view>

#include "src/dispatch/dispatch.hpp"

namespace spectile::measure {
namespace {

std::size_t find_level() {
#if defined(__x86_64__)
  // The levels ask for what the kernels of these names ask for.
  const std::string_view widest = dispatch::available().back()->name;
  if (widest == "avx512") return 3;
  if (widest == "avx2") return 2;
  if (widest == "sse4.2") return 1;
#endif
  return 0;
}

}  // namespace

std::size_t processor_level() {
  // Asking the processor takes microseconds where it is a virtual one.
  static const std::size_t level = find_level();
  return level;
}

}  // namespace spectile::measure
