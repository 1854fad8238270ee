// From weighed samples to tiles: which pixels they reach, tile by tile, under the tiles' locks.
#pragma once

#include <array>
#include <spectile/film/film.hpp>

#include "kernels/abi.hpp"
#include "src/film/scratch.hpp"
#include "src/film/state.hpp"

namespace spectile {

/// Sizes of a chunk's contributions in the scratch.
struct FilmContributions {
  std::size_t wavelengths = 0;  ///< rows of hits
  std::size_t samples = 0;      ///< in a row of them
};

/// Adds entries (in any order, tiles mixed unless they name one) to the film. Errors: kOutOfMemory.
Result<void> add_entries(FilmAccess::State& state, const kernels::KernelTable& table,
                         const FilmContributions& contributions, const kernels::FilmEntries& entries,
                         FilmScratch& scratch);

/// Adds a chunk of samples to every pixel within the filter's radius, and counts their reasons; those known
/// are in the scratch. Errors: kOutOfMemory.
Result<void> splat(FilmAccess::State& state, const kernels::KernelTable& table,
                   const FilmContributions& contributions, const float* x, const float* y,
                   const float* weight, std::size_t n,
                   std::array<std::uint64_t, kernels::kFilmReasons>& counts, FilmScratch& scratch);

}  // namespace spectile
