// Pixels of a film from their exact sums.
#include <algorithm>
#include <cmath>

#include "bench/operations/films.hpp"
#include "src/film/pixel.hpp"

namespace spectile::measure {

using kernels::KernelTable;
using kernels::kFilmTilePixels;

void add_development(std::vector<Operation>& to, const SharedFilm& film) {
  Operation& op =
      add_operation(to, "film", "film: develop XYZ", "pixel", {1, kPixelLimbs, Element::kLimb}, {3, 1});
  op.cache_only = true;  // tile by tile, under its lock
  op.bound = 1.001;
  // In double: four sums of two limbs, carried over (4), widened, scaled and added (5), three rounded.
  op.operations = 2 * (4 * 9 + 3);
  op.divisions = 2 * 3;
  op.bottleneck =
      "one pixel after another, in scalar doubles: eight limbs carried over and widened, three divisions";
  op.fill = [](Random& random, float* v) {
    // Sixteen samples: the weight's coarse steps are 2^-15, the colours' are 2.
    for (std::size_t c = 0; c < 3; ++c) v[c] = std::floor(uniform(random, 1.0F, 16.0F));
    v[3] = 0x1p19F;
    for (std::size_t c = 4; c < 8; ++c) v[c] = uniform(random, -0x1p43F, 0x1p43F);
  };
  op.run = [film](const KernelTable&, const Arrays& a) {
    const FilmPixels pixels(FilmAccess::state(*film));
    const std::size_t plane = a.target_plane / sizeof(float);
    for (std::size_t first = 0; first < a.n(); first += kFilmTilePixels) {
      const std::int64_t* const tile = a.in<std::int64_t>() + first * kPixelLimbs;
      for (std::size_t i = 0; i < std::min(kFilmTilePixels, a.n() - first); ++i) {
        pixels.develop(FilmLayer::kXyz, 0, tile, i, a.out() + first + i, plane);
      }
    }
  };
  op.error =
      error_against(3, 1, true, op.bound, [film](const double* limbs, double* reference, double* /*scale*/) {
        const FilmOptions& o = film->options();
        const auto step = [&](bool weight) {
          return std::ldexp(1.0, (weight ? o.weight_range : o.range) - kFilmCoarseBits);
        };
        const auto sum = [&](std::size_t c, double coarse_step) {
          // The part of a rest beyond half a coarse step belongs to the coarse limb.
          const double over = std::nearbyint(std::ldexp(limbs[kernels::kFilmQuadRest + c], -kFilmLimbBits));
          const long double rest = static_cast<long double>(limbs[kernels::kFilmQuadRest + c]) -
                                   std::ldexp(static_cast<long double>(over), kFilmLimbBits);
          const long double coarse = static_cast<long double>(limbs[c]) + over;
          return (coarse + std::ldexp(rest, -kFilmLimbBits)) * coarse_step;
        };
        const long double weight = sum(3, step(true));
        for (std::size_t c = 0; c < 3; ++c) {
          reference[c] = weight == 0 ? 0.0 : static_cast<double>(sum(c, step(false)) / weight);
        }
      });
}

}  // namespace spectile::measure
