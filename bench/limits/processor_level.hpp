// Level of the x86-64 architecture that this processor reaches, for loops that are compiled once for each.
#pragma once

#include <cstddef>

namespace spectile::measure {

/// Index into compilations for the plain architecture and, on x86-64, its levels v2, v3 and v4.
std::size_t processor_level();

}  // namespace spectile::measure
