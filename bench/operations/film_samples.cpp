// A film's samples before they are added up: placed, turned, given to bands.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "bench/operations/films.hpp"
#include "src/film/state.hpp"

namespace spectile::measure {
namespace {

using kernels::KernelTable;
using kernels::kFilmTilePixels;
using kernels::kLanes;

constexpr double kBeyond = std::numeric_limits<double>::infinity();

void add_places(std::vector<Operation>& to, const SharedFilm& film) {
  Operation op;
  op.group = "film";
  op.name = "film: place samples";
  op.item = "sample";
  op.in = {3, 1};
  op.out = {1, 1, Element::kInt};
  op.cache_only = true;
  op.unit = "exact";
  // Inside (7), to integers (6), tile (4), pixel (4), address (2), sums of what may be no number (4),
  // weight and reasons (5), extremes (2).
  op.operations = 34;
  op.bottleneck =
      "comparisons into masks and conversions to integers, of which fewer start at once than of "
      "products";
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
  to.push_back(std::move(op));
}

void add_band_quads(std::vector<Operation>& to, std::size_t bands) {
  const std::size_t stride = (bands + 3) / 4 * 4;
  Operation op;
  op.group = "film";
  op.name = "film: turn samples on bands";
  op.item = "spectrum";
  op.in = {bands + 1, 1};
  op.out = {1, stride, Element::kQuad};
  op.cache_only = true;
  op.bound = 1;
  // A sample's magnitude (1), the largest (1), times the weight (1), its share of turning four by four (2).
  op.operations = 5 * static_cast<double>(bands);
  op.bottleneck = "quads of four where vectors are wider: turning four rows into columns";
  op.fill = uniform_values(bands + 1, 0.01F, 1.0F);
  op.run = [=](const KernelTable& k, const Arrays& a) {
    thread_local std::vector<const float*> rows;
    thread_local std::vector<std::int32_t> reasons;
    rows.resize(bands);
    reasons.resize(a.n());
    for (std::size_t b = 0; b < bands; ++b) rows[b] = a.in(b);
    const kernels::FilmLimits limits = {std::numeric_limits<float>::infinity(),
                                        std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
    k.film_band_quads(a.out(), stride, reasons.data(),
                      {rows.data(), nullptr, nullptr, a.in(bands), bands, a.n()}, limits);
  };
  op.error = error_against(
      stride,
      [=](const double* v, double* reference, double* scale) {
        for (std::size_t b = 0; b < bands; ++b) {
          reference[b] = v[b] * v[bands];
          scale[b] = std::abs(reference[b]);
        }
      },
      1, true, op.bound);
  to.push_back(std::move(op));
}

void add_hits(std::vector<Operation>& to, const SharedFilm& film) {
  // The bands of the film are 5 nm each from 400 nm on.
  constexpr double kReference = 1.0 / 512;
  Operation op;
  op.group = "film";
  op.name = "film: find the bands of 4 wavelengths";
  op.item = "sample";
  op.in = {3 * kFilmWavelengths, 1};
  op.out = {1, 3 * kFilmWavelengths};
  op.cache_only = true;
  op.bound = 3;
  // A wavelength: inside (5), the bucket (4), a step of the search (3), the band (3), the factor and value
  // (3), what is beyond (6).
  op.operations = kFilmWavelengths * 24;
  op.divisions = kFilmWavelengths;
  op.bottleneck =
      "gathers: of the bucket's edge, of the edge that is compared, of the band; and pairs stored one by one";
  op.fill = [](Random& random, float* v) {
    for (std::size_t k = 0; k < kFilmWavelengths; ++k) {
      v[k] = uniform(random, 0.0F, 2.0F);
      v[kFilmWavelengths + k] = uniform(random, 360.0F, 830.0F);
      v[2 * kFilmWavelengths + k] = uniform(random, 1e-3F, 5e-3F);
    }
  };
  op.run = [film](const KernelTable& k, const Arrays& a) {
    const FilmAccess::State& s = FilmAccess::state(*film);
    kernels::FilmLimits limits = s.limits;
    limits.range = limits.weight_range = std::numeric_limits<float>::max();
    // A block at a time: bands and pairs lie one behind the other.
    for (std::size_t block = 0; block < a.blocks; ++block) {
      const float* radiance[kFilmWavelengths];
      const float* lambda[kFilmWavelengths];
      const float* density[kFilmWavelengths];
      for (std::size_t i = 0; i < kFilmWavelengths; ++i) {
        radiance[i] = a.in(i) + block * kLanes;
        lambda[i] = a.in(kFilmWavelengths + i) + block * kLanes;
        density[i] = a.in(2 * kFilmWavelengths + i) + block * kLanes;
      }
      std::int32_t reasons[kLanes] = {};
      auto* const band = a.out<std::int32_t>() + block * 3 * kFilmWavelengths * kLanes;
      auto* const pairs = a.out() + (block * 3 + 1) * kFilmWavelengths * kLanes;
      k.film_hits({band, pairs, reasons}, {radiance, lambda, density, nullptr, kFilmWavelengths, kLanes},
                  s.buckets, limits, static_cast<float>(kReference));
    }
  };
  op.read_block = [](const std::byte* block, std::size_t lane, double* values) {
    for (std::size_t k = 0; k < kFilmWavelengths; ++k) {
      std::int32_t band = 0;
      std::memcpy(&band, block + (k * kLanes + lane) * sizeof(band), sizeof(band));
      values[k] = static_cast<double>(band);
      float pair[2];
      std::memcpy(pair, block + (kFilmWavelengths * kLanes + 2 * (k * kLanes + lane)) * sizeof(float),
                  sizeof(pair));
      values[kFilmWavelengths + k] = static_cast<double>(pair[0]);
      values[2 * kFilmWavelengths + k] = static_cast<double>(pair[1]);
    }
  };
  op.error = [](const double* in, const double* out, double tiny) {
    double worst = kOutOfDomain;
    for (std::size_t k = 0; k < kFilmWavelengths; ++k) {
      const double radiance = in[k];
      const double lambda = in[kFilmWavelengths + k];
      const double density = in[2 * kFilmWavelengths + k];
      const bool falls = density != 0 && lambda >= 400 && lambda < 700;
      if (out[k] != (falls ? std::floor((lambda - 400) / 5) : -1.0)) return kBeyond;
      worst = std::max(worst, 0.0);
      // Results for refused samples are not specified.
      if (!falls || !std::isfinite(radiance) || !std::isfinite(density) || density < 0) continue;
      const double weight = kReference / density;
      // Beyond float's range, or so small that a rounding is not one in 2^24.
      if (weight > 0x1p126 || weight < 0x1p-100 || std::abs(radiance * weight) > 0x1p126) continue;
      const double off = std::abs(out[kFilmWavelengths + k] - radiance * weight);
      const double value_error =
          std::max(0.0, off - 2 * tiny * std::max(1.0, weight)) / (0x1p-24 * std::abs(radiance * weight));
      if (radiance != 0 && off > 0) worst = std::max(worst, value_error);
      if (radiance == 0 && off != 0) return kBeyond;
      worst = std::max(worst, std::abs(out[2 * kFilmWavelengths + k] - weight) / (0x1p-24 * weight));
    }
    return worst;
  };
  to.push_back(std::move(op));
}

}  // namespace

void add_film_samples(std::vector<Operation>& to, const SharedFilm& film, const SharedFilm& spectral,
                      const Bands& bands) {
  add_places(to, film);
  add_band_quads(to, bands.count());
  add_hits(to, spectral);
}

}  // namespace spectile::measure
