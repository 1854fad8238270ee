// The attributes by which a file says how its spectra, or its coefficients, were made.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <spectile/image/image.hpp>
#include <string>
#include <utility>
#include <vector>

namespace spectile::io {

/// Channels of a method's coefficients: spectile.c0, .c1, .c2, and .scale where it has one.
std::vector<std::string> coefficient_channels(const Upsampler& upsampler);

/// Names of the attributes below, which a new file does not take over from its source.
std::vector<std::string> method_attribute_names();

/// Name and text of each. Method, light and observer always; what expanding needs besides for coefficients.
std::vector<std::pair<std::string, std::string>> method_attributes(const Upsampler& upsampler,
                                                                   const MethodOptions& options,
                                                                   bool coefficients);

/// The upsampler that made a part's coefficients. Errors: kBadFile for attributes that are missing or
/// damaged, or from which no upsampler can be made.
Result<Upsampler> upsampler_of(const Imf::Header& header, const std::string& path);

/// Name of the light that the spectra of a part were made for; empty where it does not say.
std::string light_name_of(const Imf::Header& header);

}  // namespace spectile::io
