// Levels of the x86-64 architecture, for loops that are compiled once for each.
#include "bench/limits/processor_level.hpp"

#include "src/dispatch/dispatch.hpp"

namespace spectile::measure {

std::size_t level_of(std::string_view isa) {
  return isa == "avx512" ? 3 : isa == "avx2" ? 2 : isa == "sse4.2" ? 1 : 0;
}

std::size_t processor_level() {
  // Asking the processor takes microseconds where it is a virtual one.
  static const std::size_t level = level_of(dispatch::available().back()->name);
  return level;
}

}  // namespace spectile::measure
