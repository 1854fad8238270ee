// A film's samples on their way to pixels: placed, spread over bands, added up exactly, developed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "src/base/errors.hpp"
#include "src/measure/operation.hpp"
#include "src/ops/film_pixel.hpp"

namespace spectile::measure {
namespace {

using kernels::FilmEntries;
using kernels::KernelTable;
using kernels::kFilmTilePixels;
using kernels::kLanes;

using SharedFilm = std::shared_ptr<const Film>;

constexpr double kBeyond = std::numeric_limits<double>::infinity();
constexpr int kSide = 1024;
constexpr std::size_t kWavelengths = 4;
constexpr std::size_t kPixelLimbs = 8;
/// Bands of the film that hits are added to: few, so that many pixels are in the caches.
constexpr std::size_t kHitBands = 8;

/// A film whose grids and tables the kernels are given; it is never fed.
Result<SharedFilm> film_of(bool spectral) {
  FilmOptions o;
  o.width = o.height = kSide;
  o.spectral = spectral;
  o.statistics = PixelStatistics::kVariance;
  auto made = Film::create(o);
  if (!made) return made.error();
  return std::make_shared<const Film>(*std::move(made));
}

double coarse_step(const Film& film, bool weight) {
  const FilmOptions& o = film.options();
  return std::ldexp(1.0, (weight ? o.weight_range : o.range) - kFilmCoarseBits);
}

/// The steps of limbs that a number came to.
double in_rest_steps(double v, double coarse, double rest, double step) {
  // A contribution less its coarse part is exact in double, and so is what is left.
  return ((v - coarse * step) - rest * std::ldexp(step, -kFilmLimbBits)) / std::ldexp(step, -kFilmLimbBits);
}

const std::int32_t* whole_tile() {
  static const auto addresses = [] {
    std::array<std::int32_t, kFilmTilePixels> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::int32_t>(i);
    return out;
  }();
  return addresses.data();
}

/// What a filter may give, exact in few bits.
const float* filter_weights() {
  static const auto weights = [] {
    std::array<float, kFilmTilePixels> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(1 + i % 61) / 64.0F;
    return out;
  }();
  return weights.data();
}

const std::uint32_t* each_sample() {
  static const auto samples = [] {
    std::array<std::uint32_t, kFilmTilePixels> out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint32_t>(i);
    return out;
  }();
  return samples.data();
}

/// Calls add(first lane, entries, tile) for each tile's worth of lanes; lane i is pixel i of its tile.
template <class Add>
void over_tiles(const Arrays& a, std::size_t limbs, Add add) {
  for (std::size_t first = 0; first < a.n(); first += kFilmTilePixels) {
    std::int64_t* tile = a.out<std::int64_t>() + first * limbs;
    FilmEntries entries;
    entries.address = whole_tile();
    entries.count = std::min(kFilmTilePixels, a.n() - first);
    entries.tile = 0;
    add(first, entries, &tile);
  }
}

Operation sums_operation(std::string name, std::size_t limbs) {
  Operation op;
  op.group = "film";
  op.name = std::move(name);
  op.item = "sample";
  op.in = {1, 4, Element::kQuad};
  op.out = {1, limbs, Element::kLimb};
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

void add_places(std::vector<Operation>& to, const SharedFilm& film) {
  Operation op;
  op.group = "film";
  op.name = "film: place samples";
  op.item = "sample";
  op.in = {3, 1};
  op.out = {1, 1, Element::kInt};
  op.cache_only = true;
  op.unit = "exact";
  // Inside (7), to whole numbers (6), tile (4), pixel (4), address (2), sums of what may be no number (4),
  // weight and reasons (5), extremes (2).
  op.operations = 34;
  op.binds =
      "comparisons into masks and conversions to whole numbers, of which fewer start at once than of "
      "products";
  op.fill = [](Random& random, float* v) {
    v[0] = uniform(random, 0.0F, static_cast<float>(kSide));
    v[1] = uniform(random, 0.0F, static_cast<float>(kSide));
    v[2] = uniform(random, 0.0F, 2.0F);
  };
  op.run = [film](const KernelTable& k, const Arrays& a) {
    thread_local std::vector<std::int32_t> none;
    none.resize(a.n());
    std::int32_t tiles[2] = {std::numeric_limits<std::int32_t>::max(), -1};
    std::uint64_t counts[kernels::kFilmReasons] = {};
    k.film_place(a.out<std::int32_t>(), tiles, counts, FilmAccess::state(*film).kernel_window, a.in(0),
                 a.in(1), a.in(2), none.data(), a.n());
  };
  op.error = [](const double* v, const double* out, double /*tiny*/) {
    const auto any = [&](auto is) { return is(v[0]) || is(v[1]) || is(v[2]); };
    const auto inside = [](double x) { return x >= 0 && x < kSide; };
    double truth = 0;
    if (any([](double x) { return std::isnan(x); })) {
      truth = -kernels::kFilmNan;
    } else if (any([](double x) { return std::isinf(x); })) {
      truth = -kernels::kFilmInfinite;
    } else if (v[2] < 0) {
      truth = -kernels::kFilmNegative;
    } else if (!inside(v[0]) || !inside(v[1])) {
      truth = -kernels::kFilmOutside;
    } else {
      const double x = std::floor(v[0]);
      const double y = std::floor(v[1]);
      const double tile =
          std::floor(y / kFilmTile) * (kSide / static_cast<double>(kFilmTile)) + std::floor(x / kFilmTile);
      truth = tile * kFilmTilePixels + std::fmod(y, kFilmTile) * kFilmTile + std::fmod(x, kFilmTile);
    }
    return out[0] == truth ? 0.0 : kBeyond;
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
  op.binds = "quads of four where vectors are wider: turning four rows into columns";
  op.fill = uniform_values(bands + 1, 0.01F, 1.0F);
  op.run = [=](const KernelTable& k, const Arrays& a) {
    thread_local std::vector<const float*> rows;
    thread_local std::vector<std::int32_t> reasons;
    rows.resize(bands);
    reasons.resize(a.n());
    for (std::size_t b = 0; b < bands; ++b) rows[b] = a.in(b);
    const kernels::FilmLimits limits = {std::numeric_limits<float>::infinity(),
                                        std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
    k.film_band_quads(a.out(), stride, reasons.data(), limits, rows.data(), a.in(bands), bands, a.n());
  };
  op.error = judged_by(
      stride,
      [=](const double* v, double* truth, double* scale) {
        for (std::size_t b = 0; b < bands; ++b) {
          truth[b] = v[b] * v[bands];
          scale[b] = std::abs(truth[b]);
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
  op.in = {3 * kWavelengths, 1};
  op.out = {1, 3 * kWavelengths};
  op.cache_only = true;
  op.bound = 3;
  // A wavelength: inside (5), the bucket (4), a step of the search (3), the band (3), the factor and value
  // (3), what is beyond (6).
  op.operations = kWavelengths * 24;
  op.divisions = kWavelengths;
  op.binds =
      "gathers: of the bucket's edge, of the edge that is compared, of the band; and pairs stored one by one";
  op.fill = [](Random& random, float* v) {
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      v[k] = uniform(random, 0.0F, 2.0F);
      v[kWavelengths + k] = uniform(random, 360.0F, 830.0F);
      v[2 * kWavelengths + k] = uniform(random, 1e-3F, 5e-3F);
    }
  };
  op.run = [film](const KernelTable& k, const Arrays& a) {
    const FilmAccess::State& s = FilmAccess::state(*film);
    kernels::FilmLimits limits = s.limits;
    limits.range = limits.weight_range = std::numeric_limits<float>::max();
    // A block at a time: bands and pairs lie one behind the other.
    for (std::size_t block = 0; block < a.blocks; ++block) {
      const float* radiance[kWavelengths];
      const float* lambda[kWavelengths];
      const float* density[kWavelengths];
      for (std::size_t i = 0; i < kWavelengths; ++i) {
        radiance[i] = a.in(i) + block * kLanes;
        lambda[i] = a.in(kWavelengths + i) + block * kLanes;
        density[i] = a.in(2 * kWavelengths + i) + block * kLanes;
      }
      std::int32_t reasons[kLanes] = {};
      auto* const band = a.out<std::int32_t>() + block * 3 * kWavelengths * kLanes;
      auto* const pairs = a.out() + (block * 3 + 1) * kWavelengths * kLanes;
      k.film_hits(band, pairs, reasons, s.buckets, limits, radiance, lambda, density, nullptr,
                  static_cast<float>(kReference), kWavelengths, kLanes);
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
    double worst = kNotJudged;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      const double radiance = in[k];
      const double lambda = in[kWavelengths + k];
      const double density = in[2 * kWavelengths + k];
      const bool falls = density != 0 && lambda >= 400 && lambda < 700;
      if (out[k] != (falls ? std::floor((lambda - 400) / 5) : -1.0)) return kBeyond;
      worst = std::max(worst, 0.0);
      // What is refused is not specified.
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
  to.push_back(std::move(op));
}

void add_colors(std::vector<Operation>& to, const SharedFilm& film) {
  Operation op = sums_operation("film: add colours", kPixelLimbs);
  op.operations = 4 * kLimbPair;
  op.unit = "of a step of the grid";
  op.bound = 0.5;
  op.run = [film](const KernelTable& k, const Arrays& a) {
    over_tiles(
        a, kPixelLimbs, [&](std::size_t first, const FilmEntries& entries, std::int64_t* const* tiles) {
          k.film_add(tiles, 0, FilmAccess::state(*film).grid, entries, a.in() + 4 * first, 1, kPixelLimbs);
        });
  };
  const auto within = [film](const double* v) {
    // What a film refuses is not specified.
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(std::abs(v[c]) <= std::ldexp(coarse_step(*film, c == 3), kFilmCoarseBits))) return false;
    }
    return true;
  };
  op.error = [=](const double* v, const double* limbs, double tiny) {
    if (!within(v)) return kNotJudged;
    double worst = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const double step = coarse_step(*film, c == 3);
      const double off = std::abs(in_rest_steps(v[c], limbs[c], limbs[4 + c], step));
      worst = std::max(worst, std::max(0.0, off - tiny / std::ldexp(step, -kFilmLimbBits)));
    }
    return worst;
  };
  to.push_back(op);

  // As a filter spreads them: a factor for each pixel reached.
  op.name = "film: add colours with filter weights";
  op.item = "pixel reached";
  op.operations += 4;
  op.binds = "one entry after another, as two may reach the same pixel";
  op.unit = "u and half a step of the grid";
  op.bound = 1;
  op.run = [film](const KernelTable& k, const Arrays& a) {
    over_tiles(a, kPixelLimbs, [&](std::size_t first, FilmEntries entries, std::int64_t* const* tiles) {
      entries.sample = each_sample();
      entries.factor = filter_weights();
      k.film_add(tiles, 0, FilmAccess::state(*film).grid, entries, a.in() + 4 * first, 1, kPixelLimbs);
    });
  };
  op.error = nullptr;
  op.error_at = [=](std::size_t lane, const double* v, const double* limbs, double tiny) {
    if (!within(v)) return kNotJudged;
    const auto factor = static_cast<double>(filter_weights()[lane % kFilmTilePixels]);
    double worst = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const double step = coarse_step(*film, c == 3);
      const double truth = v[c] * factor;
      const double half = 0.5 * std::ldexp(step, -kFilmLimbBits) + tiny;
      const double off =
          std::abs(in_rest_steps(truth, limbs[c], limbs[4 + c], step)) * std::ldexp(step, -kFilmLimbBits);
      if (off > half) worst = std::max(worst, (off - half) / (0x1p-24 * std::abs(truth)));
    }
    return worst;
  };
  to.push_back(std::move(op));
}

void add_hit_sums(std::vector<Operation>& to, const SharedFilm& film) {
  Operation op = sums_operation("film: add 4 wavelengths to their bands", 4 * kHitBands);
  op.in = {kWavelengths, 2, Element::kQuad};
  op.touched_bytes = kWavelengths * 4 * sizeof(std::int64_t);
  // Two numbers a wavelength, times the factor.
  op.operations = kWavelengths * 2 * (1 + kLimbPair);
  op.unit = "of a step of the grid";
  op.bound = 0.5;
  op.binds = "two numbers at a time, as each wavelength goes to a band of its own";
  op.fill = [](Random& random, float* v) {
    for (std::size_t k = 0; k < 2 * kWavelengths; ++k) v[k] = uniform(random, 0.0F, 2.0F);
  };
  const auto band_of = [](std::size_t lane, std::size_t k) { return (lane + 2 * k) % kHitBands; };
  op.run = [=](const KernelTable& k, const Arrays& a) {
    // Rows of pairs are as far apart as the planes, and so are those of bands.
    const std::size_t apart = a.source_plane / (2 * sizeof(float));
    thread_local std::vector<std::int32_t> bands;
    if (bands.size() != apart * kWavelengths) {
      bands.resize(apart * kWavelengths);
      for (std::size_t i = 0; i < bands.size(); ++i) {
        bands[i] = static_cast<std::int32_t>(band_of(i % apart, i / apart));
      }
    }
    over_tiles(a, 4 * kHitBands,
               [&](std::size_t first, const FilmEntries& entries, std::int64_t* const* tiles) {
                 k.film_add_hits(tiles, 0, FilmAccess::state(*film).band_grid, entries, bands.data() + first,
                                 a.in() + 2 * first, kWavelengths, apart, kHitBands);
               });
  };
  op.error_at = [=](std::size_t lane, const double* v, const double* limbs, double tiny) {
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      for (std::size_t c = 0; c < 2; ++c) {
        if (!(std::abs(v[2 * k + c]) <= std::ldexp(coarse_step(*film, c == 1), kFilmCoarseBits)))
          return kNotJudged;
      }
    }
    double worst = 0;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      const double* const of_band = limbs + 4 * band_of(lane, k);
      for (std::size_t c = 0; c < 2; ++c) {
        const double step = coarse_step(*film, c == 1);
        const double off = std::abs(in_rest_steps(v[2 * k + c], of_band[c], of_band[2 + c], step));
        worst = std::max(worst, std::max(0.0, off - tiny / std::ldexp(step, -kFilmLimbBits)));
      }
    }
    return worst;
  };
  to.push_back(std::move(op));
}

void add_moments(std::vector<Operation>& to, const SharedFilm& film) {
  Operation op = sums_operation("film: add moments", kPixelLimbs);
  op.operations = 2 * (4 + 7 * 5 + 1);
  op.divisions = 2;
  op.unit = "2^-53";
  op.bound = 2.01;
  op.binds = "one sample after another: seven limbs in scalar doubles, each of what the one before left";
  op.run = [film](const KernelTable& k, const Arrays& a) {
    over_tiles(
        a, kPixelLimbs, [&](std::size_t first, const FilmEntries& entries, std::int64_t* const* tiles) {
          k.film_add_moments(tiles, 0, FilmAccess::state(*film).moment_grid, entries, a.in() + 4 * first);
        });
  };
  op.error = [film](const double* v, const double* limbs, double tiny) {
    const FilmOptions& o = film->options();
    const long double y = v[1];
    const long double w = v[3];
    const long double square = w == 0 ? 0 : y * y / w;
    const int top = 2 * o.range + o.weight_range;
    if (!(std::abs(y) <= std::ldexp(1.0L, o.range)) || !(w >= 0 && w <= std::ldexp(1.0L, o.weight_range)) ||
        !(square <= std::ldexp(1.0L, top))) {
      return kNotJudged;
    }
    const auto sum = [](const double* limb, std::size_t count, const std::size_t* at, int exponent) {
      long double out = 0;
      for (std::size_t k = 0; k < count; ++k) {
        out += static_cast<long double>(limb[at[k]]) *
               std::ldexp(1.0L, exponent - kFilmCoarseBits - static_cast<int>(k) * kFilmLimbBits);
      }
      return out;
    };
    constexpr std::size_t kSquares[] = {0, 1, 2, 3};
    constexpr std::size_t kWeights[] = {4, 5, 7};
    const auto error = [&](long double found, long double truth, int exponent, int limbs_in_it) {
      const long double half =
          std::ldexp(0.5L, exponent - kFilmCoarseBits - (limbs_in_it - 1) * kFilmLimbBits);
      const long double off = std::abs(found - truth) - half - tiny;
      return off > 0 ? static_cast<double>(off / (0x1p-53L * truth)) : 0.0;
    };
    if (limbs[6] != 1) return kBeyond;
    return std::max(error(sum(limbs, 4, kSquares, top), square, top, 4),
                    error(sum(limbs, 3, kWeights, 2 * o.weight_range), w * w, 2 * o.weight_range, 3));
  };
  to.push_back(std::move(op));
}

void add_counts(std::vector<Operation>& to) {
  Operation op = sums_operation("film: count samples", 1);
  op.in = {1, 1, Element::kInt};  // stands for the address that is read
  op.fill = uniform_values(1, 0.0F, 1.0F);
  op.operations = 1;
  op.unit = "exact";
  op.binds = "one address after another, as two may be of the same pixel";
  op.run = [](const KernelTable& k, const Arrays& a) {
    over_tiles(a, 1, [&](std::size_t, const FilmEntries& entries, std::int64_t* const* tiles) {
      k.film_count(tiles, 0, entries);
    });
  };
  op.error = [](const double*, const double* out, double) { return out[0] == 1 ? 0.0 : kBeyond; };
  to.push_back(std::move(op));
}

void add_development(std::vector<Operation>& to, const SharedFilm& film) {
  Operation op;
  op.group = "film";
  op.name = "film: develop XYZ";
  op.item = "pixel";
  op.in = {1, kPixelLimbs, Element::kLimb};
  op.out = {3, 1};
  op.cache_only = true;  // tile by tile, under its lock
  op.bound = 1.001;
  // In double: four sums of two limbs, carried over (4), widened, scaled and added (5), three rounded.
  op.operations = 2 * (4 * 9 + 3);
  op.divisions = 2 * 3;
  op.binds =
      "one pixel after another, in scalar doubles: eight limbs carried over and widened, three quotients";
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
  op.error = judged_by(
      3,
      [film](const double* limbs, double* truth, double* scale) {
        const auto sum = [&](std::size_t c, double step) {
          // What a rest holds beyond half a coarse step belongs to the coarse limb.
          const double over = std::nearbyint(std::ldexp(limbs[4 + c], -kFilmLimbBits));
          const long double rest = static_cast<long double>(limbs[4 + c]) -
                                   std::ldexp(static_cast<long double>(over), kFilmLimbBits);
          const long double coarse = static_cast<long double>(limbs[c]) + over;
          return (coarse + std::ldexp(rest, -kFilmLimbBits)) * step;
        };
        const long double weight = sum(3, coarse_step(*film, true));
        for (std::size_t c = 0; c < 3; ++c) {
          truth[c] = weight == 0 ? 0.0 : static_cast<double>(sum(c, coarse_step(*film, false)) / weight);
          scale[c] = std::abs(truth[c]);
        }
      },
      1, true, op.bound);
  to.push_back(std::move(op));
}

}  // namespace

Result<void> add_film_sums(std::vector<Operation>& to, const Bands& bands) {
  const auto film = film_of(false);
  if (!film) return film.error();
  const auto spectral = film_of(true);
  if (!spectral) return spectral.error();
  add_places(to, *film);
  add_band_quads(to, bands.count());
  add_hits(to, *spectral);
  add_colors(to, *film);
  add_hit_sums(to, *spectral);
  add_moments(to, *film);
  add_counts(to);
  add_development(to, *film);
  return {};
}

}  // namespace spectile::measure
