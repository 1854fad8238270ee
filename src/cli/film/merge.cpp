// spectile film merge: partial films become one.
#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "src/cli/commands.hpp"
#include "src/cli/options/common_options.hpp"
#include "src/cli/output/files.hpp"
#include "src/cli/output/print.hpp"
#include "src/cli/output/progress.hpp"

namespace spectile::cli {
namespace {

struct MergeArguments {
  Common common;
  std::string compression = "zip:1";
  std::vector<std::string> inputs;
  std::string output;
};

/// The file that a path leads to, whatever it is called.
std::string identity(const std::string& path) {
  std::error_code error;
  const auto canonical = std::filesystem::canonical(path, error);
  return error ? path : canonical.string();
}

int run_merge(const MergeArguments& a) {
  apply_common(a.common);
  ImageOptions options;
  options.threads = a.common.threads;
  options.compression = take(Compression::parse(a.compression));
  std::set<std::string> seen;
  for (const std::string& input : a.inputs) {
    if (seen.insert(identity(input)).second) continue;
    return complain_usage(fmt::format("{} is named twice, and its samples would count twice", input));
  }
  check_image_name(a.output);
  check_outputs({{a.output, kOutputRole}}, named_files(a.inputs, kInputRole));
  catch_signals();
  std::vector<std::string> notes;
  options.progress = progress_bar(std::filesystem::path(a.output).filename().string(), !a.common.quiet);
  LoadedFilm all = load_film_file(a.inputs[0], a.common.threads, notes);
  for (std::size_t i = 1; i < a.inputs.size(); ++i) {
    if (interrupted()) {
      return complain({ErrorCode::kCancelled, "interrupted; nothing was written"});
    }
    const LoadedFilm next = load_film_file(a.inputs[i], a.common.threads, notes);
    if (const auto merged = all.film.merge(next.film); !merged) {
      return complain(
          {merged.error().code == ErrorCode::kBadArgument ? ErrorCode::kBadFile : merged.error().code,
           fmt::format("{} and {}: {}", a.inputs[0], a.inputs[i], merged.error().message)});
    }
  }
  const FilmFileReport saved = take(save_film(all.film, a.output, {}, options));
  options.progress = nullptr;  // clears the bar
  const FilmStats stats = all.film.stats();
  if (a.common.json) {
    print_json({{"inputs", a.inputs},
                {"output", a.output},
                {"samples", stats.accepted},
                {"rejected", stats.rejected.total()},
                {"bytes_written", saved.bytes_written},
                {"seconds", saved.seconds},
                {"notes", notes}});
  } else if (!a.common.quiet) {
    print("{} -> {}: {} samples, {}\n", plural(a.inputs.size(), "film"), a.output, stats.accepted,
          size_text(saved.bytes_written));
    Notes().print(notes);
  }
  return kOk;
}

}  // namespace

void add_film_merge(const Command& film, int& exit) {
  const auto [command, a] =
      add_subcommand(film, "merge", "Merge partial films; the order does not matter", run_merge, exit);
  command.positional("IN", a->inputs, "Partial films").required();
  command.output_file("-o,--output", a->output, kFilesGroup, "Partial film to write").required();
  add_film_compression_option(command, a->compression);
  add_common(command, a->common, "spectile film merge a.exr b.exr -o all.exr");
}

}  // namespace spectile::cli
