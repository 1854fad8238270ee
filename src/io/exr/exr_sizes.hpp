// Sizes that a file's headers claim, checked before OpenEXR believes them.
#pragma once

#include <spectile/result.hpp>
#include <string>

namespace spectile::io {

/// Walks over the attributes of every part's header of an open OpenEXR file. OpenEXR takes memory for the
/// size that an attribute claims, up to 2 GiB, before it finds the file to be shorter. What else may be wrong
/// is left to it. Errors: kBadFile for an attribute of more bytes than follow, or of fewer than none.
Result<void> check_attribute_sizes(int descriptor, const std::string& path);

}  // namespace spectile::io
