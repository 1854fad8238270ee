// Representation by wavelengths drawn for each path.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bench/representations/lane_loops.hpp"
#include "bench/representations/path_lanes.hpp"
#include "src/base/errors.hpp"

namespace spectile::measure {
namespace {

constexpr double kRange = kLastVisibleNm - kFirstVisibleNm;

/// Between the values at every nanometre; `nm` within them.
double between(const std::vector<double>& values, double nm) {
  const double at = nm - kFirstVisibleNm;
  const std::size_t i = std::min(static_cast<std::size_t>(at), values.size() - 2);
  const double part = at - static_cast<double>(i);
  return (1 - part) * values[i] + part * values[i + 1];
}

/// Lanes of one sample of the paths.
struct DrawnLanes {
  std::size_t wavelengths = 0;
  FloatBuffer bounces[kMaxBounces];
  FloatBuffer product, weights, xyz;

  void follow(const kernels::KernelTable& table, std::size_t of) {
    const float* const in = multiply_bounces(table, bounces, of, product, kPaths * wavelengths);
    lane_loops(table.name).weigh(xyz.data(), in, weights.data(), wavelengths, blocks_for(kPaths));
  }
};

Result<DrawnLanes> draw(const PathScene& scene, const DensityTable& density, Drawing drawing,
                        std::size_t wavelengths, std::size_t sample, std::size_t samples,
                        std::mt19937_64& random) {
  DrawnLanes out;
  out.wavelengths = wavelengths;
  for (FloatBuffer& bounce : out.bounces) {
    SPECTILE_ASSIGN(bounce, FloatBuffer::create(kPaths * wavelengths));
  }
  SPECTILE_ASSIGN(out.product, FloatBuffer::create(kPaths * wavelengths));
  SPECTILE_ASSIGN(out.weights, FloatBuffer::create(3 * kPaths * wavelengths));
  SPECTILE_ASSIGN(out.xyz, FloatBuffer::create(3 * kPaths));
  std::vector<double> jitter(wavelengths);
  for (std::size_t lane = 0; lane < kPaths; ++lane) {
    // Each sample of a path has its own part of the strata.
    for (double& u : jitter) {
      u = (static_cast<double>(sample) + static_cast<double>(random() >> 11U) * 0x1p-53) /
          static_cast<double>(samples);
    }
    const auto drawn = draw_wavelengths(density, drawing, jitter);
    const std::size_t first = lane / kLanesPerBlock * wavelengths * kLanesPerBlock + lane % kLanesPerBlock;
    for (std::size_t w = 0; w < wavelengths; ++w) {
      for (std::size_t bounce = 0; bounce < kMaxBounces; ++bounce) {
        const ReferenceReflectance& r = scene.reflectances()[scene.paths[lane][bounce]];
        out.bounces[bounce].data()[first + w * kLanesPerBlock] =
            static_cast<float>(between(r.values, drawn[w].nm));
      }
      const std::size_t block = lane / kLanesPerBlock;
      for (std::size_t k = 0; k < 3; ++k) {
        out.weights.data()[((block * wavelengths + w) * 3 + k) * kLanesPerBlock + lane % kLanesPerBlock] =
            static_cast<float>(between(scene.light().weights[k], drawn[w].nm) * drawn[w].weight);
      }
    }
  }
  return out;
}

}  // namespace

DensityTable wavelength_density(const ReferenceLight& light) {
  DensityTable out;
  for (std::size_t i = 0; i < kGridSamples; ++i) {
    out.density.push_back(seen_at(light, i));
  }
  out.cumulative = {0};
  for (std::size_t i = 1; i < kGridSamples; ++i) {
    out.cumulative.push_back(out.cumulative.back() + 0.5 * (out.density[i - 1] + out.density[i]));
  }
  const double total = out.cumulative.back();
  for (double& d : out.density) d /= total;
  for (double& c : out.cumulative) c /= total;
  return out;
}

double DensityTable::at(double nm) const {
  return between(density, nm);
}

double DensityTable::inverse(double u) const {
  const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, u);
  const auto i = static_cast<std::size_t>(above - cumulative.begin()) - 1;
  // The root of the quadratic in the form that has no difference of nearly equal numbers.
  const double rest = std::max(u - cumulative[i], 0.0);
  const double slope = density[i + 1] - density[i];
  const double root = std::sqrt(std::max(density[i] * density[i] + 2 * slope * rest, 0.0));
  const double part = rest > 0 ? 2 * rest / (density[i] + root) : 0;
  return kFirstVisibleNm + static_cast<double>(i) + std::min(part, 1.0);
}

std::vector<DrawnWavelength> draw_wavelengths(const DensityTable& density, Drawing drawing,
                                              std::span<const double> jitter) {
  const auto count = static_cast<double>(jitter.size());
  std::vector<DrawnWavelength> out(jitter.size());
  if (drawing == Drawing::kStratified) {
    for (std::size_t w = 0; w < jitter.size(); ++w) {
      out[w].nm = density.inverse((static_cast<double>(w) + jitter[w]) / count);
      const double p = density.at(out[w].nm);
      out[w].weight = p > 0 ? 1 / (count * p) : 0;
    }
    return out;
  }
  const double hero = density.inverse(jitter[0]);
  double sum = 0;
  for (std::size_t w = 0; w < jitter.size(); ++w) {
    double nm = hero + static_cast<double>(w) * kRange / count;
    if (nm > kLastVisibleNm) nm -= kRange;
    out[w].nm = nm;
    sum += density.at(nm);
  }
  for (DrawnWavelength& d : out) d.weight = sum > 0 ? 1 / sum : 0;
  return out;
}

Result<Representation> drawn_wavelengths(const PathScene& scene, Drawing drawing, std::size_t wavelengths,
                                         std::size_t samples) {
  const DensityTable density = wavelength_density(scene.light());
  std::mt19937_64 random(scene.scene->seed);
  auto drawn = std::make_shared<std::vector<DrawnLanes>>();
  for (std::size_t s = 0; s < samples; ++s) {
    SPECTILE_ASSIGN(auto lanes, draw(scene, density, drawing, wavelengths, s, samples, random));
    drawn->push_back(std::move(lanes));
  }
  Representation out;
  const bool hero = drawing == Drawing::kHero;
  out.name = fmt::format("{} {} wavelengths, {} sample{}", wavelengths, hero ? "hero" : "stratified", samples,
                         samples == 1 ? "" : "s");
  out.source = hero ? "Wilkie et al. 2014" : "Evans and McCool 1999";
  out.coefficients = wavelengths;
  out.samples = static_cast<double>(samples);
  // Always the same sample: what is drawn lies in the cache, as the others' coefficients do.
  out.run = [drawn, table = scene.scene->table](std::size_t bounces) {
    drawn->front().follow(*table, bounces);
  };
  out.colors = [drawn, samples, table = scene.scene->table](std::size_t bounces) {
    std::vector<Xyz> sums(kPaths);
    for (DrawnLanes& lanes : *drawn) {
      lanes.follow(*table, bounces);
      for (std::size_t path = 0; path < kPaths; ++path) {
        for (std::size_t k = 0; k < 3; ++k) {
          sums[path][k] +=
              static_cast<double>(lanes.xyz.data()[k * kPaths + path]) / static_cast<double>(samples);
        }
      }
    }
    return sums;
  };
  return out;
}

}  // namespace spectile::measure
