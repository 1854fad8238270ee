// Description of the machine: processor, caches, system, compiler.
#pragma once

#include <spectile/bench/benchmark.hpp>

namespace spectile::measure {

/// The system's own description; names are "unknown" and sizes 0 where it does not.
BenchmarkMachine describe_machine();

}  // namespace spectile::measure
