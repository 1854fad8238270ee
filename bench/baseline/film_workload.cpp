// Samples for films: where they go, in which order, and the exact values of the pixels that they make.
#include "bench/baseline/film_workload.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <spectile/color/sensor.hpp>

#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

/// Offsets within a pixel stop short of the next one, whatever float makes of the sum.
constexpr float kMaxOffset = 0.999F;

/// Adds positions with offsets of a fixed seed.
class Jitter {
 public:
  void add(ArrivalOrder& order, int column, int row) {
    order.x.push_back(static_cast<float>(column) + offset_(engine_));
    order.y.push_back(static_cast<float>(row) + offset_(engine_));
  }

 private:
  std::mt19937 engine_{1};
  std::uniform_real_distribution<float> offset_{0.0F, kMaxOffset};
};

std::size_t pixel_number(const ArrivalOrder& order, std::size_t i) {
  return static_cast<std::size_t>(order.y[i]) * static_cast<std::size_t>(order.width) +
         static_cast<std::size_t>(order.x[i]);
}

using BucketValue = std::function<double(int x, int y, std::size_t bucket)>;

/// Largest relative error of means. `sums`: numbers and their weights, [pixel][bucket].
double worst_mean(const std::vector<std::pair<double, double>>& sums, std::size_t width, std::size_t buckets,
                  const BucketValue& value) {
  double worst = 0;
  for (std::size_t at = 0; at < sums.size(); ++at) {
    const auto [sum, weights] = sums[at];
    if (weights == 0) continue;
    const std::size_t pixel = at / buckets;
    const double found =
        value(static_cast<int>(pixel % width), static_cast<int>(pixel / width), at % buckets);
    worst = std::max(worst, std::abs(found * weights / sum - 1));
  }
  return worst;
}

}  // namespace

ArrivalOrder by_tile(int width, int height, std::size_t per_visit, std::size_t visits,
                     std::size_t max_samples) {
  ArrivalOrder out{"tile, " + std::to_string(per_visit) + " a visit", width, height, per_visit, {}, {}};
  Jitter jitter;
  for (std::size_t visit = 0; visit < visits; ++visit) {
    for (int ty = 0; ty < height; ty += kFilmTile) {
      for (int tx = 0; tx < width; tx += kFilmTile) {
        for (std::size_t s = 0; s < per_visit; ++s) {
          for (int row = ty; row < std::min(height, ty + kFilmTile); ++row) {
            for (int column = tx; column < std::min(width, tx + kFilmTile); ++column) {
              if (out.size() < max_samples) jitter.add(out, column, row);
            }
          }
        }
      }
    }
  }
  return out;
}

ArrivalOrder by_scanline(int width, int height, std::size_t passes) {
  ArrivalOrder out{"scanline", width, height, 1, {}, {}};
  Jitter jitter;
  for (std::size_t pass = 0; pass < passes; ++pass) {
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) jitter.add(out, column, row);
    }
  }
  return out;
}

ArrivalOrder at_random(const ArrivalOrder& order) {
  ArrivalOrder out = order;
  out.name = "random";
  out.per_visit = 1;
  std::mt19937_64 engine(2);
  for (std::size_t i = out.size() - 1; i > 0; --i) {
    const std::size_t j = engine() % (i + 1);
    std::swap(out.x[i], out.x[j]);
    std::swap(out.y[i], out.y[j]);
  }
  return out;
}

Result<SamplePool> make_sample_pool(std::uint64_t seed) {
  SPECTILE_ASSIGN(const auto sensor, Sensor::named("cie1931"));
  const auto luminance_at = [&](double nm, double radiance, double density) {
    return sensor.factors()[1] * sensor.curves()[1](nm) * radiance / density / kPoolWavelengths;
  };
  // Rows a power of two apart would share few sets of the caches.
  constexpr std::size_t kApart = 16;
  SamplePool out;
  out.stride = kSamplePool + kApart;
  for (auto* const row : {&out.radiance, &out.lambda_nm, &out.density})
    row->resize(kPoolWavelengths * out.stride);
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<float> unit(0.0F, kMaxOffset);
  for (std::size_t i = 0; i < kSamplePool; ++i) out.u.push_back(unit(engine));
  std::vector<float> drawn(2 * kPoolWavelengths * kSamplePool);
  aos_baseline().draw_visible({}, out.u.data(), drawn.data(), kSamplePool);
  // The density 1/cosh^2(a (lambda - centre)) over 360 to 830 nm: Radziszewski, Boryczko, Alda, An Improved
  // Technique for Full Spectral Rendering, Journal of WSCG 17, 2009.
  constexpr double kSteepness = 0.0072;
  constexpr double kCentreNm = 538;
  const double end = std::tanh(kSteepness * (kCentreNm - kFirstVisibleNm));
  const double range = end + std::tanh(kSteepness * (kLastVisibleNm - kCentreNm));
  for (std::size_t i = 0; i < kSamplePool; ++i) {
    AosFilmSample sample{};
    sample.weight = 1;
    double luminance = 0;
    double exactly_drawn = 0;
    for (std::size_t k = 0; k < kPoolWavelengths; ++k) {
      const float* const wavelengths = &drawn[2 * kPoolWavelengths * i];
      const std::size_t at = k * out.stride + i;
      sample.radiance[k] = out.radiance[at] = 0.1F + unit(engine);
      sample.lambda_nm[k] = out.lambda_nm[at] = wavelengths[k];
      sample.density[k] = out.density[at] = wavelengths[kPoolWavelengths + k];
      const auto radiance = static_cast<double>(sample.radiance[k]);
      luminance += luminance_at(static_cast<double>(sample.lambda_nm[k]), radiance,
                                static_cast<double>(sample.density[k]));
      float up = out.u[i] + static_cast<float>(k) / kPoolWavelengths;
      if (up >= 1) up -= 1;
      const double tangent = end - static_cast<double>(up) * range;
      exactly_drawn += luminance_at(kCentreNm - std::atanh(tangent) / kSteepness, radiance,
                                    kSteepness * (1 - tangent * tangent) / range);
    }
    out.samples.push_back(sample);
    out.luminance.push_back(luminance);
    out.drawn_luminance.push_back(exactly_drawn);
  }
  return out;
}

double luminance_error(const ArrivalOrder& order, const std::vector<double>& luminance,
                       const PixelValue& value) {
  std::vector<std::pair<double, double>> sums(static_cast<std::size_t>(order.width) *
                                              static_cast<std::size_t>(order.height));
  for (std::size_t i = 0; i < order.size(); ++i) {
    auto& [sum, count] = sums[pixel_number(order, i)];
    sum += luminance[i % kSamplePool];
    count += 1;
  }
  return worst_mean(sums, static_cast<std::size_t>(order.width), 1,
                    [&](int x, int y, std::size_t) { return value(x, y); });
}

double bucket_error(const ArrivalOrder& order, const SamplePool& pool, const Bands& bands, bool by_density,
                    const BucketValue& value) {
  const auto width = static_cast<std::size_t>(order.width);
  const std::size_t buckets = bands.count();
  const std::size_t pixels = width * kFilmTile;
  const double first_nm = bands.list().front().lower_nm;
  const double width_nm = (bands.list().back().upper_nm - first_nm) / static_cast<double>(buckets);
  std::vector<std::pair<double, double>> sums(pixels * buckets);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t pixel = pixel_number(order, i);
    if (pixel >= pixels) continue;
    const AosFilmSample& s = pool.samples[i % kSamplePool];
    for (std::size_t k = 0; k < kPoolWavelengths; ++k) {
      const double at = std::floor((static_cast<double>(s.lambda_nm[k]) - first_nm) / width_nm);
      if (at < 0 || at >= static_cast<double>(buckets)) continue;
      const double weight = by_density ? 1 / static_cast<double>(s.density[k]) : 1.0;
      auto& [sum, weights] = sums[pixel * buckets + static_cast<std::size_t>(at)];
      sum += weight * static_cast<double>(s.radiance[k]);
      weights += weight;
    }
  }
  return worst_mean(sums, width, buckets, value);
}

}  // namespace spectile::measure
