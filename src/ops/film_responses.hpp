// Response curves of a film, as its kernels take them.
#pragma once

#include "src/ops/film_state.hpp"

namespace spectile {

/// Of the observer and the sensors that the options name. Errors: kBadArgument, kOutOfMemory.
Result<void> make_film_responses(FilmAccess::State& state);

/// Floats of one response's table.
std::size_t film_response_floats(const FilmOptions& options);

}  // namespace spectile
