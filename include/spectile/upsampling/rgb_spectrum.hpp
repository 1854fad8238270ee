// Continuous spectra of RGB colours, by an upsampling method.
#pragma once

#include <array>
#include <spectile/result.hpp>
#include <spectile/spectra/spectrum.hpp>
#include <spectile/upsampling/upsample.hpp>

namespace spectile {

/// The spectrum that an upsampler makes of an RGB colour, between and beyond the centres of its bands too:
/// mixtures of basis spectra and a light's white are linear there, a sigmoid is itself; beyond the outer
/// centres all keep the value there. Errors: kBadArgument for a component that is not finite, and for colours
/// that the method cannot make (see gamut_clip()).
Result<UpsampledSpectrum> rgb_spectrum(const Upsampler& upsampler, const std::array<double, 3>& rgb);

/// A reflectance between 0 and 1 for an RGB colour between 0 and 1, by an upsampler of reflectances.
/// Errors: kBadArgument for an upsampler of another quantity, and as for rgb_spectrum().
Result<UpsampledSpectrum> rgb_albedo_spectrum(const Upsampler& upsampler, const std::array<double, 3>& rgb);
/// The same for what may exceed 1, by an upsampler of unbounded spectra.
Result<UpsampledSpectrum> rgb_unbounded_spectrum(const Upsampler& upsampler,
                                                 const std::array<double, 3>& rgb);
/// The same for light, by an upsampler of illuminants: RGB 1, 1, 1 is the light that the upsampler is made
/// for, with Y = 1.
Result<UpsampledSpectrum> rgb_illuminant_spectrum(const Upsampler& upsampler,
                                                  const std::array<double, 3>& rgb);

}  // namespace spectile
