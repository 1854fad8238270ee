// Levels of the x86-64 architecture, for loops that are compiled once for each.
#pragma once

#include <cstddef>
#include <string_view>

namespace spectile::measure {

/// Index into compilations for the plain architecture and, on x86-64, its levels v2, v3 and v4: the level
/// that asks for what an instruction set's kernels ask for.
std::size_t level_of(std::string_view isa);
/// Level that this processor reaches.
std::size_t processor_level();

}  // namespace spectile::measure
