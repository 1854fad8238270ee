// A film's limbs as channels.
#include "src/io/film/film_channels.hpp"

#include "src/base/errors.hpp"

namespace spectile::io {

using kernels::kFilmHitLimbs;
using kernels::kFilmHitRest;
using kernels::kFilmHitWeight;
using kernels::kFilmMomentLimbs;
using kernels::kFilmQuadLimbs;
using kernels::kFilmQuadRest;

std::vector<FilmLimb> film_limbs(const FilmTileLayout& l) {
  std::vector<FilmLimb> out;
  const auto four = [&](const std::array<std::string, 4>& names, std::size_t at, std::size_t per_pixel) {
    for (std::size_t i = 0; i < kFilmQuadLimbs; ++i) {
      const std::string& name = names[i % kFilmQuadRest];
      if (name.empty()) continue;  // always 0, or the same weight again
      out.push_back(
          {fmt::format("film.{}.{}", name, i < kFilmQuadRest ? "coarse" : "rest"), at + i, per_pixel});
    }
  };
  for (std::size_t q = 0; q < l.quads; ++q) {
    const auto name = [&](const char* component) { return fmt::format("color{}.{}", q, component); };
    four({name("0"), name("1"), name("2"), q == 0 ? "weight" : ""}, kFilmQuadLimbs * q,
         kFilmQuadLimbs * l.quads);
  }
  for (std::size_t b = 0; l.own_weights && b < l.bands; ++b) {
    for (std::size_t i = 0; i < kFilmHitLimbs; ++i) {
      const char* const what = i % kFilmHitRest == kFilmHitWeight ? "weight" : "value";
      out.push_back({fmt::format("film.band{:04}.{}.{}", b, what, i < kFilmHitRest ? "coarse" : "rest"),
                     l.spectrum_at + kFilmHitLimbs * b + i, l.spectrum_limbs()});
    }
  }
  for (std::size_t q = 0; !l.own_weights && q < l.band_quads(); ++q) {
    std::array<std::string, 4> names;
    for (std::size_t c = 0; c < 4; ++c) {
      if (4 * q + c < l.bands) names[c] = fmt::format("band{:04}.value", 4 * q + c);
    }
    four(names, l.spectrum_at + kFilmQuadLimbs * q, l.spectrum_limbs());
  }
  for (std::size_t k = 0; l.moments && k < kernels::kFilmSquareLimbs; ++k) {
    out.push_back({fmt::format("film.square.limb{}", k), l.moments_at + k, kFilmMomentLimbs});
  }
  for (std::size_t k = 0; l.moments && k < kernels::kFilmWeightSquareLimbs; ++k) {
    out.push_back({fmt::format("film.weight2.limb{}", k), l.moments_at + kernels::kFilmWeightSquare[k],
                   kFilmMomentLimbs});
  }
  if (l.moments) out.push_back({"film.count", l.moments_at + kernels::kFilmMomentCount, kFilmMomentLimbs});
  if (l.counts) out.push_back({"film.count", l.counts_at, 1});
  return out;
}

}  // namespace spectile::io
