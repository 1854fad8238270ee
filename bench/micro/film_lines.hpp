// The films that are measured against one another, and what they share.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <spectile/spectile.hpp>
#include <string>
#include <vector>

#include "bench/micro/film_workload.hpp"
#include "bench/micro/plain_film.hpp"
#include "bench/micro/report.hpp"

namespace bench {

/// One way of adding samples, in one order.
struct Line {
  std::string name;  ///< of the way
  std::string order;
  double samples = 0;  ///< a pass
  std::size_t bytes_per_pixel = 0;
  double bytes = 0;             ///< that a sample moves to and from memory: its position and its pixel
  std::function<void()> fresh;  ///< makes the film anew, nothing of it touched
  std::function<void()> pass;
  std::function<double()> error;  ///< of what one pass or more have left
  std::string full_name() const { return name + ", " + order; }
};

inline constexpr int kWidth = 1920;
inline constexpr int kHeight = 1080;
// 60 buckets take 1984 bytes a pixel: a ninth of the pixels, with nine times the samples each.
inline constexpr int kBucketWidth = 640;
inline constexpr int kBucketHeight = 360;
inline constexpr std::size_t kSamples = std::size_t{4} * kWidth * kHeight;
inline constexpr std::size_t kBatch = kPool;
inline constexpr std::size_t kLargeBatch = 65536;
inline constexpr std::size_t kSmallBatch = 512;

/// Calls f(first sample, pool sample, samples) for each batch of a part of an order.
template <class F>
void batches(std::size_t first, std::size_t end, std::size_t batch, const F& f) {
  for (std::size_t i = first; i < end; i += batch) f(i, i % kPool, std::min(batch, end - i));
}

/// Orders and pools, and one film of each kind: lines of a kind use it in turn.
struct Bench {
  Order tile1 = tile_order(kWidth, kHeight, 1, 4);
  Order tile4 = tile_order(kWidth, kHeight, 4, 1);
  Order tile16 = tile_order(kWidth, kHeight, 16, 1, kSamples);
  Order quarter = tile_order(kWidth, kHeight, 4, 1, kSamples / 4);
  Order scanline = scanline_order(kWidth, kHeight, 4);
  Order random = random_order(tile4);
  Order bucket_tile = tile_order(kBucketWidth, kBucketHeight, 4, 9);
  Order bucket_random = random_order(bucket_tile);
  Pool pool = make_pool();
  Pool large_pool = make_pool(kLargeBatch);
  BandPool bands = make_band_pool();
  spectile::PixelFilter mitchell = report::need(spectile::PixelFilter::mitchell());
  spectile::ScalarLanes u = report::need(spectile::ScalarLanes::create(kPool));
  spectile::SampledWavelengths drawn =
      report::need(spectile::SampledWavelengths::create(kPool, kWavelengths));
  std::unique_ptr<spectile::Film> color, variance, splat, band_input, buckets;
  std::unique_ptr<PlainFilm> plain;
  std::unique_ptr<spectile::Film> like;  ///< what the plain film takes its tables from
  textbook::Film text;
  textbook::BucketFilm text_buckets;

  Bench() { std::copy_n(pool.u.begin(), kPool, u.span().data); }
};

Bench& bench();

/// A line without its functions. `lines`: cache lines that a sample touches on its own.
Line line_of(std::string name, const Order& order, std::size_t bytes_per_pixel, std::size_t lines = 1);

spectile::FilmOptions options_of(int width, int height);

/// A batch of n samples from sample i and pool sample `at` on.
spectile::WavelengthSamples samples_of(const Order& order, const Pool& pool, std::size_t i, std::size_t at,
                                       std::size_t n);

/// The textbook's films, and ordinary sums.
void add_baselines(std::vector<Line>& lines);
/// Film.
void add_films(std::vector<Line>& lines);

}  // namespace bench
