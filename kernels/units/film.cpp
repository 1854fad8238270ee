// Film samples weighed, placed and added: one unit, compiled once per instruction set.
#include "kernels/film_add.inl"
#include "kernels/film_weigh.inl"

namespace spectile::kernels::SPECTILE_ISA {

extern const FilmKernels film;
constexpr FilmKernels film = {
    .film_weigh_wavelengths = film_weigh_wavelengths,
    .film_weigh_bands = film_weigh_bands,
    .film_band_quads = film_band_quads,
    .film_hits = film_hits,
    .film_place = film_place,
    .film_add = film_add,
    .film_add_hits = film_add_hits,
    .film_add_moments = film_add_moments,
    .film_count = film_count,
};

}  // namespace spectile::kernels::SPECTILE_ISA
