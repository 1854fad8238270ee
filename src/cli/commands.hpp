// The subcommands: each adds itself to the tool, and gives its exit code to `exit` when it has run.
#pragma once

namespace spectile::cli {

class Command;

void add_demo(const Command& app, int& exit);
void add_upsample(const Command& app, int& exit);
void add_expand(const Command& app, int& exit);
void add_relight(const Command& app, int& exit);
void add_project(const Command& app, int& exit);
void add_convert(const Command& app, int& exit);
void add_validate(const Command& app, int& exit);
void add_info(const Command& app, int& exit);
void add_verify(const Command& app, int& exit);
void add_spectra(const Command& app, int& exit);
void add_plan(const Command& app, int& exit);
void add_fit(const Command& app, int& exit);
void add_film(const Command& app, int& exit);
void add_bench(const Command& app, int& exit);

// Subcommands of "film".
void add_film_average(const Command& film, int& exit);
void add_film_develop(const Command& film, int& exit);
void add_film_merge(const Command& film, int& exit);
void add_film_simulate(const Command& film, int& exit);

}  // namespace spectile::cli
