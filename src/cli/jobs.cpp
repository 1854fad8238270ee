// Batch conversion of images: which inputs this run converts, the loop over them, the manifest.
#include "src/cli/jobs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <set>
#include <system_error>

#include "src/cli/options/spectrum_options.hpp"
#include "src/cli/output/image_report.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

namespace fs = std::filesystem;

/// A file to which each input adds a line of JSON. Several processes may share one.
class Manifest {
 public:
  Manifest() = default;
  ~Manifest() {
    if (fd_ >= 0) ::close(fd_);
  }
  Manifest(const Manifest&) = delete;
  Manifest& operator=(const Manifest&) = delete;

  /// Throws: Stop.
  void open(const std::string& path) {
    path_ = path;
    fd_ = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    if (fd_ < 0) throw Stop(complain_write(path, errno));
  }

  /// Adds a line; nothing where no file is open. Throws: Stop.
  void add(const nlohmann::json& line) const {
    if (fd_ < 0) return;
    const std::string text = json_line(line) + "\n";
    ssize_t written = -1;
    // One write, so that no other process's line comes between.
    do {
      written = ::write(fd_, text.data(), text.size());
    } while (written < 0 && errno == EINTR);
    if (written == static_cast<ssize_t>(text.size())) return;
    complain_write(path_, written < 0 ? errno : ENOSPC);
    throw Stop(kNoRoom);
  }

 private:
  int fd_ = -1;
  std::string path_;
};

/// The jobs of this run.
struct Batch {
  std::vector<Job> jobs;       ///< of this shard
  std::size_t inputs = 0;      ///< of all shards
  std::optional<Shard> shard;  ///< none: all of them
};

/// Makes the output folder. Throws: Stop.
void make_folder(const std::string& path) {
  std::error_code error;
  std::error_code ignored;
  fs::create_directories(path, error);
  if (!error && fs::is_directory(path, ignored)) return;
  const bool denied = error == std::errc::permission_denied || error == std::errc::no_space_on_device ||
                      error == std::errc::read_only_file_system;
  throw Stop(complain({denied ? ErrorCode::kNoPermission : ErrorCode::kBadArgument,
                       fmt::format("{}: cannot be made a directory{}{}", path, error ? ": " : "",
                                   error ? error.message() : "")}));
}

/// Pairs inputs with outputs: one file, or each into a folder under its own name. The folder is made where it
/// does not exist and there are several inputs or the name ends in a slash. Throws: Stop.
std::vector<Job> pair_outputs(const std::vector<std::string>& inputs, const std::string& output) {
  std::error_code ignored;
  bool directory = fs::is_directory(output, ignored);
  if (!directory && (inputs.size() > 1 || output.ends_with('/'))) {
    make_folder(output);
    directory = true;
  }
  std::vector<Job> jobs;
  std::set<std::string> taken;
  for (const std::string& input : inputs) {
    std::string target = directory ? (fs::path(output) / fs::path(input).filename()).string() : output;
    if (!taken.insert(target).second) {
      throw Stop(complain_usage(fmt::format("{}: two inputs would be written there", target)));
    }
    jobs.push_back({input, std::move(target)});
  }
  return jobs;
}

/// Throws: Stop.
Batch plan_batch(const ImageCommand& command) {
  Batch out;
  out.shard = shard_of(command.batch);
  std::vector<std::string> all = command.inputs;
  if (out.shard) {
    // Every process finds the same shards, in whatever order its shell lists the inputs.
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  }
  out.inputs = all.size();
  out.jobs = pair_outputs(all, command.output);
  if (!out.shard) return out;
  std::vector<Job> mine;
  for (std::size_t i = out.shard->index; i < out.jobs.size(); i += out.shard->count)
    mine.push_back(out.jobs[i]);
  out.jobs = std::move(mine);
  return out;
}

}  // namespace

Result<void> check_output(const std::string& output, const std::vector<std::string>& dependencies) {
  for (const std::string& file : dependencies) {
    std::error_code error;
    if (!fs::equivalent(file, output, error) || error) continue;
    return Error{ErrorCode::kBadArgument,
                 fmt::format("{}: the output is {}, which it is made from", output, file)};
  }
  return {};
}

std::vector<std::string> files_among(const std::vector<std::string>& names_or_files) {
  std::vector<std::string> out;
  for (const std::string& text : names_or_files) {
    if (!text.empty() && !named_spectrum(text)) out.push_back(parse_spectrum_path(text).file);
  }
  return out;
}

std::vector<std::string> light_notes(const std::vector<const NamedLight*>& lights) {
  std::vector<std::string> out;
  for (const NamedLight* light : lights) {
    if (light == nullptr) continue;
    for (const std::string& note : light->notes) {
      if (std::ranges::find(out, note) == out.end()) out.push_back(note);
    }
  }
  return out;
}

std::string file_of_bands(const std::string& bands) {
  return Bands::parse(bands) ? std::string() : bands;
}

void ImageCommand::add_files(const Command& command, const std::string& input_help) {
  command.positional("IN", inputs, input_help).required();
  command.option("-o,--output", output, "PATH", kFilesGroup, "Output file, or folder for several inputs")
      .required();
}

void ImageCommand::add_options(const Command& command, const std::string& pixel_default,
                               const std::string& example) {
  add_nonfinite_option(command, write.nonfinite, "the pixel becomes black");
  add_format_options(command, write, pixel_default);
  add_batch_options(command, batch);
  add_layout_options(command, write);
  add_common(command, common, example);
}

void ImageCommand::apply(ImageOptions& out) const {
  apply_common(common);
  apply_write_options(write, common, out);
  out.region = region_of(batch);
}

int run_jobs(const ImageCommand& command, const std::string& settings,
             const std::vector<std::string>& dependencies, ProgressFunction& progress,
             const Conversion& convert, const std::vector<std::string>& notes) {
  const Batch batch = plan_batch(command);
  Manifest manifest;
  if (!command.batch.manifest.empty()) manifest.open(command.batch.manifest);
  const Common& common = command.common;
  int exit = kOk;
  std::size_t skipped = 0;
  std::size_t converted = 0;
  catch_signals();
  print_notes(common, notes);
  if (batch.shard && common.shows_text()) {
    fmt::print("shard {}: {} of {}\n", batch.shard->text(), batch.jobs.size(), plural(batch.inputs, "input"));
  }
  const auto line = [&](const Job& job, const char* status) -> nlohmann::json {
    nlohmann::json out = {{"input", job.input},
                          {"output", job.output},
                          {"status", status},
                          {"settings", settings},
                          {"shard", nullptr}};
    if (batch.shard) out["shard"] = batch.shard->text();
    return out;
  };
  for (const Job& job : batch.jobs) {
    std::vector<std::string> files = dependencies;
    files.push_back(job.input);
    if (command.batch.update && up_to_date(job.output, files, settings)) {
      ++skipped;
      if (common.shows_text()) fmt::print("{} -> {}: up to date\n", job.input, job.output);
      if (common.json) print_json({{"input", job.input}, {"output", job.output}, {"skipped", true}});
      nlohmann::json entry = line(job, "up-to-date");
      std::error_code error;
      const auto bytes = fs::file_size(job.output, error);
      if (!error) entry["bytes"] = bytes;
      manifest.add(entry);
      if (interrupted()) return kInterrupted;
      continue;
    }
    auto report = [&]() -> Result<ImageReport> {
      if (const auto good = check_output(job.output, dependencies); !good) return good.error();
      progress = progress_bar(fs::path(job.input).filename().string(), !common.quiet);
      auto result = convert(job);
      progress = nullptr;  // clears the bar
      return result;
    }();
    if (!report) {
      exit = std::max(exit, complain(report.error()));
      if (common.json) {
        print_json({{"input", job.input}, {"output", job.output}, {"error", report.error().message}});
      }
      nlohmann::json entry = line(job, "failed");
      entry["error"] = report.error().message;
      manifest.add(entry);
      if (interrupted()) return kInterrupted;
      continue;
    }
    ++converted;
    if (common.json) {
      report->notes.insert(report->notes.begin(), notes.begin(), notes.end());
      print_json(report_json(job.input, job.output, *report));
    } else if (!common.quiet) {
      print_report(job.input, job.output, *report, common.stats);
    }
    nlohmann::json entry = line(job, "converted");
    entry["pixels"] = report->pixels();
    entry["bands"] = report->bands;
    entry["seconds"] = report->seconds;
    entry["bytes"] = report->bytes_written;
    manifest.add(entry);
  }
  if (command.batch.update && common.shows_text()) {
    const std::size_t failed = batch.jobs.size() - converted - skipped;
    fmt::print("{} converted, {} up to date{}\n", converted, skipped,
               failed > 0 ? fmt::format(", {} failed", failed) : "");
  }
  return exit;
}

}  // namespace spectile::cli
