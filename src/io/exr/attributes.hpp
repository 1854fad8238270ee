// Attributes of an image that pass from the input to the output.
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/openexr.h>

#include <string>
#include <vector>

namespace spectile::io {

/// Name of the attribute in which an image says how it was made; it never passes from an input to an output.
inline constexpr const char* kSettingsAttribute = "spectileSettings";
/// Name of the attribute that holds the plan of a file's bands.
inline constexpr const char* kPlanAttribute = "spectilePlan";

/// Copies every attribute of `from` that describes the picture rather than how it is stored, but for those
/// named in `replaced`, into a part being written. Types that this build does not know travel as they are.
exr_result_t copy_attributes(const Imf::Header& from, exr_context_t to, int part,
                             const std::vector<std::string>& replaced);

}  // namespace spectile::io
