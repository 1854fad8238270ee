// Lookups in textures, of tiles that the cache has.
#pragma once

#include <spectile/upsampling/upsample.hpp>

#include "bench/operations/operation.hpp"

namespace spectile::measure {

/// Texels along the texture's sides; its tiles fit into a second-level cache.
inline constexpr std::size_t kTextureSide = 128;

/// Cost of a bilinear lookup: level, coordinates and indices of two sides (2 * 24), tile, place and weight of
/// four texels (4 * 12).
inline constexpr double kPlaces = 2 * 24 + 4 * 12;

/// Shapes: [kTextureSide][kTextureSide][3], from `low` to `high`.
std::vector<float> texture_noise(float low, float high);

/// A texel's sample in double, and what its error is a multiple of u of.
struct SampleAndScale {
  double sample, scale;
};

struct TextureCost {
  double operations = 0;
  double divisions = 0;
  const char* bottleneck = "";
  const char* unit = "u";
  double bound = 0;
  float low = 0;  ///< of the texels' numbers
  float high = 1;
  std::function<SampleAndScale(const float* texel, double lambda)> sample;
};

/// Texels are coefficients of the upsampler's method. Errors: kOutOfMemory.
Result<void> add_texture(std::vector<Operation>& to, const std::shared_ptr<const Upsampler>& upsampler,
                         const TextureCost& cost);

}  // namespace spectile::measure
