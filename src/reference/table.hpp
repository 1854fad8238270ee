// The reference's KernelTable.
#pragma once

#include "kernels/abi.hpp"

namespace spectile::reference {

extern const kernels::KernelTable kernel_table;

}  // namespace spectile::reference
