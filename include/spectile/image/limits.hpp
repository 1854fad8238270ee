// Limits of what is read, for files of unknown origin.
#pragma once

#include <cstdint>

namespace spectile {

/// 65536 x 65536.
inline constexpr std::uint64_t kDefaultMaxPixels = std::uint64_t{1} << 32U;

/// Sets the largest image that is read from now on, by any thread, in pixels of a part's data window; 0 for
/// any. A file of a few kilobytes can claim 68 gigapixels. Functions that read a larger one return kBadFile.
void set_max_pixels(std::uint64_t pixels);

}  // namespace spectile
