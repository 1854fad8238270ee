// The films whose grids and tables the measured kernels are given.
#pragma once

#include <memory>
#include <spectile/film/film.hpp>

#include "bench/operations/operation.hpp"

namespace spectile::measure {

using SharedFilm = std::shared_ptr<const Film>;

/// Pixels of such a film along a side, and limbs of a pixel's colour and weight.
inline constexpr int kFilmSide = 1024;
inline constexpr std::size_t kPixelLimbs = kernels::kFilmQuadLimbs;

/// Samples on their way to pixels, and what is made of pixels. `spectral` keeps spectra on 60 bands.
void add_film_samples(std::vector<Operation>& to, const SharedFilm& film, const SharedFilm& spectral,
                      const Bands& bands);
void add_development(std::vector<Operation>& to, const SharedFilm& film);

}  // namespace spectile::measure
