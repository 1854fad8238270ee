// Batches: which of many inputs this run converts, which of them need it, and the list of what was done.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/cli/common.hpp"
#include "src/cli/option_texts.hpp"

namespace spectile::cli {

/// Options of every command that converts many images.
struct BatchOptions {
  std::string region;
  bool update = false;
  std::string shard;
  std::string manifest;
};

void add_batch_options(CLI::App& command, BatchOptions& options);

/// Puts the region into the options. The exit code of what is wrong, after saying it.
int apply_region(const BatchOptions& options, ImageOptions& out);

/// A file to which each converted input adds a line of JSON. Several processes may share one.
class Manifest {
 public:
  Manifest() = default;
  ~Manifest();
  Manifest(const Manifest&) = delete;
  Manifest& operator=(const Manifest&) = delete;

  /// The exit code of what is wrong, after saying it.
  int open(const std::string& path);
  /// Adds a line; nothing where no file is open. The exit code of what is wrong, after saying it.
  int add(const nlohmann::json& line) const;

 private:
  int fd_ = -1;
  std::string path_;
};

/// What a command is to convert, and how it is told apart from what was converted before.
struct Batch {
  std::vector<Job> jobs;       ///< of this shard
  std::size_t inputs = 0;      ///< of all shards
  std::optional<Shard> shard;  ///< none: all of them
  bool update = false;         ///< pass over what is up to date
  Manifest manifest;
  std::string settings;                ///< that shape every output: settings_text()
  std::vector<std::string> made_from;  ///< files that shape every output beside its input
};

/// Fills jobs, shard and manifest. The exit code of what is wrong, after saying it.
int plan_batch(const BatchOptions& options, const std::vector<std::string>& inputs, const std::string& output,
               Batch& out);

/// Whether a job's output may stay as it is.
bool is_up_to_date(const Batch& batch, const Job& job);

// What the manifest says of a job.
nlohmann::json converted_line(const Batch& batch, const Job& job, const ImageReport& report);
nlohmann::json failed_line(const Batch& batch, const Job& job, const Error& error);
nlohmann::json skipped_line(const Batch& batch, const Job& job);

/// Of texts that are names of spectra or files, the files.
std::vector<std::string> files_among(const std::vector<std::string>& names_or_files);

/// Of bands, as find_bands() takes them, the file; empty where they are numbers.
std::string file_of_bands(const std::string& bands);

}  // namespace spectile::cli
