// What films are fed with in their benchmark, and what then ought to be in them.
#include "bench/micro/film_workload.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <spectile/spectile.hpp>

#include "bench/micro/report.hpp"

namespace bench {
namespace {

using report::need;
using spectile::Sensor;

/// Offsets within a pixel stop short of the next one, whatever float makes of the sum.
constexpr float kMaxOffset = 0.999F;

/// Positions of fixed seed.
class Jitter {
 public:
  void put(Order& order, int column, int row) {
    order.x.push_back(static_cast<float>(column) + offset_(engine_));
    order.y.push_back(static_cast<float>(row) + offset_(engine_));
  }

 private:
  std::mt19937 engine_{1};
  std::uniform_real_distribution<float> offset_{0.0F, kMaxOffset};
};

/// Luminance of one sample, all in double, curves linear between nanometres.
class Exact {
 public:
  double operator()(double nm, double radiance, double density) const {
    return sensor_.factors()[1] * sensor_.curves()[1](nm) * radiance / density / kWavelengths;
  }

 private:
  Sensor sensor_ = need(Sensor::named("cie1931"));
};

// Density 1/cosh^2(steepness (lambda - centre)) over 360 to 830 nm: Radziszewski, Boryczko, Alda, An Improved
// Technique for Full Spectral Rendering, Journal of WSCG 17, 2009.
constexpr double kSteepness = 0.0072;
constexpr double kCentreNm = 538;

}  // namespace

Order tile_order(int width, int height, std::size_t per_visit, std::size_t visits, std::size_t most) {
  Order out{"tile, " + std::to_string(per_visit) + " a visit", width, height, per_visit, {}, {}};
  const std::size_t all =
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * per_visit * visits;
  out.x.reserve(std::min(most, all));
  out.y.reserve(std::min(most, all));
  Jitter jitter;
  for (std::size_t visit = 0; visit < visits; ++visit) {
    for (int ty = 0; ty < height; ty += spectile::kFilmTile) {
      for (int tx = 0; tx < width; tx += spectile::kFilmTile) {
        for (std::size_t s = 0; s < per_visit; ++s) {
          for (int row = ty; row < std::min(height, ty + spectile::kFilmTile); ++row) {
            for (int column = tx; column < std::min(width, tx + spectile::kFilmTile); ++column) {
              if (out.size() < most) jitter.put(out, column, row);
            }
          }
        }
      }
    }
  }
  return out;
}

Order scanline_order(int width, int height, std::size_t passes) {
  Order out{"scanline", width, height, 1, {}, {}};
  Jitter jitter;
  for (std::size_t pass = 0; pass < passes; ++pass) {
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) jitter.put(out, column, row);
    }
  }
  return out;
}

Order random_order(const Order& of) {
  Order out = of;
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

Pool make_pool(std::size_t samples) {
  // Rows a power of two apart would share few sets of the caches.
  constexpr std::size_t kApart = 16;
  const std::size_t stride = samples + kApart;
  Pool out;
  out.stride = stride;
  for (auto* const row : {&out.radiance, &out.lambda_nm, &out.density}) row->resize(kWavelengths * stride);
  out.u.resize(stride);
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> unit(0.0F, kMaxOffset);
  const Exact exact;
  const double end = std::tanh(kSteepness * (kCentreNm - spectile::kFirstVisibleNm));
  const double by = end + std::tanh(kSteepness * (spectile::kLastVisibleNm - kCentreNm));
  for (std::size_t i = 0; i < kPool; ++i) {
    const float u = unit(engine);
    textbook::FilmSample sample{};
    sample.weight = 1;
    double luminance = 0;
    double drawn = 0;
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      float up = u + static_cast<float>(k) / kWavelengths;
      if (up >= 1) up -= 1;
      const float radiance = 0.1F + unit(engine);
      const float nm = textbook::draw_visible(up);
      const float density = textbook::visible_density(nm);
      sample.radiance[k] = radiance;
      sample.lambda_nm[k] = nm;
      sample.density[k] = density;
      luminance += exact(nm, radiance, density);
      const double tanh = end - up * by;
      drawn +=
          exact(kCentreNm - std::atanh(tanh) / kSteepness, radiance, kSteepness * (1 - tanh * tanh) / by);
      for (std::size_t at = k * stride + i; at < (k + 1) * stride; at += kPool) {
        out.radiance[at] = radiance;
        out.lambda_nm[at] = nm;
        out.density[at] = density;
      }
    }
    for (std::size_t at = i; at < stride; at += kPool) out.u[at] = u;
    out.textbook.push_back(sample);
    out.luminance.push_back(luminance);
    out.drawn_luminance.push_back(drawn);
  }
  return out;
}

BandPool make_band_pool() {
  BandPool out;
  const std::size_t bands = out.bands.count();
  const auto projector = need(spectile::Projector::emissive(out.bands));
  out.radiance.resize(bands * kPool);
  out.luminance.resize(kPool);
  std::mt19937 engine(4);
  std::uniform_real_distribution<float> unit(0.1F, 1.1F);
  for (std::size_t b = 0; b < bands; ++b) {
    for (std::size_t i = 0; i < kPool; ++i) {
      const float radiance = unit(engine);
      out.radiance[b * kPool + i] = radiance;
      out.luminance[i] += projector.weights()[b][1] * static_cast<double>(radiance);
    }
  }
  return out;
}

textbook::Film make_textbook_film(int width, int height) {
  textbook::Film out;
  out.width = width;
  out.height = height;
  out.maximum_component = std::numeric_limits<float>::infinity();
  const Sensor sensor = need(Sensor::named("cie1931"));
  constexpr int kFirst = static_cast<int>(spectile::kFirstVisibleNm);
  constexpr int kLast = static_cast<int>(spectile::kLastVisibleNm);
  for (std::size_t c = 0; c < 3; ++c) {
    out.curves[c].first_nm = kFirst;
    for (int nm = kFirst; nm <= kLast; ++nm) {
      out.curves[c].values.push_back(static_cast<float>(sensor.factors()[c] * sensor.curves()[c](nm)));
    }
  }
  out.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  return out;
}

double worst_error(const Order& order, const std::vector<double>& luminance, const PixelValue& developed) {
  struct Sum {
    double y = 0;
    double count = 0;
  };
  const auto width = static_cast<std::size_t>(order.width);
  std::vector<Sum> sums(width * static_cast<std::size_t>(order.height));
  for (std::size_t i = 0; i < order.size(); ++i) {
    Sum& sum = sums[static_cast<std::size_t>(order.y[i]) * width + static_cast<std::size_t>(order.x[i])];
    sum.y += luminance[i % kPool];
    sum.count += 1;
  }
  double worst = 0;
  for (std::size_t p = 0; p < sums.size(); ++p) {
    if (sums[p].count == 0) continue;
    const double truth = sums[p].y / sums[p].count;
    const double value = developed(static_cast<int>(p % width), static_cast<int>(p / width));
    worst = std::max(worst, std::abs(value - truth) / truth);
  }
  return worst;
}

double worst_splat_error(const Order& order, const std::vector<double>& luminance,
                         const spectile::PixelFilter& filter, const PixelValue& developed) {
  const auto width = static_cast<std::size_t>(order.width);
  std::vector<double> sums(width * static_cast<std::size_t>(order.height));
  std::vector<double> weights(sums.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double x = order.x[i];
    const double y = order.y[i];
    const int x0 = std::max(0, static_cast<int>(x - 0.5 - filter.radius_x()));
    const int y0 = std::max(0, static_cast<int>(y - 0.5 - filter.radius_y()));
    const int x1 = std::min(order.width, static_cast<int>(x + 0.5 + filter.radius_x()) + 1);
    const int y1 = std::min(order.height, static_cast<int>(y + 0.5 + filter.radius_y()) + 1);
    for (int py = y0; py < y1; ++py) {
      const double down = filter.along_y(py + 0.5 - y);
      for (int px = x0; down != 0 && px < x1; ++px) {
        const double weight = down * filter.along_x(px + 0.5 - x);
        const std::size_t at = static_cast<std::size_t>(py) * width + static_cast<std::size_t>(px);
        sums[at] += weight * luminance[i % kPool];
        weights[at] += weight;
      }
    }
  }
  const double most = *std::max_element(weights.begin(), weights.end());
  double worst = 0;
  for (std::size_t p = 0; p < sums.size(); ++p) {
    if (weights[p] < most / 4) continue;
    const double truth = sums[p] / weights[p];
    const double value = developed(static_cast<int>(p % width), static_cast<int>(p / width));
    worst = std::max(worst, std::abs(value - truth) / truth);
  }
  return worst;
}

double worst_bucket_error(const Order& order, const Pool& pool, const spectile::Bands& bands, bool by_density,
                          const std::function<double(int x, int y, std::size_t bucket)>& developed) {
  const auto width = static_cast<std::size_t>(order.width);
  const std::size_t buckets = bands.count();
  const std::size_t pixels = width * spectile::kFilmTile;
  const double first_nm = bands.list().front().lower_nm;
  const double width_nm = (bands.list().back().upper_nm - first_nm) / static_cast<double>(buckets);
  std::vector<double> sums(pixels * buckets);
  std::vector<double> weights(pixels * buckets);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t pixel =
        static_cast<std::size_t>(order.y[i]) * width + static_cast<std::size_t>(order.x[i]);
    if (pixel >= pixels) continue;
    const textbook::FilmSample& s = pool.textbook[i % kPool];
    for (std::size_t k = 0; k < kWavelengths; ++k) {
      const double at = std::floor((s.lambda_nm[k] - first_nm) / width_nm);
      if (at < 0 || at >= static_cast<double>(buckets)) continue;
      const double weight = by_density ? 1.0 / s.density[k] : 1.0;
      sums[pixel * buckets + static_cast<std::size_t>(at)] += weight * s.radiance[k];
      weights[pixel * buckets + static_cast<std::size_t>(at)] += weight;
    }
  }
  double worst = 0;
  for (std::size_t at = 0; at < sums.size(); ++at) {
    if (weights[at] == 0) continue;
    const std::size_t pixel = at / buckets;
    const double value =
        developed(static_cast<int>(pixel % width), static_cast<int>(pixel / width), at % buckets);
    worst = std::max(worst, std::abs(value * weights[at] / sums[at] - 1));
  }
  return worst;
}

}  // namespace bench
