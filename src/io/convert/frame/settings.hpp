// The attribute in which an image says how it was made.
#pragma once

namespace spectile::io {

/// Name of the attribute; it never passes from an input to an output.
inline constexpr const char* kSettingsAttribute = "spectileSettings";

}  // namespace spectile::io
