// Colours of measured reflectances under a white.
#include "src/upsampling/grid/measured_colors.hpp"

#include <spectile/spectra/named_spectra.hpp>

#include "src/base/errors.hpp"

namespace spectile {
Result<MeasuredColors> MeasuredColors::create(const LearningOptions& options) {
  MeasuredColors out;
  SPECTILE_ASSIGN(out.bands_, Bands::uniform(380, 780, 5));
  const MeasuredSpectrum light = options.light ? options.light->spectrum : *illuminant("D65");
  SPECTILE_ASSIGN(out.space_, working_space(out.bands_, false, kRec709, light, options.observer));
  return out;
}

std::array<double, 3> MeasuredColors::rgb_of(const Spectrum& reflectance) const {
  const std::vector<float> samples = reflectance.average_over(bands_);
  std::array<double, 3> out{};
  for (std::size_t b = 0; b < samples.size(); ++b) {
    for (std::size_t k = 0; k < 3; ++k) out[k] += space_.weights[b][k] * static_cast<double>(samples[b]);
  }
  return out;
}

Lab MeasuredColors::lab_of(const std::array<double, 3>& rgb) const {
  return xyz_to_lab(times(space_.rgb_to_xyz, rgb), space_.white_xyz);
}

}  // namespace spectile
