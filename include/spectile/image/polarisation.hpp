// Polarised images: degree and angle of linear polarisation as seen by an observer.
#pragma once

#include <spectile/image/image.hpp>
#include <spectile/result.hpp>
#include <spectile/spectra/observer.hpp>
#include <string>

namespace spectile {

enum class Polarisation {
  kDegree,  ///< sqrt(S1^2 + S2^2) / S0, channel DOLP: 0 for unpolarised light, 1 for polarised light
  kAngle,   ///< atan2(S2, S1) / 2, channel AOLP: 0 to 180 degrees from the axis of S1, counter-clockwise
};

struct PolarisationImageOptions : ImageOptions {
  Polarisation polarisation = Polarisation::kDegree;
  Observer observer = Observer::kCie1931;
};

/// Turns a spectral image of Stokes components into the degree or the angle of linear polarisation of what
/// the observer sees: S0, S1 and S2 are first summed by the weights of luminance, so that bright wavelengths
/// count most. Alpha and other channels pass through; S3, circular polarisation, does not count.
/// Numbers: sums as those of project(); then in double. Where S0 is not above 0, the degree is 0; where S1
/// and S2 are 0, the angle is. Degrees above 1, which no light has, stay and are noted.
/// Errors: kBadFile for a file without S1 and S2, or with other wavelengths than S0's; kBadArgument for mip
/// levels: an average of angles has no meaning. Source: Collett, Field Guide to Polarization, SPIE, 2005.
Result<ImageReport> polarisation_image(const std::string& input, const std::string& output,
                                       const PolarisationImageOptions& options = {});

/// As the other settings_text(): see spectile/image/settings.hpp.
std::string settings_text(const PolarisationImageOptions& options);

}  // namespace spectile
