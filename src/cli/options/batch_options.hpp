// Options of subcommands that convert many images: the region, and which of the inputs this run converts.
#pragma once

#include <optional>
#include <string>

#include "src/cli/options/common_options.hpp"
#include "src/cli/options/parse.hpp"

namespace spectile::cli {

struct BatchOptions {
  std::string region;
  bool update = false;
  std::string shard;
  std::string manifest;
};

void add_batch_options(const Command& command, BatchOptions& options);

/// The region, if one is given. Throws: Stop.
std::optional<PixelWindow> region_of(const BatchOptions& options);

/// The shard that --shard names, or the task's in a Slurm job array; none for all inputs. Throws: Stop.
std::optional<Shard> shard_of(const BatchOptions& options);

}  // namespace spectile::cli
