// Attributes of every type as text, to be shown.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "src/io/exr/part_header.hpp"

namespace spectile::io {

/// All attributes but those that say how pixels are stored, which the header has members for. What has no
/// short text is its type and size: "preview, 128 x 72".
std::vector<std::pair<std::string, std::string>> attribute_texts(const PartHeader& header);

}  // namespace spectile::io
