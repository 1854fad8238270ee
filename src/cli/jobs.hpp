// Batch conversion of images: which inputs this run converts, the loop over them, the manifest.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "src/cli/options/batch_options.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/image_report.hpp"

namespace spectile::cli {

/// One input and its output.
struct Job {
  std::string input;
  std::string output;
};

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

/// The part of a conversion that all jobs share, beside their inputs.
struct Shared {
  std::string settings;                                ///< settings_text() of the options
  std::vector<NamedFile> dependencies;                 ///< files that shape every output
  std::optional<ColorHandling> colors = std::nullopt;  ///< of inputs that are RGB
  std::string light = {};  ///< which a plan of bands must hold, as it was given; D65 for an empty text
  std::string plan = {};   ///< the file of that plan; the input where none
  std::vector<std::string> notes = {};  ///< on the options: printed once, and in every report as JSON
};

/// Converts each job of this shard that needs it. A failed one does not stop the others. Prints reports, and
/// adds to the manifest. `progress` is the progress function of the options that `convert` uses. Returns an
/// exit code.
int run_jobs(const ImageCommand& command, const Shared& shared, ProgressFunction& progress,
             const Conversion& convert);

/// Removes the folder of outputs, if this run made it and nothing came into it: for where the process ends at
/// once. Takes no memory.
void remove_empty_output_folder() noexcept;

/// The notes of lights, each once; null for none.
std::vector<std::string> light_notes(const std::vector<const NamedLight*>& lights);

}  // namespace spectile::cli
