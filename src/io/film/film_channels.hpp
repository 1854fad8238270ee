// A film's limbs as channels of unsigned integers, and its options as attributes.
#pragma once

#include <string>
#include <vector>

#include "src/film/state.hpp"
#include "src/io/exr/exr_input.hpp"
#include "src/io/exr/exr_writer.hpp"

namespace spectile::io {

/// One limb of a pixel: where it is in a tile, and what its two channels are called but for ".hi" and ".lo".
struct FilmLimb {
  std::string name;
  std::size_t at = 0;         ///< of the tile's first pixel
  std::size_t per_pixel = 0;  ///< from a pixel to the next one
};

/// Every limb that a film of this layout keeps.
std::vector<FilmLimb> film_limbs(const FilmTileLayout& layout);

/// Name of the attribute that marks a partial film; its text is the version of these rules.
inline constexpr const char* kFilmAttribute = "spectileFilm";
inline constexpr const char* kFilmVersion = "1.0";

/// All that a film is made from again, and what it has counted.
TextAttributes film_attributes(const FilmAccess::State& state, const std::string& progress);

/// A film as a file's attributes describe it.
struct FilmDescription {
  std::unique_ptr<FilmAccess::State> state;  ///< without tiles
  std::string progress;
};

/// Errors: kBadFile, naming the attribute that is missing or damaged.
Result<FilmDescription> film_of(const PartHeader& header, const std::string& path);

}  // namespace spectile::io
