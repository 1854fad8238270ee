// FilmPixels: the numbers that a pixel's limbs hold.
#pragma once

#include <cmath>
#include <limits>

#include "src/film/state.hpp"

namespace spectile {

/// Numbers from limbs, in double.
class FilmPixels {
 public:
  explicit FilmPixels(const FilmAccess::State& s)
      : s_(s),
        color_(std::ldexp(1.0, s.options.range - kFilmCoarseBits)),
        weight_(std::ldexp(1.0, s.options.weight_range - kFilmCoarseBits)),
        luminance_square_(std::ldexp(1.0, 2 * s.options.range + s.options.weight_range - kFilmCoarseBits)),
        weight_square_(std::ldexp(1.0, 2 * s.options.weight_range - kFilmCoarseBits)) {}

  /// Sum of the weights.
  double weight(const std::int64_t* tile, std::size_t pixel) const {
    const std::int64_t* const q = quad(tile, pixel, 0);
    return sum(q[kernels::kFilmQuadWeight], q[kernels::kFilmQuadWeight + kernels::kFilmQuadRest], weight_);
  }
  /// Sum of a component of a colour's contributions.
  double color(const std::int64_t* tile, std::size_t pixel, std::size_t quad_index, std::size_t c) const {
    const std::int64_t* const q = quad(tile, pixel, quad_index);
    return sum(q[c], q[kernels::kFilmQuadRest + c], color_);
  }

  /// Writes a layer's value of a pixel to each plane.
  void develop(FilmLayer layer, std::size_t sensor, const std::int64_t* tile, std::size_t pixel, float* to,
               std::size_t plane_floats) const {
    const double w = weight(tile, pixel);
    const auto mean = [&](std::size_t quad_index, std::size_t c) {
      return w == 0 ? 0.0 : color(tile, pixel, quad_index, c) / w;
    };
    switch (layer) {
      case FilmLayer::kXyz:
        for (std::size_t c = 0; c < 3; ++c) to[c * plane_floats] = static_cast<float>(mean(0, c));
        break;
      case FilmLayer::kSrgb: {
        const double xyz[3] = {mean(0, 0), mean(0, 1), mean(0, 2)};
        const Matrix3& m = xyz_to_srgb_matrix();
        for (std::size_t c = 0; c < 3; ++c) {
          to[c * plane_floats] =
              static_cast<float>(m[3 * c] * xyz[0] + m[3 * c + 1] * xyz[1] + m[3 * c + 2] * xyz[2]);
        }
        break;
      }
      case FilmLayer::kLuminance:
        *to = static_cast<float>(mean(0, 1));
        break;
      case FilmLayer::kSensor:
        for (std::size_t c = 0; c < 3; ++c) {
          to[c * plane_floats] = static_cast<float>(mean(sensor + (s_.options.xyz ? 1 : 0), c));
        }
        break;
      case FilmLayer::kSpectrum:
        for (std::size_t b = 0; b < s_.layout.bands; ++b) {
          to[b * plane_floats] = static_cast<float>(band(tile, pixel, b, w));
        }
        break;
      case FilmLayer::kWeight:
        *to = static_cast<float>(w);
        break;
      case FilmLayer::kCount:
        *to = static_cast<float>(count(tile, pixel));
        break;
      case FilmLayer::kVariance:
        *to = static_cast<float>(variance(tile, pixel, w));
        break;
    }
  }

 private:
  const std::int64_t* quad(const std::int64_t* tile, std::size_t pixel, std::size_t index) const {
    return tile + kernels::kFilmQuadLimbs * (pixel * s_.layout.quads + index);
  }
  /// Carried over first, so that equal sums are equal numbers whether or not the tile's carries are
  /// normalized.
  static double sum(std::int64_t coarse, std::int64_t rest, double coarse_step) {
    film_carry(coarse, rest);
    // Exact: steps of limbs are powers of two far inside double's range.
    constexpr double kRestOfCoarse = 1.0 / static_cast<double>(std::int64_t{1} << kFilmLimbBits);
    return static_cast<double>(coarse) * coarse_step +
           static_cast<double>(rest) * (coarse_step * kRestOfCoarse);
  }
  /// Of limbs of ever smaller steps, carried over first.
  template <std::size_t kCount>
  static double sum(std::array<std::int64_t, kCount> limbs, double first_step) {
    for (std::size_t k = kCount - 1; k > 0; --k) film_carry(limbs[k - 1], limbs[k]);
    double out = 0;
    for (std::size_t k = kCount; k-- > 0;) {
      out += static_cast<double>(limbs[k]) * std::ldexp(first_step, -static_cast<int>(k) * kFilmLimbBits);
    }
    return out;
  }
  double band(const std::int64_t* tile, std::size_t pixel, std::size_t b, double w) const {
    const std::int64_t* const spectrum = tile + s_.layout.spectrum_at + pixel * s_.layout.spectrum_limbs();
    if (s_.layout.own_weights) {
      const std::int64_t* const limbs = spectrum + kernels::kFilmHitLimbs * b;
      const double hits = sum(limbs[kernels::kFilmHitWeight],
                              limbs[kernels::kFilmHitWeight + kernels::kFilmHitRest], weight_);
      return hits == 0 ? 0.0 : sum(limbs[0], limbs[kernels::kFilmHitRest], color_) / hits;
    }
    const std::int64_t* const limbs = spectrum + kernels::kFilmQuadLimbs * (b / 4) + b % 4;
    return w == 0 ? 0.0 : sum(limbs[0], limbs[kernels::kFilmQuadRest], color_) / w;
  }
  std::int64_t count(const std::int64_t* tile, std::size_t pixel) const {
    return s_.layout.moments ? moments(tile, pixel)[kernels::kFilmMomentCount]
                             : tile[s_.layout.counts_at + pixel];
  }
  const std::int64_t* moments(const std::int64_t* tile, std::size_t pixel) const {
    return tile + s_.layout.moments_at + kernels::kFilmMomentLimbs * pixel;
  }
  /// Of the pixel's luminance, from samples of different weights: with r = sum w^2 / (sum w)^2, the samples'
  /// variance is (mean of squares - square of mean) / (1 - r), and that of their mean r times that.
  double variance(const std::int64_t* tile, std::size_t pixel, double w) const {
    const std::int64_t* const m = moments(tile, pixel);
    if (m[kernels::kFilmMomentCount] < 2 || w == 0) return std::numeric_limits<double>::infinity();
    const double squares = sum(std::array{m[0], m[1], m[2], m[3]}, luminance_square_);
    const double weight_squares =
        sum(std::array{m[kernels::kFilmWeightSquare[0]], m[kernels::kFilmWeightSquare[1]],
                       m[kernels::kFilmWeightSquare[2]]},
            weight_square_);
    const double share = weight_squares / (w * w);
    if (!(share < 1)) return std::numeric_limits<double>::infinity();
    const double mean = color(tile, pixel, 0, 1) / w;
    const double spread = squares / w - mean * mean;
    return spread > 0 ? spread * share / (1 - share) : 0.0;
  }

  const FilmAccess::State& s_;
  double color_, weight_, luminance_square_, weight_square_;
};

}  // namespace spectile
