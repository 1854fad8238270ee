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

void add_batch_options(CLI::App& command, BatchOptions& options);

/// Stores the region in the options. Returns an exit code; prints the error.
int apply_region(const BatchOptions& options, ImageOptions& out);

/// Stores the shard that --shard names, or the task's in a Slurm job array; none for all inputs. Returns an
/// exit code; prints the error.
int take_shard(const BatchOptions& options, std::optional<Shard>& out);

}  // namespace spectile::cli
