// Batches: which of many inputs this run converts, which of them need it, and the list of what was done.
#include "src/cli/batch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace spectile::cli {
namespace {

int usage(const std::string& message) {
  fmt::print(stderr, "spectile: {}\n", message);
  return kBadUsage;
}

/// The shard of the task of a Slurm job array that this process is, if it is one.
int slurm_shard(std::optional<Shard>& out) {
  const auto variable = [](const char* name) -> std::optional<std::string> {
    const char* const value = std::getenv(name);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  };
  const auto id = variable("SLURM_ARRAY_TASK_ID");
  const auto count = variable("SLURM_ARRAY_TASK_COUNT");
  if (!id || !count) return kOk;
  const std::string first = variable("SLURM_ARRAY_TASK_MIN").value_or("0");
  const std::string step = variable("SLURM_ARRAY_TASK_STEP").value_or("1");
  const std::string said =
      fmt::format("SLURM_ARRAY_TASK_ID={}, _COUNT={}, _MIN={}, _STEP={}", *id, *count, first, step);
  const auto i = parse_count(*id);
  const auto n = parse_count(*count);
  const auto from = parse_count(first);
  const auto by = parse_count(step);
  if (!i || !n || !from || !by || *by == 0 || *i < *from || (*i - *from) % *by != 0 ||
      (*i - *from) / *by >= *n) {
    return usage(fmt::format(
        "{}: no even share of the inputs; give --shard I/N, or --shard none for all of them", said));
  }
  out = Shard{(*i - *from) / *by, *n};
  return kOk;
}

int shard_of(const std::string& text, std::optional<Shard>& out) {
  if (text.empty()) return slurm_shard(out);
  if (text == "none") return kOk;
  out = parse_shard(text);
  if (out) return kOk;
  return usage(fmt::format("--shard: \"{}\" is neither none nor I/N, with I from 0 to N - 1", text));
}

/// What a manifest says of every input.
nlohmann::json manifest_line(const Batch& batch, const Job& job, const char* status) {
  nlohmann::json out = {{"input", job.input},
                        {"output", job.output},
                        {"status", status},
                        {"settings", batch.settings},
                        {"shard", nullptr}};
  if (batch.shard) out["shard"] = batch.shard->text();
  return out;
}

}  // namespace

void add_batch_options(CLI::App& command, BatchOptions& options) {
  command.add_option(
      "--region", options.region,
      "X0,Y0,X1,Y1: convert only these pixels, both corners included, in the coordinates of the "
      "image's data window; of tiled images only the tiles that they touch are read, of others "
      "the lines");
  command.add_flag(
      "-u,--update", options.update,
      "Pass over outputs that are newer than what they are made from and were made with the same "
      "settings");
  command.add_option(
      "--shard", options.shard,
      "I/N: convert only the I-th of N even shares of the inputs, counted from 0; the same "
      "inputs, in whatever order, give the same shares. By default the task's share in a Slurm "
      "job array; none: all inputs there too");
  command.add_option("--manifest", options.manifest,
                     "File to which each input adds a line of JSON: what became of it. Several processes may "
                     "add to one file");
}

int apply_region(const BatchOptions& options, ImageOptions& out) {
  if (options.region.empty()) return kOk;
  out.region = parse_region(options.region);
  if (!out.region) {
    return usage(
        fmt::format("--region: \"{}\" is not X0,Y0,X1,Y1 with X0 <= X1 and Y0 <= Y1", options.region));
  }
  return kOk;
}

Manifest::~Manifest() {
  if (fd_ >= 0) ::close(fd_);
}

int Manifest::open(const std::string& path) {
  path_ = path;
  fd_ = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (fd_ >= 0) return kOk;
  const int why = errno;
  fmt::print(stderr, "spectile: {}: cannot write: {}\n", path, std::generic_category().message(why));
  return why == EACCES || why == EPERM || why == EROFS || why == ENOSPC ? kNoRoom : kBadUsage;
}

int Manifest::add(const nlohmann::json& line) const {
  if (fd_ < 0) return kOk;
  const std::string text = line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  ssize_t written = -1;
  // In one piece, so that no other process's line comes between.
  do {
    written = ::write(fd_, text.data(), text.size());
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(text.size())) return kOk;
  const int why = written < 0 ? errno : ENOSPC;
  fmt::print(stderr, "spectile: {}: cannot write: {}\n", path_, std::generic_category().message(why));
  return kNoRoom;
}

int plan_batch(const BatchOptions& options, const std::vector<std::string>& inputs, const std::string& output,
               Batch& out) {
  out.update = options.update;
  if (const int bad = shard_of(options.shard, out.shard)) return bad;
  std::vector<std::string> all = inputs;
  if (out.shard) {
    // Shares that every process finds alike, whatever order its shell gives them in.
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  }
  out.inputs = all.size();
  if (const int bad = plan_jobs(all, output, out.jobs)) return bad;
  if (out.shard) {
    std::vector<Job> mine;
    for (std::size_t i = out.shard->index; i < out.jobs.size(); i += out.shard->count)
      mine.push_back(out.jobs[i]);
    out.jobs = std::move(mine);
  }
  return options.manifest.empty() ? kOk : out.manifest.open(options.manifest);
}

bool is_up_to_date(const Batch& batch, const Job& job) {
  if (!batch.update) return false;
  std::vector<std::string> files = batch.made_from;
  files.push_back(job.input);
  return up_to_date(job.output, files, batch.settings);
}

nlohmann::json converted_line(const Batch& batch, const Job& job, const ImageReport& report) {
  nlohmann::json out = manifest_line(batch, job, "converted");
  out["pixels"] = report.pixels();
  out["bands"] = report.bands;
  out["seconds"] = report.seconds;
  out["bytes"] = report.bytes_written;
  return out;
}

nlohmann::json failed_line(const Batch& batch, const Job& job, const Error& error) {
  nlohmann::json out = manifest_line(batch, job, "failed");
  out["error"] = error.message;
  return out;
}

nlohmann::json skipped_line(const Batch& batch, const Job& job) {
  nlohmann::json out = manifest_line(batch, job, "up-to-date");
  std::error_code error;
  const auto bytes = std::filesystem::file_size(job.output, error);
  if (!error) out["bytes"] = bytes;
  return out;
}

std::vector<std::string> files_among(const std::vector<std::string>& names_or_files) {
  std::vector<std::string> out;
  for (const std::string& text : names_or_files) {
    if (!text.empty() && !named_spectrum(text)) out.push_back(text);
  }
  return out;
}

std::string file_of_bands(const std::string& bands) {
  return Bands::parse(bands) ? std::string() : bands;
}

}  // namespace spectile::cli
