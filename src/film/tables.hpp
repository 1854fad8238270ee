// Tables that a film looks things up in.
#pragma once

#include <functional>

#include "src/film/state.hpp"

namespace spectile {

/// The bands of wavelengths. Errors: kBadArgument for edges that float cannot tell apart; kOutOfMemory.
Result<void> make_film_buckets(FilmAccess::State& state);

/// A profile of the filter. Errors: kBadArgument for one that is higher elsewhere than at its centre;
/// kOutOfMemory.
Result<void> make_film_profile(FilmProfile& out, double radius, const std::function<double(double)>& at);

}  // namespace spectile
