// Colours of measured reflectances under a white.
#include "src/upsampling/grid/measured_colors.hpp"

#include <cmath>
#include <spectile/spectra/named_spectra.hpp>

#include "src/base/errors.hpp"

namespace spectile {
namespace {

constexpr std::size_t kMaxWavelengths = 4096;
constexpr double kFirstNodeNm = 100;
constexpr double kLastNodeNm = 10000;
// The sigmoid of a tenth of it is 0 or 1 in float.
constexpr double kMaxOffset = 1000;

}  // namespace

std::string nodes_flaw(const LearnedNodes& nodes) {
  const std::size_t count = nodes.wavelengths_nm.size();
  if (count == 0 || count > kMaxWavelengths)
    return fmt::format("{} wavelengths are not from 1 to {}", count, kMaxWavelengths);
  for (std::size_t i = 0; i < count; ++i) {
    const double nm = nodes.wavelengths_nm[i];
    if (!(nm >= kFirstNodeNm && nm <= kLastNodeNm))
      return fmt::format("a wavelength of {} nm is not from {} to {} nm", nm, kFirstNodeNm, kLastNodeNm);
    if (i > 0 && !(nm > nodes.wavelengths_nm[i - 1])) {
      return fmt::format("the wavelengths do not ascend: {} nm comes after {} nm", nm,
                         nodes.wavelengths_nm[i - 1]);
    }
  }
  if (nodes.offsets.size() != kNodes * count) {
    return fmt::format("there are {} offsets, not {} for each of {} wavelengths", nodes.offsets.size(),
                       kNodes, count);
  }
  for (const float offset : nodes.offsets) {
    if (!(std::abs(static_cast<double>(offset)) <= kMaxOffset))
      return fmt::format("an offset of {} is not from -{} to {}", offset, kMaxOffset, kMaxOffset);
  }
  return {};
}

std::array<double, 3> node_color(std::size_t node) {
  const auto levels = node_levels();
  const std::size_t n = levels.size();
  return {static_cast<double>(levels[node / (n * n)]), static_cast<double>(levels[node / n % n]),
          static_cast<double>(levels[node % n])};
}

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
