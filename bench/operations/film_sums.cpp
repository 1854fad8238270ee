// A film's exact sums: colours, wavelengths in their bands, moments and counts added to pixels.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "bench/operations/films.hpp"
#include "src/base/errors.hpp"
#include "src/film/state.hpp"

namespace spectile::measure {
namespace {

using kernels::FilmEntries;
using kernels::FilmSums;
using kernels::kFilmTilePixels;

/// Bands of the film that hits are added to: few, so that many pixels are in the caches.
constexpr std::size_t kHitBands = 8;
constexpr std::size_t kHitLimbs = kernels::kFilmHitLimbs * kHitBands;

/// A film whose grids and tables the kernels are given; it is never fed.
Result<SharedFilm> make_film(bool spectral) {
  FilmOptions o;
  o.width = o.height = kFilmSide;
  o.spectral = spectral;
  o.statistics = PixelStatistics::kVariance;
  SPECTILE_ASSIGN(auto made, Film::create(o));
  return std::make_shared<const Film>(std::move(made));
}

double coarse_step(const Film& film, bool weight) {
  const FilmOptions& o = film.options();
  return std::ldexp(1.0, (weight ? o.weight_range : o.range) - kFilmCoarseBits);
}

double fine_step(const Film& film, bool weight) {
  return std::ldexp(coarse_step(film, weight), -kFilmLimbBits);
}

/// Distance of a number from the limbs that it came to, in fine steps.
double fine_steps_off(const Film& film, bool weight, double v, double coarse, double rest) {
  // A contribution less its coarse part is exact in double, and so is what is left.
  const double fine = fine_step(film, weight);
  return std::abs(((v - coarse * coarse_step(film, weight)) - rest * fine) / fine);
}

/// The same beyond what an operand may be off by.
double grid_error(const Film& film, bool weight, double v, double coarse, double rest, double tiny) {
  return std::max(0.0, fine_steps_off(film, weight, v, coarse, rest) - tiny / fine_step(film, weight));
}

/// value(i) for each pixel of a tile, made once for each kind of value.
template <class Value>
auto tile_table(Value value) {
  static const auto table = [&] {
    std::array<decltype(value(std::size_t{})), kFilmTilePixels> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = value(i);
    return out;
  }();
  return table.data();
}

/// Filter weights, exact in few bits.
const float* filter_weights() {
  return tile_table([](std::size_t i) { return static_cast<float>(1 + i % 61) / 64.0F; });
}

/// Calls add(first lane, entries, sums of the tile) for each tile's worth of lanes; lane i is pixel i of its
/// tile.
template <class Add>
void over_tiles(const Arrays& a, std::size_t limbs, Add add) {
  for (std::size_t first = 0; first < a.n(); first += kFilmTilePixels) {
    std::int64_t* tile = a.out<std::int64_t>() + first * limbs;
    FilmEntries entries;
    entries.address = tile_table([](std::size_t i) { return static_cast<std::int32_t>(i); });
    entries.count = std::min(kFilmTilePixels, a.n() - first);
    entries.tile = 0;
    add(first, entries, FilmSums{&tile, 0, limbs});
  }
}

/// Clamped to the range of a film's sums.
float held(float v, double most) {
  const auto limit = static_cast<float>(most);
  return std::isnan(v) ? 0.0F : std::clamp(v, -limit, limit);
}

double largest(const Film& film, bool weight) {
  return std::ldexp(coarse_step(film, weight), kFilmCoarseBits);
}

Operation& sums_operation(std::vector<Operation>& to, std::string name, std::size_t limbs) {
  Operation& op = add_operation(to, "film", std::move(name), "sample", {1, 4, Element::kQuad},
                                {1, limbs, Element::kLimb});
  op.cache_only = true;  // a tile of pixels stays in the caches while its samples come
  op.adds = true;
  op.clear = [limbs](const Arrays& a) {
    std::memset(a.out<std::int64_t>(), 0, a.n() * limbs * sizeof(std::int64_t));
  };
  op.fill = [](Random& random, float* v) {
    for (std::size_t c = 0; c < 3; ++c) v[c] = uniform(random, 0.0F, 2.0F);
    v[3] = uniform(random, 0.5F, 1.0F);
  };
  return op;
}

/// A sum of two limbs on doubles: widened, rounded to both limbs' steps and taken from what is left.
constexpr double kLimbPair = 2 * 9;

void add_colors(std::vector<Operation>& to, const SharedFilm& film) {
  Operation& op = sums_operation(to, "film: add colours", kPixelLimbs);
  op.operations = 4 * kLimbPair;
  op.unit = "of a step of the grid";
  op.bound = 0.5;
  op.run = [film](const KernelTable& k, const Arrays& a) {
    over_tiles(a, kPixelLimbs, [&](std::size_t first, const FilmEntries& entries, const FilmSums& sums) {
      k.film_add(sums, FilmAccess::state(*film).grid, entries, a.in() + 4 * first, 1);
    });
  };
  op.admit = [film](float* v) {
    for (std::size_t c = 0; c < 4; ++c) v[c] = held(v[c], largest(*film, c == 3));
  };
  op.error = [=](const double* v, const double* limbs, double tiny) {
    double worst = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const double rest = limbs[kernels::kFilmQuadRest + c];
      worst = std::max(worst, grid_error(*film, c == 3, v[c], limbs[c], rest, tiny));
    }
    return worst;
  };

  // As a filter spreads them: a factor for each pixel reached.
  Operation& spread = to.emplace_back(Operation(to.back()));
  spread.name = "film: add colours with filter weights";
  spread.item = "pixel reached";
  spread.operations += 4;
  spread.bottleneck = "one entry after another, as two may reach the same pixel";
  spread.unit = "u and half a step of the grid";
  spread.bound = 1;
  spread.run = [film](const KernelTable& k, const Arrays& a) {
    over_tiles(a, kPixelLimbs, [&](std::size_t first, FilmEntries entries, const FilmSums& sums) {
      entries.sample = tile_table([](std::size_t i) { return static_cast<std::uint32_t>(i); });
      entries.factor = filter_weights();
      k.film_add(sums, FilmAccess::state(*film).grid, entries, a.in() + 4 * first, 1);
    });
  };
  spread.error = nullptr;
  spread.error_at = [=](std::size_t lane, const double* v, const double* limbs, double tiny) {
    const auto factor = static_cast<double>(filter_weights()[lane % kFilmTilePixels]);
    double worst = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const double reference = v[c] * factor;
      const double fine = fine_step(*film, c == 3);
      const double half = 0.5 * fine + tiny;
      const double rest = limbs[kernels::kFilmQuadRest + c];
      const double off = fine_steps_off(*film, c == 3, reference, limbs[c], rest) * fine;
      if (off > half) worst = std::max(worst, (off - half) / (0x1p-24 * std::abs(reference)));
    }
    return worst;
  };
}

void add_hit_sums(std::vector<Operation>& to, const SharedFilm& film) {
  Operation& op = sums_operation(to, "film: add 4 wavelengths to their bands", kHitLimbs);
  op.in = {kWavelengths, 2, Element::kQuad};
  op.touched_bytes = kWavelengths * 4 * sizeof(std::int64_t);
  // Two numbers a wavelength, times the factor.
  op.operations = kWavelengths * 2 * (1 + kLimbPair);
  op.unit = "of a step of the grid";
  op.bound = 0.5;
  op.bottleneck = "two numbers at a time, as each wavelength goes to a band of its own";
  op.fill = [](Random& random, float* v) {
    for (std::size_t k = 0; k < 2 * kWavelengths; ++k) v[k] = uniform(random, 0.0F, 2.0F);
  };
  const auto hit_band = [](std::size_t lane, std::size_t k) { return (lane + 2 * k) % kHitBands; };
  op.run = [=](const KernelTable& k, const Arrays& a) {
    // Rows of pairs are as far apart as the planes, and so are those of bands.
    const std::size_t apart = a.source_plane / (2 * sizeof(float));
    thread_local std::vector<std::int32_t> bands;
    if (bands.size() != apart * kWavelengths) {
      bands.resize(apart * kWavelengths);
      for (std::size_t i = 0; i < bands.size(); ++i) {
        bands[i] = static_cast<std::int32_t>(hit_band(i % apart, i / apart));
      }
    }
    over_tiles(a, kHitLimbs, [&](std::size_t first, const FilmEntries& entries, const FilmSums& sums) {
      k.film_add_hits(sums, FilmAccess::state(*film).band_grid, entries,
                      {bands.data() + first, a.in() + 2 * first, kWavelengths, apart});
    });
  };
  op.admit = [film](float* v) {
    for (std::size_t k = 0; k < 2 * kWavelengths; ++k) v[k] = held(v[k], largest(*film, k % 2 == 1));
  };
  op.error_at = [=](std::size_t lane, const double* v, const double* limbs, double tiny) {
    double worst = 0;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      const double* const of_band = limbs + kernels::kFilmHitLimbs * hit_band(lane, k);
      for (std::size_t c = 0; c < 2; ++c) {
        const double rest = of_band[kernels::kFilmHitRest + c];
        worst = std::max(worst, grid_error(*film, c == 1, v[2 * k + c], of_band[c], rest, tiny));
      }
    }
    return worst;
  };
}

void add_moments(std::vector<Operation>& to, const SharedFilm& film) {
  Operation& op = sums_operation(to, "film: add moments", kPixelLimbs);
  op.operations = 2 * (4 + 7 * 5 + 1);
  op.divisions = 2;
  op.unit = "2^-53";
  op.bound = 2.01;
  op.bottleneck = "one sample after another: seven limbs in scalar doubles, each of what the one before left";
  op.run = [film](const KernelTable& k, const Arrays& a) {
    over_tiles(a, kPixelLimbs, [&](std::size_t first, const FilmEntries& entries, const FilmSums& sums) {
      k.film_add_moments(sums, FilmAccess::state(*film).moment_grid, entries, a.in() + 4 * first);
    });
  };
  op.admit = [film](float* v) {
    v[3] = std::abs(held(v[3], largest(*film, true)));
    // The luminance before it is weighed is within the range too.
    v[1] = held(v[1], static_cast<double>(v[3]) * largest(*film, false));
  };
  op.error = [film](const double* v, const double* limbs, double tiny) {
    const FilmOptions& o = film->options();
    const long double y = v[1];
    const long double w = v[3];
    const long double square = w == 0 ? 0 : y * y / w;
    const int top = 2 * o.range + o.weight_range;
    const auto sum = [](const double* limb, std::size_t count, const std::size_t* at, int exponent) {
      long double out = 0;
      for (std::size_t k = 0; k < count; ++k) {
        out += static_cast<long double>(limb[at[k]]) *
               std::ldexp(1.0L, exponent - kFilmCoarseBits - static_cast<int>(k) * kFilmLimbBits);
      }
      return out;
    };
    constexpr std::size_t kSquares[] = {0, 1, 2, 3};
    const auto error = [&](long double found, long double reference, int exponent, int limbs_in_it) {
      const long double half =
          std::ldexp(0.5L, exponent - kFilmCoarseBits - (limbs_in_it - 1) * kFilmLimbBits);
      const long double off = std::abs(found - reference) - half - tiny;
      return off > 0 ? static_cast<double>(off / (0x1p-53L * reference)) : 0.0;
    };
    if (limbs[kernels::kFilmMomentCount] != 1) return kBeyond;
    return std::max(
        error(sum(limbs, 4, kSquares, top), square, top, 4),
        error(sum(limbs, 3, kernels::kFilmWeightSquare, 2 * o.weight_range), w * w, 2 * o.weight_range, 3));
  };
}

void add_counts(std::vector<Operation>& to) {
  Operation& op = sums_operation(to, "film: count samples", 1);
  op.in = {1, 1, Element::kInt};  // stands for the address that is read
  op.fill = uniform_values(1, 0.0F, 1.0F);
  op.operations = 1;
  op.unit = "exact";
  op.bottleneck = "one address after another, as two may be of the same pixel";
  op.run = [](const KernelTable& k, const Arrays& a) {
    over_tiles(a, 1, [&](std::size_t, const FilmEntries& entries, const FilmSums& sums) {
      k.film_count(sums, entries);
    });
  };
  op.error = [](const double*, const double* out, double) { return out[0] == 1 ? 0.0 : kBeyond; };
}

}  // namespace

Result<void> add_film_sums(std::vector<Operation>& to, const Bands& bands) {
  SPECTILE_ASSIGN(const auto film, make_film(false));
  SPECTILE_ASSIGN(const auto spectral, make_film(true));
  add_film_samples(to, film, spectral, bands);
  add_colors(to, film);
  add_hit_sums(to, spectral);
  add_moments(to, film);
  add_counts(to);
  add_development(to, film);
  return {};
}

}  // namespace spectile::measure
