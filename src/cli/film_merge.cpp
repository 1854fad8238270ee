// spectile film merge: partial films become one.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>

#include "src/cli/common.hpp"

namespace spectile::cli {
namespace {

struct Arguments {
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

int run(const Arguments& a) {
  if (const int bad = apply_common(a.common)) return bad;
  ImageOptions options;
  options.threads = a.common.threads;
  const auto compression = Compression::parse(a.compression);
  if (!compression) {
    fmt::print(stderr, "spectile: {}\n", compression.error().message);
    return kBadUsage;
  }
  options.compression = *compression;
  std::set<std::string> seen;
  for (const std::string& input : a.inputs) {
    if (seen.insert(identity(input)).second) continue;
    fmt::print(stderr, "spectile: {} is named twice, and its samples would count twice\n", input);
    return kBadUsage;
  }
  catch_signals();
  auto all = load_film(a.inputs[0], a.common.threads);
  if (!all) return complain(all.error());
  for (std::size_t i = 1; i < a.inputs.size(); ++i) {
    if (interrupted()) {
      fmt::print(stderr, "spectile: interrupted; nothing was written\n");
      return kInterrupted;
    }
    const auto next = load_film(a.inputs[i], a.common.threads);
    if (!next) return complain(next.error());
    if (const auto merged = all->film.merge(next->film); !merged) {
      return complain(
          {merged.error().code == ErrorCode::kBadArgument ? ErrorCode::kBadFile : merged.error().code,
           fmt::format("{} and {}: {}", a.inputs[0], a.inputs[i], merged.error().message)});
    }
  }
  const auto saved = save_film(all->film, a.output, {}, options);
  if (!saved) return complain(saved.error());
  const FilmStats stats = all->film.stats();
  if (a.common.json) {
    const nlohmann::json out = {{"inputs", a.inputs},
                                {"output", a.output},
                                {"samples", stats.accepted},
                                {"rejected", stats.rejected.total()},
                                {"bytes_written", saved->bytes_written},
                                {"seconds", saved->seconds}};
    fmt::print("{}\n", out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  } else if (!a.common.quiet) {
    fmt::print("{} film{} -> {}: {} samples, {}\n", a.inputs.size(), a.inputs.size() == 1 ? "" : "s",
               a.output, stats.accepted, size_text(saved->bytes_written));
  }
  return kOk;
}

}  // namespace

void add_film_merge(CLI::App& film, int& exit) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = film.add_subcommand(
      "merge", "Merge partial films: the very bits of one film fed with all their samples, in any order");
  command->add_option("IN", a->inputs, "Partial films")->required();
  command->add_option("-o,--output", a->output, "The partial film to write")->required();
  command->add_option("--compression", a->compression, "none, rle, zips, zip or piz, zip with :LEVEL")
      ->capture_default_str();
  add_common(*command, a->common);
  command->callback([a, &exit] { exit = run(*a); });
}

}  // namespace spectile::cli
