// The subcommands: each adds itself to the tool, and gives its exit code to `exit` when it has run.
#pragma once

namespace CLI {
class App;
}

namespace spectile::cli {

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

// Subcommands of "film".
void add_film_average(CLI::App& film, int& exit);
void add_film_develop(CLI::App& film, int& exit);
void add_film_merge(CLI::App& film, int& exit);
void add_film_simulate(CLI::App& film, int& exit);

}  // namespace spectile::cli
