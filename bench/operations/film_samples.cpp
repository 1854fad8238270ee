// A film's samples before they are added up: placed, turned, given to bands; and its pixels from their sums.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "bench/operations/films.hpp"
#include "src/film/pixel.hpp"
#include "src/film/state.hpp"

namespace spectile::measure {
namespace {

using kernels::kFilmTilePixels;
using kernels::kLanes;

void add_places(std::vector<Operation>& to, const SharedFilm& film) {
  Operation& op = add_operation(to, "film", "film: place samples", "sample", {3, 1}, {1, 1, Element::kInt});
  op.cache_only = true;
  op.unit = "exact";
  // Inside (7), to integers (6), tile (4), pixel (4), address (2), sums of what may be no number (4),
  // weight and reasons (5), extremes (2).
  op.operations = 34;
  op.bottleneck =
      "comparisons into masks and conversions to integers, of which fewer start at once than of products";
  op.fill = [](Random& random, float* v) {
    v[0] = uniform(random, 0.0F, static_cast<float>(kFilmSide));
    v[1] = uniform(random, 0.0F, static_cast<float>(kFilmSide));
    v[2] = uniform(random, 0.0F, 2.0F);
  };
  op.run = [film](const KernelTable& k, const Arrays& a) {
    thread_local std::vector<std::int32_t> none;
    none.resize(a.n());
    std::int32_t tiles[2] = {std::numeric_limits<std::int32_t>::max(), -1};
    std::uint64_t counts[kernels::kFilmReasons] = {};
    k.film_place({a.out<std::int32_t>(), tiles, counts}, FilmAccess::state(*film).kernel_window,
                 {a.in(0), a.in(1), a.in(2), none.data(), a.n()});
  };
  op.error = [](const double* v, const double* out, double /*tiny*/) {
    const auto any = [&](auto is) { return is(v[0]) || is(v[1]) || is(v[2]); };
    const auto inside = [](double x) { return x >= 0 && x < kFilmSide; };
    double reference = 0;
    if (any([](double x) { return std::isnan(x); })) {
      reference = -kernels::kFilmNan;
    } else if (any([](double x) { return std::isinf(x); })) {
      reference = -kernels::kFilmInfinite;
    } else if (v[2] < 0) {
      reference = -kernels::kFilmNegative;
    } else if (!inside(v[0]) || !inside(v[1])) {
      reference = -kernels::kFilmOutside;
    } else {
      const double x = std::floor(v[0]);
      const double y = std::floor(v[1]);
      const double tile = std::floor(y / kFilmTile) * (kFilmSide / static_cast<double>(kFilmTile)) +
                          std::floor(x / kFilmTile);
      reference = tile * kFilmTilePixels + std::fmod(y, kFilmTile) * kFilmTile + std::fmod(x, kFilmTile);
    }
    return out[0] == reference ? 0.0 : kBeyond;
  };
}

void add_band_quads(std::vector<Operation>& to, std::size_t bands) {
  const std::size_t stride = (bands + 3) / 4 * 4;
  Operation& op = add_operation(to, "film", "film: turn samples on bands", "spectrum", {bands + 1, 1},
                                {1, stride, Element::kQuad});
  op.cache_only = true;
  op.bound = 1;
  // A sample's magnitude (1), the largest (1), times the weight (1), its share of turning four by four (2).
  op.operations = 5 * static_cast<double>(bands);
  op.bottleneck = "quads of four where vectors are wider: turning four rows into columns";
  op.fill = uniform_values(bands + 1, 0.01F, 1.0F);
  op.run = [=](const KernelTable& k, const Arrays& a) {
    thread_local std::vector<const float*> rows;
    rows.resize(bands);
    for (std::size_t b = 0; b < bands; ++b) rows[b] = a.in(b);
    k.film_band_quads(a.out(), stride, reasons_for(a.n()),
                      {rows.data(), nullptr, nullptr, a.in(bands), bands, a.n()}, kNoLimits);
  };
  op.error =
      error_against(stride, 1, true, op.bound, [=](const double* v, double* reference, double* /*scale*/) {
        for (std::size_t b = 0; b < bands; ++b) reference[b] = v[b] * v[bands];
      });
}

void add_hits(std::vector<Operation>& to, const SharedFilm& film) {
  // The bands of the film are 5 nm each from 400 nm on.
  constexpr double kReference = 1.0 / 512;
  Operation& op = add_operation(to, "film", "film: find the bands of 4 wavelengths", "sample",
                                {3 * kWavelengths, 1}, {1, 3 * kWavelengths});
  op.cache_only = true;
  op.bound = 3;
  // A wavelength: inside (5), the bucket (4), a step of the search (3), the band (3), the factor and value
  // (3), what is beyond (6).
  op.operations = kWavelengths * 24;
  op.divisions = kWavelengths;
  op.bottleneck =
      "gathers: of the bucket's edge, of the edge that is compared, of the band; and pairs stored one by one";
  op.fill = fill_path;
  op.run = [film](const KernelTable& k, const Arrays& a) {
    const FilmAccess::State& s = FilmAccess::state(*film);
    kernels::FilmLimits limits = s.limits;
    limits.range = limits.weight_range = std::numeric_limits<float>::max();
    // A block at a time: bands and pairs lie one behind the other.
    for (std::size_t block = 0; block < a.blocks; ++block) {
      const PathRows path(a, block);
      std::int32_t reasons[kLanes] = {};
      auto* const band = a.out<std::int32_t>() + block * 3 * kWavelengths * kLanes;
      auto* const pairs = a.out() + (block * 3 + 1) * kWavelengths * kLanes;
      k.film_hits({band, pairs, reasons},
                  {path.values, path.lambda, path.density, nullptr, kWavelengths, kLanes}, s.buckets, limits,
                  static_cast<float>(kReference));
    }
  };
  op.read_block = [](const std::byte* block, std::size_t lane, double* values) {
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      std::int32_t band = 0;
      std::memcpy(&band, block + (k * kLanes + lane) * sizeof(band), sizeof(band));
      values[k] = static_cast<double>(band);
      float pair[2];
      std::memcpy(pair, block + (kWavelengths * kLanes + 2 * (k * kLanes + lane)) * sizeof(float),
                  sizeof(pair));
      values[kWavelengths + k] = static_cast<double>(pair[0]);
      values[2 * kWavelengths + k] = static_cast<double>(pair[1]);
    }
  };
  op.error = [](const double* in, const double* out, double tiny) {
    double worst = kOutOfDomain;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      const double radiance = in[k];
      const double lambda = in[kWavelengths + k];
      const double density = in[2 * kWavelengths + k];
      const bool falls = density != 0 && lambda >= 400 && lambda < 700;
      if (out[k] != (falls ? std::floor((lambda - 400) / 5) : -1.0)) return kBeyond;
      worst = std::max(worst, 0.0);
      // Results for refused samples are not specified.
      if (!falls || !std::isfinite(radiance) || !std::isfinite(density) || density < 0) continue;
      const double weight = kReference / density;
      // Beyond float's range, or so small that a rounding is not one in 2^24.
      if (weight > 0x1p126 || weight < 0x1p-100 || std::abs(radiance * weight) > 0x1p126) continue;
      const double off = std::abs(out[kWavelengths + k] - radiance * weight);
      const double value_error =
          std::max(0.0, off - 2 * tiny * std::max(1.0, weight)) / (0x1p-24 * std::abs(radiance * weight));
      if (radiance != 0 && off > 0) worst = std::max(worst, value_error);
      if (radiance == 0 && off != 0) return kBeyond;
      worst = std::max(worst, std::abs(out[2 * kWavelengths + k] - weight) / (0x1p-24 * weight));
    }
    return worst;
  };
}

}  // namespace

std::int32_t* reasons_for(std::size_t n) {
  thread_local std::vector<std::int32_t> reasons;
  reasons.resize(n);
  return reasons.data();
}

void add_film_samples(std::vector<Operation>& to, const SharedFilm& film, const SharedFilm& spectral,
                      const Bands& bands) {
  add_places(to, film);
  add_band_quads(to, bands.count());
  add_hits(to, spectral);
}

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
