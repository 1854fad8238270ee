// The reference's KernelTable.
#pragma once

#include "kernels/abi.hpp"

namespace spectile::reference {

extern const kernels::KernelTable kKernelTable;

}  // namespace spectile::reference
