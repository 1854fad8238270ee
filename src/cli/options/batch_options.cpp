// Options of subcommands that convert many images: the region, and which of the inputs this run converts.
#include "src/cli/options/batch_options.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace spectile::cli {
namespace {

/// Shard of the task of a Slurm job array that this process is, if it is one.
int take_slurm_shard(std::optional<Shard>& out) {
  const auto variable = [](const char* name) -> std::optional<std::string> {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  };
  const auto id = variable("SLURM_ARRAY_TASK_ID");
  const auto count = variable("SLURM_ARRAY_TASK_COUNT");
  if (!id || !count) return kOk;
  const std::string first = variable("SLURM_ARRAY_TASK_MIN").value_or("0");
  const std::string step = variable("SLURM_ARRAY_TASK_STEP").value_or("1");
  const auto i = parse_count(*id);
  const auto n = parse_count(*count);
  const auto from = parse_count(first);
  const auto by = parse_count(step);
  if (!i || !n || !from || !by || *by == 0 || *i < *from || (*i - *from) % *by != 0 ||
      (*i - *from) / *by >= *n) {
    return complain_usage(fmt::format(
        "SLURM_ARRAY_TASK_ID={}, _COUNT={}, _MIN={}, _STEP={}: no even shares of the inputs; give "
        "--shard I/N, or --shard none for all of them",
        *id, *count, first, step));
  }
  out = Shard{(*i - *from) / *by, *n};
  return kOk;
}

}  // namespace

void add_batch_options(CLI::App& command, BatchOptions& options) {
  command.add_option("--region", options.region, "Convert only these pixels, both corners included")
      ->type_name("X0,Y0,X1,Y1")
      ->group(kFilesGroup);
  command.add_flag("-u,--update", options.update, "Pass over outputs that are up to date")->group(kManyGroup);
  command
      .add_option("--shard", options.shard,
                  "Convert the I-th of N shards, from 0; the task's in a Slurm array; none: all")
      ->type_name("I/N")
      ->group(kManyGroup);
  command.add_option("--manifest", options.manifest, "Append one line of JSON per input to this file")
      ->type_name("FILE")
      ->group(kManyGroup);
}

int apply_region(const BatchOptions& options, ImageOptions& out) {
  if (options.region.empty()) return kOk;
  out.region = parse_region(options.region);
  if (out.region) return kOk;
  return complain_usage(
      fmt::format("--region: \"{}\" is not X0,Y0,X1,Y1 with X0 <= X1 and Y0 <= Y1", options.region));
}

int take_shard(const BatchOptions& options, std::optional<Shard>& out) {
  if (options.shard.empty()) return take_slurm_shard(out);
  if (options.shard == "none") return kOk;
  out = parse_shard(options.shard);
  if (out) return kOk;
  return complain_usage(
      fmt::format("--shard: \"{}\" is neither none nor I/N, with I from 0 to N - 1", options.shard));
}

}  // namespace spectile::cli
