// Options of subcommands that convert many images: the region, and which of the inputs this run converts.
#include "src/cli/options/batch_options.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace spectile::cli {
namespace {

/// Shard of the task of a Slurm job array that this process is, if it is one. Throws: Stop.
std::optional<Shard> slurm_shard() {
  const auto variable = [](const char* name) -> std::optional<std::string> {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  };
  const auto id = variable("SLURM_ARRAY_TASK_ID");
  const auto count = variable("SLURM_ARRAY_TASK_COUNT");
  if (!id || !count) return {};
  const std::string first = variable("SLURM_ARRAY_TASK_MIN").value_or("0");
  const std::string step = variable("SLURM_ARRAY_TASK_STEP").value_or("1");
  const auto i = parse_count(*id);
  const auto n = parse_count(*count);
  const auto from = parse_count(first);
  const auto by = parse_count(step);
  if (!i || !n || !from || !by || *by == 0 || *i < *from || (*i - *from) % *by != 0 ||
      (*i - *from) / *by >= *n) {
    throw Stop(complain_usage(fmt::format(
        "SLURM_ARRAY_TASK_ID={}, _COUNT={}, _MIN={}, _STEP={}: no even shares of the inputs; give "
        "--shard I/N, or --shard none for all of them",
        *id, *count, first, step)));
  }
  return Shard{(*i - *from) / *by, *n};
}

}  // namespace

void add_batch_options(const Command& command, BatchOptions& options) {
  command.option("--region", options.region, "X0,Y0,X1,Y1", kFilesGroup,
                 "Convert only these pixels, both corners included");
  command.flag("-u,--update", options.update, kManyGroup, "Pass over outputs that are up to date");
  command.option("--shard", options.shard, "I/N", kManyGroup,
                 "Convert shard I of N, I from 0; the task's in a Slurm array; none: all");
  command.output_file("--manifest", options.manifest, kManyGroup,
                      "Append one line of JSON per input to this file");
}

std::optional<PixelWindow> region_of(const BatchOptions& options) {
  if (options.region.empty()) return {};
  if (const auto region = parse_region(options.region)) return region;
  throw Stop(complain_usage(
      fmt::format("--region: \"{}\" is not X0,Y0,X1,Y1 with X0 <= X1 and Y0 <= Y1", options.region)));
}

std::optional<Shard> shard_of(const BatchOptions& options) {
  if (options.shard.empty()) return slurm_shard();
  if (options.shard == "none") return {};
  if (const auto shard = parse_shard(options.shard)) return shard;
  throw Stop(complain_usage(
      fmt::format("--shard: \"{}\" is neither none nor I/N, with I from 0 to N - 1", options.shard)));
}

}  // namespace spectile::cli
