// What is measured where: processor, caches, system, compiler.
#pragma once

#include <spectile/bench/benchmark.hpp>

namespace spectile::measure {

/// What the system says of itself; names are "unknown" and sizes 0 where it does not.
BenchmarkMachine describe_machine();

}  // namespace spectile::measure
