// The plan of a file's bands, as an attribute, so that a reader needs no side file.
#pragma once

#include <spectile/spectra/bands.hpp>
#include <string>

#include "src/io/exr/attributes.hpp"
#include "src/io/exr/exr_writer.hpp"
#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// Appends the plan of bands, where they have one, as JSON.
void add_plan_attribute(TextAttributes& texts, const Bands& bands);

/// The bands with the plan of a part, where it has one. Errors: kBadFile for a plan that is damaged, or is
/// one of other wavelengths than the bands' centres.
Result<Bands> with_plan(const PartHeader& header, const Bands& bands, const std::string& path);

}  // namespace spectile::io
