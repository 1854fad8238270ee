// Batch conversion of images: which inputs this run converts, the loop over them, the manifest.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "src/cli/options/batch_options.hpp"

namespace spectile::cli {

/// One input and its output.
struct Job {
  std::string input;
  std::string output;
};

/// Error if an output is one of the files that it depends on, which would be lost. Errors: kBadArgument.
Result<void> check_output(const std::string& output, const std::vector<std::string>& dependencies);

/// The subset of names of spectra or files that are files.
std::vector<std::string> files_among(const std::vector<std::string>& names_or_files);

/// The file that a text of bands names, as find_bands() takes it; empty where it holds numbers.
std::string file_of_bands(const std::string& bands);

/// Options of every subcommand that converts images.
struct ImageCommand {
  Common common;
  WriteOptions write;
  BatchOptions batch;
  std::vector<std::string> inputs;
  std::string output;

  /// Adds the inputs and the output.
  void add_files(const Command& command, const std::string& input_help);
  /// Adds all other common options; `example` ends the help.
  void add_options(const Command& command, const std::string& pixel_default, const std::string& example);
  /// Fills `out`. Throws: Stop.
  void apply(ImageOptions& out) const;
};

/// Converts one job with the options.
using Conversion = std::function<Result<ImageReport>(const Job&)>;

/// Converts each job of this shard that needs it. A failed one does not stop the others. Prints reports, and
/// adds to the manifest. `settings` and `dependencies` are what shapes every output beside its input: a text
/// of options and files. `progress` is the progress function of the options that `convert` uses. Returns an
/// exit code. `notes`, on the options themselves, are printed once, and stand in every report as JSON.
int run_jobs(const ImageCommand& command, const std::string& settings,
             const std::vector<std::string>& dependencies, ProgressFunction& progress,
             const Conversion& convert, const std::vector<std::string>& notes = {});

/// The notes of lights, each once; null for none.
std::vector<std::string> light_notes(const std::vector<const NamedLight*>& lights);

}  // namespace spectile::cli
