// Response curves of a film, as its kernels take them.
#pragma once

#include "src/film/state.hpp"

namespace spectile {

/// Of the observer and the sensors that the options name. Errors: kBadArgument, kOutOfMemory.
Result<void> make_film_responses(FilmAccess::State& state);

/// The largest sum of a value and its difference in a table of rows of curves, by magnitude.
float largest_in_rows(const float* table);

/// Floats of one response's table.
std::size_t film_response_floats(const FilmOptions& options);

}  // namespace spectile
