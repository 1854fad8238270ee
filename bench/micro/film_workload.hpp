// What films are fed with in their benchmark, and what then ought to be in them.
#pragma once

#include <functional>
#include <spectile/film/film.hpp>
#include <string>
#include <vector>

#include "bench/micro/textbook_film.hpp"

namespace bench {

/// Where samples go, in the order they come in.
struct Order {
  std::string name;
  int width = 0;
  int height = 0;
  std::size_t per_visit = 1;  ///< samples that a pixel gets while its tile is in the caches
  std::vector<float> x, y;
  std::size_t size() const { return x.size(); }
};

/// Tile by tile, `per_visit` samples a pixel at each of `visits`; of the first tiles only, where `most`
/// samples are fewer than that.
Order tile_order(int width, int height, std::size_t per_visit, std::size_t visits,
                 std::size_t most = static_cast<std::size_t>(-1));
/// Whole passes over the film, row by row.
Order scanline_order(int width, int height, std::size_t passes);
/// The samples of another order, shuffled.
Order random_order(const Order& of);

/// Samples that are fed again and again: sample i of an order has the radiance of pool sample i modulo kPool,
/// so that what the samples carry stays in the second-level cache and only positions come from memory.
inline constexpr std::size_t kPool = 4096;
inline constexpr std::size_t kWavelengths = 4;
struct Pool {
  std::size_t stride = 0;                           ///< floats from row to row
  std::vector<float> radiance, lambda_nm, density;  ///< [kWavelengths][stride]
  std::vector<float> u;                             ///< [stride], where wavelengths are drawn
  std::vector<textbook::FilmSample> textbook;       ///< [kPool]
  std::vector<double> luminance;                    ///< exact, [kPool]
  std::vector<double> drawn_luminance;              ///< exact, with the wavelengths that u stands for
};
/// `samples`: a multiple of kPool, over which its samples repeat.
Pool make_pool(std::size_t samples = kPool);

/// Radiance on bands, and its exact luminance under the bands' weights. Shapes: [band][kPool], [kPool].
struct BandPool {
  spectile::Bands bands;
  std::vector<float> radiance;
  std::vector<double> luminance;
};
BandPool make_band_pool();

/// The textbook's film without pixels' contents.
textbook::Film make_textbook_film(int width, int height);

/// A developed number of a pixel.
using PixelValue = std::function<double(int x, int y)>;

/// Largest error of pixels' luminance relative to the mean, in double, of the samples in each.
double worst_error(const Order& order, const std::vector<double>& luminance, const PixelValue& developed);
/// The same for samples splatted with a filter. Pixels at the edge of what samples reach do not count.
double worst_splat_error(const Order& order, const std::vector<double>& luminance,
                         const spectile::PixelFilter& filter, const PixelValue& developed);
/// The same for buckets of even width, of which a pixel's value is a mean of radiance; `by_density`: weighed
/// with one over the density. Of the first rows of pixels alone.
double worst_bucket_error(const Order& order, const Pool& pool, const spectile::Bands& bands, bool by_density,
                          const std::function<double(int x, int y, std::size_t bucket)>& developed);

}  // namespace bench
