// The attributes by which a file says how its spectra, or its coefficients, were made.
#pragma once

#include <spectile/image/image.hpp>
#include <string>
#include <vector>

#include "src/io/exr/exr_writer.hpp"
#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// Channels of a method's coefficients: spectile.c0, .c1, .c2, and .scale where it has one, or where
/// `premultiplied` colours have.
std::vector<std::string> coefficient_channels(const Upsampler& upsampler, bool premultiplied);
/// True if a part's coefficients are of straight colours, each with a scale that makes it premultiplied.
bool has_straight_coefficients(const PartHeader& header, const Upsampler& upsampler);

/// Appends what alpha means to the spectra: spectileAlpha, "premultiplied", "straight" or "ignore".
void add_alpha_attribute(TextAttributes& texts, AlphaMeaning meaning);
/// Appends that of the source, where it has one.
void pass_alpha_attribute(TextAttributes& texts, const PartHeader& source);

/// Names of the attributes below, which a new file does not take over from its source.
std::vector<std::string> method_attribute_names();

/// Name and text of each. Method, light and observer always; what expanding needs besides for coefficients.
TextAttributes method_attributes(const Upsampler& upsampler, const MethodOptions& options, bool coefficients);

/// The upsampler that made a part's coefficients. Errors: kBadFile for attributes that are missing or
/// damaged, or from which no upsampler can be made.
Result<Upsampler> upsampler_of(const PartHeader& header, const std::string& path);

/// Name of the light that the spectra of a part were made for; empty where it does not say.
std::string light_name_of(const PartHeader& header);

}  // namespace spectile::io
