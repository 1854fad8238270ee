// spectile film: the group of subcommands for films.
#include "src/cli/commands.hpp"
#include "src/cli/options/command.hpp"

namespace spectile::cli {

void add_film(const Command& app, int& exit) {
  const Command film = app.subcommand("film", "Merge, develop and simulate partial films; average renders");
  film.require_subcommand();
  film.footer("Example:\n  spectile film merge a.exr b.exr -o all.exr");
  add_film_merge(film, exit);
  add_film_develop(film, exit);
  add_film_average(film, exit);
  add_film_simulate(film, exit);
}

}  // namespace spectile::cli
