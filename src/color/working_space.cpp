// Working spaces for given bands, light, observer and primaries.
#include "src/color/working_space.hpp"

#include <cmath>

#include "src/base/errors.hpp"
#include "src/spectra/band_weights.hpp"

namespace spectile {

Result<WorkingSpace> working_space(const Bands& bands, bool emission, const Chromaticities& primaries,
                                   const MeasuredSpectrum& light, Observer observer) {
  SPECTILE_ASSIGN(const auto projector, emission ? Projector::emissive(bands, observer)
                                                 : Projector::reflective(bands, light, observer));
  const auto xyz_weights = projector.weights();
  WorkingSpace out;
  out.white.assign(bands.count(), 1.0);
  if (emission) {
    SPECTILE_ASSIGN(out.white, light_samples(light, bands));
    double luminance = 0;
    for (std::size_t b = 0; b < bands.count(); ++b) luminance += out.white[b] * xyz_weights[b][1];
    if (!(luminance > 0)) {
      return make_error(ErrorCode::kBadArgument, "bands {} hold no luminance of the light's",
                        bands.description());
    }
    for (double& v : out.white) v /= luminance;
    out.luminance = luminance;
  }
  for (std::size_t b = 0; b < bands.count(); ++b) {
    for (std::size_t k = 0; k < 3; ++k) out.white_xyz[k] += out.white[b] * xyz_weights[b][k];
  }
  out.rgb_to_xyz = rgb_to_xyz(primaries, out.white_xyz);
  const double size = determinant(out.rgb_to_xyz);
  if (!(std::abs(size) > 1e-9)) {
    return make_error(ErrorCode::kBadArgument,
                      "the primaries and the white of the bands {} under this light span no RGB space",
                      bands.description());
  }
  const Matrix3 to_rgb = inverse(out.rgb_to_xyz);
  for (const auto& xyz : xyz_weights) out.weights.push_back(times(to_rgb, xyz));
  return out;
}

}  // namespace spectile
