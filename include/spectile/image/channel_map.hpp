// Channel maps: files that say which wavelengths channels stand for whose names do not.
#pragma once

#include <spectile/image/image.hpp>
#include <spectile/result.hpp>
#include <string>
#include <vector>

namespace spectile {

/// Reads a channel map: a line for each channel, its name and its wavelength, or its name and the lower and
/// the upper edge of its band, between commas, semicolons or tabs, in UTF-8 or UTF-16. Empty lines, lines
/// that start with #, and headings before the first channel do not count. Units: nm. Bands of single
/// wavelengths reach halfway to their neighbours. Errors: kBadFile with line and column, also for a map that
/// mixes both forms or names a channel twice; kNoPermission.
Result<std::vector<MappedChannel>> load_channel_map(const std::string& path);

}  // namespace spectile
