// Batch conversion of images: which inputs this run converts, the loop over them, the manifest.
#include "src/cli/jobs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <new>
#include <system_error>

#include "src/cli/options/spectrum_options.hpp"
#include "src/cli/output/image_report.hpp"
#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

namespace fs = std::filesystem;

/// True if a file's last line has no end; false too for what may be written but not read.
bool is_cut_short(const std::string& path) {
  std::ifstream file;
  std::error_code none;
  if (fs::is_regular_file(path, none)) file.open(path, std::ios::binary);
  char last = '\n';
  return file.seekg(-1, std::ios::end) && file.get(last) && last != '\n';
}

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
    // A line that a full disk cut short stays a line of its own.
    if (!is_cut_short(path)) return;
    print_error("spectile: {}: its last line was cut short, and stays so\n", path);
    write("\n");
  }

  /// Adds a line; nothing where no file is open. Throws: Stop.
  void add(const nlohmann::json& line) const {
    if (fd_ >= 0) write(json_line(line) + "\n");
  }

 private:
  /// Throws: Stop.
  void write(const std::string& text) const {
    ssize_t written = -1;
    // One write, so that no other process's line comes between.
    do {
      written = ::write(fd_, text.data(), text.size());
    } while (written < 0 && errno == EINTR);
    if (written == static_cast<ssize_t>(text.size())) return;
    complain_write(path_, written < 0 ? errno : ENOSPC);
    throw Stop(kNoRoom);
  }

  int fd_ = -1;
  std::string path_;
};

/// The jobs of this run.
struct Batch {
  std::vector<Job> all;        ///< of all shards
  std::vector<Job> jobs;       ///< of this shard
  std::size_t inputs = 0;      ///< of all shards
  std::optional<Shard> shard;  ///< none: all of them
  bool into_folder = false;    ///< each under its own name
};

/// The folder of outputs, made for a run. It goes again, with those above it that were made, if nothing came
/// into it.
class OutputFolder {
 public:
  OutputFolder() { current_ = this; }
  ~OutputFolder() {
    current_ = nullptr;
    remove_empty();
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Removes what was made and is empty. Takes no memory.
  void remove_empty() const noexcept {
    for (const fs::path& folder : made_) {
      if (::rmdir(folder.c_str()) != 0) return;  // it is not empty
    }
  }
  /// The one of this process, or null.
  static const OutputFolder* current() noexcept { return current_; }

  /// `stays`: other processes may be about to write there. Throws: Stop.
  void make(const std::string& path, bool stays) {
    std::error_code error;
    std::error_code ignored;
    const fs::path whole = path.ends_with('/') ? fs::path(path).parent_path() : fs::path(path);
    for (fs::path at = whole; !stays && !at.empty() && !fs::exists(at, ignored); at = at.parent_path()) {
      made_.push_back(at);
    }
    fs::create_directories(path, error);
    if (!error && fs::is_directory(path, ignored)) return;
    const bool denied = error == std::errc::permission_denied || error == std::errc::no_space_on_device ||
                        error == std::errc::read_only_file_system;
    throw Stop(complain({denied ? ErrorCode::kNoPermission : ErrorCode::kBadArgument,
                         fmt::format("{}: cannot be made a directory{}{}", path, error ? ": " : "",
                                     error ? error.message() : "")}));
  }

 private:
  inline static std::atomic<const OutputFolder*> current_ = nullptr;
  std::vector<fs::path> made_;  // the innermost first
};

/// True if each input goes into a folder under its own name: one that is there, or a name that can become
/// one. Throws: Stop.
bool goes_into_folder(const std::string& output, std::size_t inputs) {
  std::error_code ignored;
  if (fs::is_directory(output, ignored) || output.ends_with('/')) return true;
  check_image_name(output);
  if (inputs > 1 && is_image_name(output)) {
    throw Stop(
        complain_usage(fmt::format("{}: {} inputs cannot go into one image; name a folder, such as {}/",
                                   output, inputs, fs::path(output).replace_extension().string())));
  }
  return inputs > 1;
}

/// Refuses the share of a Slurm task where each task may name an image of its own: all but the first would do
/// nothing. Throws: Stop.
void check_slurm_share(const Shard& shard, bool into_folder, std::size_t inputs) {
  if (into_folder && inputs > 1) return;
  throw Stop(complain_usage(
      fmt::format("this is task {} of a Slurm array, whose tasks share the inputs out, but there is only one "
                  "{}; give all inputs "
                  "and a folder to every task, or --shard none where each task has an input of its own",
                  shard.text(), inputs > 1 ? "output" : "input")));
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
  out.into_folder = goes_into_folder(command.output, all.size());
  if (out.shard && command.batch.shard.empty()) check_slurm_share(*out.shard, out.into_folder, all.size());
  for (const std::string& input : all) {
    out.all.push_back({input, out.into_folder
                                  ? (fs::path(command.output) / fs::path(input).filename()).string()
                                  : command.output});
  }
  const Shard mine = out.shard.value_or(Shard());
  for (std::size_t i = mine.index; i < out.all.size(); i += mine.count) out.jobs.push_back(out.all[i]);
  return out;
}

/// Refuses outputs and a manifest that would replace each other, an input of any shard, or another file that
/// is read. Throws: Stop.
void check_batch_files(const Batch& batch, const std::string& manifest, std::vector<NamedFile> read) {
  std::vector<NamedFile> written = {{manifest, "the manifest (--manifest)"}};
  for (const Job& job : batch.all) {
    written.push_back({job.output, kOutputRole});
    read.push_back({job.input, kInputRole});
  }
  check_files(written, read);
}

/// The result of a conversion, which may run out of memory outside of the library too.
Result<ImageReport> converted_by(const Conversion& convert, const Job& job) {
  Error out_of_memory{ErrorCode::kOutOfMemory, job.input + ": not enough memory"};
  try {
    return convert(job);
  } catch (const std::bad_alloc&) {
    return out_of_memory;
  }
}

}  // namespace

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

void ImageCommand::add_files(const Command& command, const std::string& input_help) {
  command.positional("IN", inputs, input_help).required();
  command.output_file("-o,--output", output, kFilesGroup, "Output file, or folder for several inputs", "PATH")
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

void remove_empty_output_folder() noexcept {
  if (const OutputFolder* const folder = OutputFolder::current()) folder->remove_empty();
}

int run_jobs(const ImageCommand& command, const Shared& shared, ProgressFunction& progress,
             const Conversion& convert) {
  const std::string& settings = shared.settings;
  const Batch batch = plan_batch(command);
  check_batch_files(batch, command.batch.manifest, shared.dependencies);
  OutputFolder folder;
  if (batch.into_folder && !batch.jobs.empty()) folder.make(command.output, batch.shard.has_value());
  Manifest manifest;
  if (!command.batch.manifest.empty()) manifest.open(command.batch.manifest);
  const Common& common = command.common;
  int exit = kOk;
  Notes notes;
  std::size_t skipped = 0;
  std::size_t converted = 0;
  catch_signals();
  print_notes(common, shared.notes);
  if (batch.shard && common.shows_text()) {
    print("shard {}: {} of {}\n", batch.shard->text(), batch.jobs.size(), plural(batch.inputs, "input"));
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
    std::vector<std::string> files = {job.input};
    for (const NamedFile& file : shared.dependencies) files.push_back(file.path);
    if (command.batch.update && up_to_date(job.output, files, settings)) {
      ++skipped;
      if (common.shows_text()) print("{} -> {}: up to date\n", job.input, job.output);
      if (common.json) print_json({{"input", job.input}, {"output", job.output}, {"skipped", true}});
      nlohmann::json entry = line(job, "up-to-date");
      std::error_code error;
      const auto bytes = fs::file_size(job.output, error);
      if (!error) entry["bytes"] = bytes;
      manifest.add(entry);
      if (interrupted()) return complain({ErrorCode::kCancelled, "stopped on request"});
      continue;
    }
    progress = progress_bar(fs::path(job.input).filename().string(), !common.quiet);
    Result<ImageReport> report = converted_by(convert, job);
    progress = nullptr;  // clears the bar
    if (!report) {
      report = with_light(report.error(), shared.plan.empty() ? job.input : shared.plan, shared.light);
    }
    if (!report) {
      exit = std::max(exit, complain(report.error()));
      if (common.json) {
        print_json({{"input", job.input}, {"output", job.output}, {"error", report.error().message}});
      }
      nlohmann::json entry = line(job, "failed");
      entry["error"] = report.error().message;
      manifest.add(entry);
      if (interrupted()) return interrupted_exit();
      continue;
    }
    ++converted;
    // Before the report, which standard output may refuse.
    nlohmann::json entry = line(job, "converted");
    entry["pixels"] = report->pixels();
    entry["bands"] = report->bands;
    entry["seconds"] = report->seconds;
    entry["bytes"] = report->bytes_written;
    manifest.add(entry);
    if (common.json) {
      report->notes.insert(report->notes.begin(), shared.notes.begin(), shared.notes.end());
      print_json(report_json(job.input, job.output, *report));
    } else if (!common.quiet) {
      print_report(job.input, job.output, *report, shared.colors, notes, common.stats);
    }
  }
  if (command.batch.update && common.shows_text()) {
    const std::size_t failed = batch.jobs.size() - converted - skipped;
    print("{} converted, {} up to date{}\n", converted, skipped,
          failed > 0 ? fmt::format(", {} failed", failed) : "");
  }
  return exit;
}

}  // namespace spectile::cli
