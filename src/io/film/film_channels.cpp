// A film's limbs as channels.
#include "src/io/film/film_channels.hpp"

#include "src/base/errors.hpp"

namespace spectile::io {

std::vector<FilmLimb> film_limbs(const FilmTileLayout& l) {
  std::vector<FilmLimb> out;
  const auto four = [&](const std::array<std::string, 4>& names, std::size_t at, std::size_t per_pixel) {
    for (std::size_t i = 0; i < 8; ++i) {
      const std::string& name = names[i % 4];
      if (name.empty()) continue;  // always 0, or the same weight again
      out.push_back({fmt::format("film.{}.{}", name, i < 4 ? "coarse" : "rest"), at + i, per_pixel});
    }
  };
  for (std::size_t q = 0; q < l.quads; ++q) {
    const auto name = [&](const char* component) { return fmt::format("color{}.{}", q, component); };
    four({name("0"), name("1"), name("2"), q == 0 ? "weight" : ""}, 8 * q, 8 * l.quads);
  }
  for (std::size_t b = 0; l.own_weights && b < l.bands; ++b) {
    for (std::size_t i = 0; i < 4; ++i) {
      out.push_back(
          {fmt::format("film.band{:04}.{}.{}", b, i % 2 == 0 ? "value" : "weight", i < 2 ? "coarse" : "rest"),
           l.spectrum_at + 4 * b + i, l.spectrum_limbs()});
    }
  }
  for (std::size_t q = 0; !l.own_weights && q < l.band_quads(); ++q) {
    std::array<std::string, 4> names;
    for (std::size_t c = 0; c < 4; ++c) {
      if (4 * q + c < l.bands) names[c] = fmt::format("band{:04}.value", 4 * q + c);
    }
    four(names, l.spectrum_at + 8 * q, l.spectrum_limbs());
  }
  for (std::size_t k = 0; l.moments && k < 4; ++k) {
    out.push_back({fmt::format("film.square.limb{}", k), l.moments_at + k, 8});
  }
  constexpr std::size_t kOfSquares[] = {4, 5, 7};  // 6 is the count
  for (std::size_t k = 0; l.moments && k < 3; ++k) {
    out.push_back({fmt::format("film.weight2.limb{}", k), l.moments_at + kOfSquares[k], 8});
  }
  if (l.moments) out.push_back({"film.count", l.moments_at + 6, 8});
  if (l.counts) out.push_back({"film.count", l.counts_at, 1});
  return out;
}

}  // namespace spectile::io
