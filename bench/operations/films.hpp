// The films whose grids and tables the measured kernels are given.
#pragma once

#include <limits>
#include <memory>
#include <spectile/film/film.hpp>

#include "bench/operations/operation.hpp"

namespace spectile::measure {

using SharedFilm = std::shared_ptr<const Film>;

/// Pixels of such a film along a side, and limbs of a pixel's colour and weight.
inline constexpr int kFilmSide = 1024;
inline constexpr std::size_t kPixelLimbs = kernels::kFilmQuadLimbs;

/// Far above what is tried: what a film refuses is another matter.
inline constexpr kernels::FilmLimits kNoLimits = {std::numeric_limits<float>::infinity(),
                                                  std::numeric_limits<float>::max(),
                                                  std::numeric_limits<float>::max()};

/// Memory of the thread for the reasons of n samples.
std::int32_t* reasons_for(std::size_t n);

/// Samples on their way to pixels, and what is made of pixels. `spectral` keeps spectra on 60 bands.
void add_film_samples(std::vector<Operation>& to, const SharedFilm& film, const SharedFilm& spectral,
                      const Bands& bands);
void add_development(std::vector<Operation>& to, const SharedFilm& film);

}  // namespace spectile::measure
