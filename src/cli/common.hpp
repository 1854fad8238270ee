// What every subcommand shares: options, exit codes, messages, the progress bar.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spectile/spectile.hpp>
#include <string>
#include <vector>

namespace spectile::cli {

/// Exit codes of the tool.
enum Exit : int {
  kOk = 0,
  kBadInput = 1,       ///< a file that cannot be used
  kBadUsage = 2,       ///< an option that cannot be meant
  kNoRoom = 3,         ///< no space, no permission
  kInterrupted = 130,  ///< stopped by a signal, as shells count it
};

/// Options common to every subcommand.
struct Common {
  int threads = 0;
  std::string isa;
  bool json = false;
  bool quiet = false;
  bool stats = false;  ///< whether the report says what was skipped
};

void add_common(CLI::App& command, Common& common);

/// Puts the common options in force. Returns the exit code of what is wrong, after saying it.
int apply_common(const Common& common);

/// Prints one line to stderr and returns the error's exit code.
int complain(const Error& error);

/// Options of every command that writes images.
struct WriteOptions {
  std::string pixel;
  std::string compression;
  std::string nonfinite = "stop";
  std::size_t lanes = 65536;
  std::vector<int> tile;  ///< width and height, or none
  bool mipmap = false;
};

void add_write_options(CLI::App& command, WriteOptions& options, const char* pixel_default);

/// Fills `out`; the exit code of what is wrong, after saying it.
int apply_write_options(const WriteOptions& options, const Common& common, ImageOptions& out);

/// One input and the output that it becomes.
struct Job {
  std::string input;
  std::string output;
};

/// Pairs inputs with outputs: one file, or each into a directory under its own name. The directory is made
/// when it does not exist and there are several inputs or the name ends in a slash. Says what is wrong.
int plan_jobs(const std::vector<std::string>& inputs, const std::string& output, std::vector<Job>& jobs);

/// Whether an output is none of the files that it is made from, which would be lost. Errors: kBadArgument.
Result<void> check_output(const std::string& output, const std::vector<std::string>& made_from);

struct Batch;

/// Runs convert(job) for each job of a batch that needs it; one that fails does not stop the others. Prints
/// reports.
int run_jobs(const Batch& batch, const Common& common, ImageOptions& options,
             const std::function<Result<ImageReport>(const Job&)>& convert);

/// "12.3 Mpixel/s".
std::string speed_text(std::uint64_t pixels, double seconds);
/// "1.2 GB".
std::string size_text(std::uint64_t bytes);

/// Lines that draw one bar a value, the values being averages over even parts of a range of wavelengths.
/// Bars stand on 0, or on the least value where that is below.
std::vector<std::string> plot_columns(std::span<const double> values, int rows, double first_nm,
                                      double last_nm);
/// Lines that draw values over wavelengths, 60 columns wide and 10 rows high.
std::vector<std::string> plot(std::span<const float> values, const Bands& bands);

/// Draws a bar on stderr, cleared when the last copy of the function is gone, and stops at signals.
ProgressFunction progress_bar(const std::string& label, bool enabled);

/// True once SIGINT or SIGTERM has come.
bool interrupted();
/// Makes SIGINT and SIGTERM end conversions cleanly.
void catch_signals();

// Each adds its subcommand; `exit` receives the code when it has run.
void add_demo(CLI::App& app, int& exit);
void add_upsample(CLI::App& app, int& exit);
void add_expand(CLI::App& app, int& exit);
void add_relight(CLI::App& app, int& exit);
void add_project(CLI::App& app, int& exit);
void add_info(CLI::App& app, int& exit);
void add_verify(CLI::App& app, int& exit);
void add_spectra(CLI::App& app, int& exit);
void add_plan(CLI::App& app, int& exit);
void add_film(CLI::App& app, int& exit);
void add_bench(CLI::App& app, int& exit);

// Each adds its subcommand to "film".
void add_film_average(CLI::App& film, int& exit);
void add_film_develop(CLI::App& film, int& exit);
void add_film_merge(CLI::App& film, int& exit);
void add_film_simulate(CLI::App& film, int& exit);

}  // namespace spectile::cli
