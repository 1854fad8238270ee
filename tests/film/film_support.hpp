// Batches for tests of films.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <spectile/spectile.hpp>
#include <vector>

#include "tests/support/lanes.hpp"

namespace spectile::test {

inline FilmOptions small_film() {
  FilmOptions o;
  o.width = o.height = 20;
  return o;
}

/// A film whose contributions are the samples themselves.
inline FilmOptions plain_film(int side, int range) {
  FilmOptions o;
  o.width = o.height = side;
  o.input = FilmInput::kBands;
  o.spectral = true;
  o.xyz.reset();
  o.bands = *Bands::uniform(555, 556, 1);
  o.range = range;
  return o;
}

/// Samples with four wavelengths each, at any address: radiance 1, uniform densities.
class FilmSamples {
 public:
  static constexpr std::size_t kCount = 4;
  explicit FilmSamples(std::size_t n)
      : x(n, 0.5F),
        y(n, 0.5F),
        weight(n, 1.0F),
        n_(n),
        radiance_(kCount * n, 1.0F),
        lambda_(kCount * n),
        density_(kCount * n, 1.0F / 400) {
    for (std::size_t k = 0; k < kCount; ++k) {
      for (std::size_t i = 0; i < n; ++i)
        lambda(k, i) = 380 + 100 * static_cast<float>(k) + static_cast<float>(i % 97);
    }
  }
  void put(std::size_t i, float px, float py, float w) {
    x[i] = px;
    y[i] = py;
    weight[i] = w;
  }
  float& radiance(std::size_t k, std::size_t i) { return radiance_[k * n_ + i]; }
  float& lambda(std::size_t k, std::size_t i) { return lambda_[k * n_ + i]; }
  float& density(std::size_t k, std::size_t i) { return density_[k * n_ + i]; }
  std::size_t size() const { return n_; }
  /// The samples from `first` on.
  WavelengthSamples wavelengths(std::size_t first, std::size_t count) const {
    return {std::span(x).subspan(first, count),      std::span(y).subspan(first, count),
            std::span(weight).subspan(first, count), {radiance_.data() + first, kCount, n_},
            {lambda_.data() + first, kCount, n_},    {density_.data() + first, kCount, n_}};
  }
  WavelengthSamples wavelengths() const { return wavelengths(0, n_); }
  /// The same samples in another order.
  FilmSamples permuted(const std::vector<std::size_t>& order) const {
    FilmSamples out(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      out.put(i, x[order[i]], y[order[i]], weight[order[i]]);
      for (std::size_t k = 0; k < kCount; ++k) {
        out.radiance_[k * n_ + i] = radiance_[k * n_ + order[i]];
        out.lambda_[k * n_ + i] = lambda_[k * n_ + order[i]];
        out.density_[k * n_ + i] = density_[k * n_ + order[i]];
      }
    }
    return out;
  }
  std::vector<float> x, y, weight;

 private:
  std::size_t n_;
  std::vector<float> radiance_, lambda_, density_;
};

/// Samples all over and a little beyond a film of 20 x 20 pixels, over nine decades, some of them bad.
inline FilmSamples random_samples(std::size_t n, std::uint32_t seed, float side = 20) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  FilmSamples out(n);
  for (std::size_t i = 0; i < n; ++i) {
    // One after the other: the order in which arguments are evaluated is the compiler's.
    const float w = unit(random);
    const float py = unit(random) * (side + 1) - 0.5F;
    const float px = unit(random) * (side + 1) - 0.5F;
    out.put(i, px, py, w);
    const float size = std::pow(10.0F, 9 * unit(random) - 4);
    for (std::size_t k = 0; k < FilmSamples::kCount; ++k) {
      out.lambda(k, i) = 350 + 490 * unit(random);
      out.radiance(k, i) = size * unit(random);
      out.density(k, i) = i % 50 == 7 && k > 0 ? 0.0F : 0.001F + 0.003F * unit(random);
    }
    if (i % 100 == 3) out.radiance(1, i) = kNan;
    if (i % 1000 == 4) out.x[i] = kInf;
    if (i % 1000 == 5) out.weight[i] = -1;
  }
  return out;
}

/// Samples on bands.
class BandBatch {
 public:
  BandBatch(std::size_t bands, std::size_t n)
      : x(n, 0.5F), y(n, 0.5F), weight(n, 1.0F), bands_(bands), n_(n), radiance_(bands * n, 1.0F) {}
  void put(std::size_t i, float px, float py, float w) {
    x[i] = px;
    y[i] = py;
    weight[i] = w;
  }
  float& radiance(std::size_t b, std::size_t i) { return radiance_[b * n_ + i]; }
  BandSamples samples() const { return {x, y, weight, {radiance_.data(), bands_, n_}}; }
  std::vector<float> x, y, weight;

 private:
  std::size_t bands_, n_;
  std::vector<float> radiance_;
};

/// Every plane of a layer, one after another.
inline std::vector<float> developed(const Film& film, FilmLayer layer) {
  auto d = *FilmDevelopment::create(film, layer);
  EXPECT_TRUE(d.update());
  std::vector<float> out;
  for (std::size_t p = 0; p < d.planes(); ++p) {
    out.insert(out.end(), d.plane(p), d.plane(p) + static_cast<std::size_t>(d.height()) * d.stride());
  }
  return out;
}

}  // namespace spectile::test
