// The checksum of a partial film: of its options, its counts and its sums.
#pragma once

#include <string>

#include "src/io/film/film_channels.hpp"

namespace spectile::io {

/// Name of the attribute. Films of earlier versions have none.
inline constexpr const char* kFilmChecksum = "spectileFilmChecksum";

/// "xxh3-128/2 " and 32 digits: of the film's size, of all attributes that a film is made from again, and of
/// all tiles that hold anything, in their order. The carries must be normalized: equal films then have equal
/// checksums. Source: Collet, xxHash, XXH3_128bits.
std::string film_checksum(const TextAttributes& attributes, const FilmAccess::State& state);

/// True if a film has the checksum of its file, which may be one of the first kind, "xxh3-128 ", without the
/// size.
bool has_checksum(const std::string& checksum, const TextAttributes& attributes,
                  const FilmAccess::State& state);

}  // namespace spectile::io
