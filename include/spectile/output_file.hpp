// Text files that appear whole or not at all.
#pragma once

#include <spectile/result.hpp>
#include <string>
#include <string_view>

namespace spectile {

/// Finds out, before hours of work, whether a file can be written there: nothing is left of the try, and what
/// is there stays as it is. Errors: kBadFile (a directory or a device, a folder that is missing),
/// kNoPermission, kNoSpace.
Result<void> check_writable(const std::string& path);

/// Writes a text to a file, which takes the place of one that is there when all of it is written. Symbolic
/// links are followed, and stay. Errors: those of check_writable().
Result<void> write_text_file(const std::string& path, std::string_view text);

}  // namespace spectile
