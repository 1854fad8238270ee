// A limit on the memory that a run takes.
#pragma once

#include <optional>

namespace spectile::cli {

/// Has the system refuse memory beyond so many gigabytes, so that a run ends with a message instead of taking
/// the machine down, or being killed. 0: no limit. Nothing: what the machine, or the control group of a
/// container or a job, has. The stacks of `threads` threads (0: one per core) come on top.
void limit_memory(std::optional<double> gigabytes, int threads);

}  // namespace spectile::cli
