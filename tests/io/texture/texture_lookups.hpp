// Textures and points for the tests of lookups at points, and their samples.
#pragma once

#include <gmock/gmock.h>

#include <spectile/image/spectral_texture.hpp>

#include "tests/io/convert/jobs/compact_files.hpp"

namespace spectile::test {

/// Points of lanes, with one number more where a test needs one.
struct Points {
  explicit Points(std::size_t lanes)
      : u(*ScalarLanes::create(lanes)), v(*ScalarLanes::create(lanes)), level(*ScalarLanes::create(lanes)) {}
  TexturePoints at() const { return {.u = u, .v = v}; }
  TexturePoints at_level() const { return {.u = u, .v = v, .level = level}; }
  TexturePoints with_footprint() const { return {.u = u, .v = v, .footprint = level}; }
  ScalarLanes u, v, level;
};

/// Anywhere from 1.5 widths before the texture to 1.5 behind it.
inline Points points_about(std::size_t lanes, std::uint32_t seed) {
  const Floats u = plain_floats(blocks_for(lanes) * kLanesPerBlock, seed, -1.5F, 2.5F);
  const Floats v = plain_floats(u.size(), seed + 1, -1.5F, 2.5F);
  Points out(lanes);
  for (std::size_t i = 0; i < lanes; ++i) {
    out.u[i] = u[i];
    out.v[i] = v[i];
  }
  return out;
}

/// The centres of an image's texels, in order.
inline Points centres_of_texels(int width, int height) {
  Points out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < out.u.lanes(); ++i) {
    out.u[i] = (static_cast<float>(static_cast<int>(i) % width) + 0.5F) / static_cast<float>(width);
    out.v[i] = (static_cast<float>(static_cast<int>(i) / width) + 0.5F) / static_cast<float>(height);
  }
  return out;
}

/// The same wavelengths in every lane.
inline SampledSpectra wavelengths_of(std::size_t lanes, const std::vector<double>& nm) {
  SampledSpectra out = own_batch(lanes, nm.size());
  for (std::size_t i = 0; i < lanes; ++i) {
    for (std::size_t k = 0; k < nm.size(); ++k) out.at(i, k) = static_cast<float>(nm[k]);
  }
  return out;
}

inline SampledSpectra sampled(const SpectralTexture& texture, const TexturePoints& at,
                              const SampledSpectra& lambda_nm, const TextureLookup& lookup,
                              const Execution& execution = {}) {
  SampledSpectra out = own_batch(lambda_nm.lanes(), lambda_nm.axis().count());
  const auto done = texture.sample(at, lambda_nm, out, lookup, execution);
  EXPECT_TRUE(done) << done.error().message;
  return out;
}

inline SpectralTexture opened(const std::string& path, std::optional<TextureCache> cache = {}) {
  auto texture = SpectralTexture::open(path, TextureOptions{.threads = 1, .cache = std::move(cache)});
  EXPECT_TRUE(texture) << texture.error().message;
  return *texture;
}

}  // namespace spectile::test
