// Shared by the tests of sampled wavelengths.
#pragma once

#include <spectile/lanes/wavelengths.hpp>

#include "tests/support/lanes.hpp"

namespace spectile::test {

/// Random numbers from 0 to 1.
inline ScalarLanes random_lanes(std::size_t lanes, std::uint32_t seed) {
  auto u = *ScalarLanes::create(lanes);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  for (std::size_t i = 0; i < lanes; ++i) u[i] = unit(random);
  return u;
}

inline SampledWavelengths drawn_wavelengths(WavelengthSampling sampling, std::size_t lanes, std::size_t count,
                                            std::uint32_t seed, double first = 360, double last = 830) {
  auto out = *SampledWavelengths::create(lanes, count);
  EXPECT_TRUE(sample_wavelengths(sampling, random_lanes(lanes, seed), out, first, last));
  return out;
}

}  // namespace spectile::test
