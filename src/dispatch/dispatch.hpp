// Detection of the processor's instruction sets and choice of the kernel table.
#pragma once

#include <spectile/result.hpp>
#include <string_view>
#include <vector>

#include "kernels/abi.hpp"

namespace spectile::dispatch {

/// The table by name. Errors: kUnknownName for a name that does not exist, kUnavailable for one this machine
/// or build cannot run.
Result<const kernels::KernelTable*> find(std::string_view name);

/// Every table that runs here, the reference first, the fastest last.
std::vector<const kernels::KernelTable*> available();

/// The active table: the one set by force, else that of SPECTILE_ISA, else the fastest. Errors: as find.
Result<const kernels::KernelTable*> active();

/// Forces a table for the whole process; an empty name undoes it. Errors: as find.
Result<void> force(std::string_view name);

}  // namespace spectile::dispatch
