// Which instruction set the kernels run on.
#pragma once

#include <spectile/result.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spectile {

/// Names that run on this machine, of "scalar" (the reference), "sse4.2", "avx2", "avx512", "neon"; the
/// fastest last.
std::vector<std::string> available_isas();

/// The name in force: the one forced, else the environment's SPECTILE_ISA, else the fastest.
/// Errors: kUnknownName or kUnavailable for a SPECTILE_ISA that does not exist or cannot run here.
Result<std::string> active_isa();

/// Forces one for the whole process; an empty name undoes it. The results never depend on it, only the speed
/// does. Errors: kUnknownName, kUnavailable.
Result<void> force_isa(std::string_view name);

}  // namespace spectile
