// Samples for films: where they go, in which order, and the exact values of the pixels that they make.
#pragma once

#include <functional>
#include <spectile/film/film.hpp>
#include <string>
#include <vector>

#include "bench/baseline/aos_baseline.hpp"

namespace spectile::measure {

/// Positions of samples in the order of their arrival.
struct ArrivalOrder {
  std::string name;
  int width = 0;
  int height = 0;
  std::size_t per_visit = 1;  ///< samples that a pixel gets while its tile is in the caches
  std::vector<float> x, y;
  std::size_t size() const noexcept { return x.size(); }
};

/// Tile by tile, per_visit samples a pixel at each of the visits; at most so many samples.
ArrivalOrder by_tile(int width, int height, std::size_t per_visit, std::size_t visits,
                     std::size_t max_samples);
/// The whole film row by row, pass after pass.
ArrivalOrder by_scanline(int width, int height, std::size_t passes);
/// The samples of another order, shuffled.
ArrivalOrder at_random(const ArrivalOrder& order);

/// Sample i of an order carries pool sample i modulo kSamplePool, so that radiance stays in the second-level
/// cache and only positions come from memory.
inline constexpr std::size_t kSamplePool = 4096;
inline constexpr std::size_t kPoolWavelengths = 4;
/// Shapes: rows [kPoolWavelengths][stride]; the others [kSamplePool].
struct SamplePool {
  std::size_t stride = 0;
  std::vector<float> radiance, lambda_nm, density;
  std::vector<float> u;  ///< from which wavelengths are drawn
  std::vector<AosFilmSample> samples;
  std::vector<double> luminance;        ///< exact
  std::vector<double> drawn_luminance;  ///< exact, with the wavelengths that u stands for
};
/// Errors: as Sensor::named().
Result<SamplePool> make_sample_pool(std::uint64_t seed);

using PixelValue = std::function<double(int x, int y)>;

/// Largest relative error of pixels' luminance, against the means of their samples in double.
double luminance_error(const ArrivalOrder& order, const std::vector<double>& luminance,
                       const PixelValue& value);
/// The same for buckets of even width over the bands' range: means of radiance, weighted with one over the
/// density where `by_density`. Of the first rows of pixels alone.
double bucket_error(const ArrivalOrder& order, const SamplePool& pool, const Bands& bands, bool by_density,
                    const std::function<double(int x, int y, std::size_t bucket)>& value);

}  // namespace spectile::measure
