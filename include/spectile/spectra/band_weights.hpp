// BandWeights: what turns samples in planned bands into XYZ.
#pragma once

#include <array>
#include <spectile/spectra/named_light.hpp>
#include <spectile/spectra/observer.hpp>
#include <vector>

namespace spectile {

/// A light and its samples in planned bands.
struct BandLight : NamedLight {
  std::vector<double> emission;  ///< [bands], which the spectrum stands for
};

/// XYZ of a reflectance r under a light is the sum over k of sensor_k * emission_k * r_k; that of a
/// reflectance that is 1 everywhere is the light's white, Y = 1, exactly.
struct BandWeights {
  Observer observer = Observer::kCie1931;
  std::vector<std::array<double, 3>> sensor;  ///< [bands], shared by all lights
  std::vector<BandLight> lights;
};

}  // namespace spectile
