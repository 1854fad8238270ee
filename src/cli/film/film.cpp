// spectile film: the group of subcommands for films.
#include <CLI/CLI.hpp>

#include "src/cli/commands.hpp"

namespace spectile::cli {

void add_film(CLI::App& app, int& exit) {
  CLI::App* film = app.add_subcommand("film", "Merge, develop and simulate partial films; average renders");
  film->require_subcommand(1);
  film->footer("Example:\n  spectile film merge a.exr b.exr -o all.exr");
  add_film_merge(*film, exit);
  add_film_develop(*film, exit);
  add_film_average(*film, exit);
  add_film_simulate(*film, exit);
}

}  // namespace spectile::cli
